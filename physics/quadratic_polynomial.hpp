// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Quadratic B-splines (physics/quadratic_bspline_basis.hpp) in a node-centred cell, the points nearest
/// to its node, as polynomials of local coordinates xi in [0, 1]^Dim; k = sum_i 3^i k_i, k_i = 0, 1, 2:
/// - a nodal field is sum_k c_k r_k with c from its values by differences alone, where
///     r_k(xi) = prod_i (1, xi_i + 1/2, xi_i^2 / 2) [k_i];
/// - a sum sum_p w_p . grad N_a(xi_p) follows from the moments sum_p w_p q_k(xi_p) of
///     q_k(xi) = prod_i xi_i^k_i / k_i!,   d q_k / d xi_i = q_(k - 3^i), or 0 where k_i = 0;
/// - a sum sum_p w_p N_a(xi_p) is computed with the functions N_a themselves. Its terms are of one sign, so
/// that
///   it is exact to round-off even at a node of little mass. Differences of moments would not be.
/// T is a number, or a pack with a cell in every lane.
#pragma once

#include <vsb/physics/quadratic_bspline_basis.hpp>
#include <vsb/views/static_for.hpp>

namespace vsb {

/// 3^Dim.
constexpr int stencil_size(int dim) {
  return dim == 0 ? 1 : 3 * stencil_size(dim - 1);
}
/// Digit i of k, to the base 3.
constexpr int stencil_digit(int k, int i) {
  return k / stencil_size(i) % 3;
}

/// Coefficients or moments, one per monomial; or values at the nodes around, digit i: below, at, above the
/// middle one in direction i.
template <int Dim, class T>
using QuadraticPolynomial = Vector<stencil_size(Dim), T>;

/// Nodal values to coefficients, in place.
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void quadratic_from_nodes(QuadraticPolynomial<Dim, T>& f) {
  static_for<Dim>([&](auto i) VSB_UNROLLED {
    static_for<f.size>([&](auto k) VSB_UNROLLED {
      if constexpr (stencil_digit(k, i) == 0) {
        constexpr int at = k + stencil_size(i), above = at + stencil_size(i);
        const T slope = f[at] - f[k];
        f[above] = (f[above] - f[at]) - slope;
        f[at] = slope;
      }
    });
  });
}

/// Moments to sums at the nodes, in place.
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void nodes_from_quadratic(QuadraticPolynomial<Dim, T>& m) {
  static_for<Dim>([&](auto i) VSB_UNROLLED {
    static_for<m.size>([&](auto k) VSB_UNROLLED {
      if constexpr (stencil_digit(k, i) == 0) {
        constexpr int at = k + stencil_size(i), above = at + stencil_size(i);
        const T half = T(0.5) * m[k], difference = m[at] - m[above];
        m[k] = half - difference;
        m[at] = (half + difference) - m[above];
      }
    });
  });
}

/// xi, xi + 1/2 and xi^2 / 2 in every direction.
template <int Dim, class T>
struct Powers {
  ///@{
  /// xi, xi + 1/2 and xi^2 / 2, by direction.
  Vector<Dim, T> first, shifted, second;
  ///@}
  /// At the point xi of the node-centred cell, in [0, 1]^Dim.
  KOKKOS_FORCEINLINE_FUNCTION explicit Powers(const Vector<Dim, T>& xi) : first(xi) {
    static_for<Dim>([&](auto i) VSB_UNROLLED {
      shifted[i] = xi[i] + T(0.5);
      second[i] = T(0.5) * xi[i] * xi[i];
    });
  }
};

namespace detail {
/// The polynomial at xi_i, evaluated along direction i = 0, 1, 2 alone, the lowest direction that c still
/// has.
template <int i, int Dim, class T, int N>
KOKKOS_FORCEINLINE_FUNCTION Vector<N / 3, T> value_along(const Vector<N, T>& c, const Powers<Dim, T>& xi) {
  Vector<N / 3, T> v;
  vsb::static_for<N / 3>([&](auto k) VSB_UNROLLED {
    v[k] = c[3 * k] + c[3 * k + 1] * xi.shifted[i] + c[3 * k + 2] * xi.second[i];
  });
  return v;
}
/// The same of its derivative.
template <int i, int Dim, class T, int N>
KOKKOS_FORCEINLINE_FUNCTION Vector<N / 3, T> slope_along(const Vector<N, T>& c, const Powers<Dim, T>& xi) {
  Vector<N / 3, T> v;
  vsb::static_for<N / 3>([&](auto k) VSB_UNROLLED { v[k] = c[3 * k + 1] + c[3 * k + 2] * xi.first[i]; });
  return v;
}
template <int i, int Dim, class T, int N>
KOKKOS_FORCEINLINE_FUNCTION T value_from(const Vector<N, T>& c, const Powers<Dim, T>& xi) {
  if constexpr (i == Dim)
    return c[0];
  else
    return value_from<i + 1>(value_along<i>(c, xi), xi);
}
/// The value, which the gradient needs but for the last direction.
template <int i, int Dim, class T, int N>
KOKKOS_FORCEINLINE_FUNCTION T value_and_gradient_from(const Vector<N, T>& c, const Powers<Dim, T>& xi,
                                                      Vector<Dim, T>& gradient) {
  gradient[i] = value_from<i + 1>(slope_along<i>(c, xi), xi);
  const auto along = value_along<i>(c, xi);
  if constexpr (i + 1 < Dim)
    return value_and_gradient_from<i + 1>(along, xi, gradient);
  else
    return along[0];
}
}  // namespace detail

/// sum_k c_k r_k(xi).
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION T quadratic_at(const QuadraticPolynomial<Dim, T>& c, const Powers<Dim, T>& xi) {
  return detail::value_from<0>(c, xi);
}

/// The same, and its derivatives with respect to xi in `gradient`.
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION T quadratic_at(const QuadraticPolynomial<Dim, T>& c, const Powers<Dim, T>& xi,
                                           Vector<Dim, T>& gradient) {
  return detail::value_and_gradient_from<0>(c, xi, gradient);
}

/// m_k += c sum_p w_p dq_k / dxi_j, from the moments sum_p w_p q_k, of which those with k_j = 2 are not
/// needed.
template <int j, int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void add_slope_moments(QuadraticPolynomial<Dim, T>& m, T c,
                                                   const QuadraticPolynomial<Dim, T>& w) {
  static_for<m.size>([&](auto k) VSB_UNROLLED {
    if constexpr (stencil_digit(k, j) > 0) m[k] += c * w[k - stencil_size(j)];
  });
}

/// A product of one function of every direction, as functions of all but the last, and of the last.
template <int Dim, class T>
struct TensorProduct {
  /// Products of one function of each direction but the last.
  static constexpr int rows = stencil_size(Dim - 1);
  Vector<rows, T> row;  ///< 1 in 1D
  Vector<3, T> last;    ///< the functions of the last direction

  /// of(i): the three functions of direction i.
  template <class Of>
  KOKKOS_FORCEINLINE_FUNCTION static TensorProduct make(const Of& of) {
    TensorProduct p;
    if constexpr (Dim == 1) p.row[0] = T(1);
    if constexpr (Dim > 1) {
      const Vector<3, T> x = of(0);
      static_for<3>([&](auto a) VSB_UNROLLED { p.row[a] = x[a]; });
    }
    if constexpr (Dim == 3) {
      const Vector<3, T> y = of(1);
      // From the last on: row[0 .. 2] are the functions of x until then.
      static_for<3>([&](auto a) VSB_UNROLLED {
        p.row[a + 6] = p.row[a] * y[2];
        p.row[a + 3] = p.row[a] * y[1];
        p.row[a] = p.row[a] * y[0];
      });
    }
    p.last = of(Dim - 1);
    return p;
  }
  /// The basis functions of the nodes.
  KOKKOS_FORCEINLINE_FUNCTION static TensorProduct splines(const Vector<Dim, T>& xi) {
    return make([&](int i) {
      const auto along = quadratic_bspline(T(xi[i] - T(0.5)));
      return Vector<3, T>{{along.N[0], along.N[1], along.N[2]}};
    });
  }
  /// The monomials q_k.
  KOKKOS_FORCEINLINE_FUNCTION static TensorProduct monomials(const Powers<Dim, T>& xi) {
    return make([&](int i) { return Vector<3, T>{{T(1), xi.first[i], xi.second[i]}}; });
  }
};

/// sum_k += w times the product.
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void add_product(QuadraticPolynomial<Dim, T>& sum, T w,
                                             const TensorProduct<Dim, T>& product) {
  constexpr int rows = TensorProduct<Dim, T>::rows;
  static_for<3>([&](auto c) VSB_UNROLLED {
    const T part = w * product.last[c];
    static_for<rows>([&](auto r) VSB_UNROLLED {
      if constexpr (Dim == 1)
        sum[c] += part;
      else
        sum[rows * c + r] += part * product.row[r];
    });
  });
}

/// The same with monomials, without those for which skip(k) holds; q_0 = 1 needs no product.
template <class Skip, int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void add_monomials(QuadraticPolynomial<Dim, T>& sum, T w,
                                               const TensorProduct<Dim, T>& product) {
  constexpr int rows = TensorProduct<Dim, T>::rows;
  static_for<3>([&](auto c) VSB_UNROLLED {
    T part = w;
    if constexpr (c > 0) part = w * product.last[c];
    static_for<rows>([&](auto r) VSB_UNROLLED {
      constexpr int k = rows * c + r;
      if constexpr (!Skip::of(k)) {
        if constexpr (r == 0)
          sum[k] += part;
        else
          sum[k] += part * product.row[r];
      }
    });
  });
}

}  // namespace vsb
