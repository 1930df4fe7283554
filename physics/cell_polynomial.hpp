// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The multilinear basis of one cell in the monomials of its local coordinates xi in [0, 1]^Dim,
///   q_k(xi) = prod_(i in k) xi_i,   k = 0, ..., 2^Dim - 1,   i in k: bit i of k is set,
/// Monomials need a third of the operations of the basis functions N_a where many particles share a cell:
/// - a nodal field is sum_a N_a f_a = sum_k c_k q_k, with c from f by differences along each direction;
/// - a sum over particles, sum_p w_p N_a(xi_p), follows from the moments sum_p w_p q_k(xi_p) by the
/// transposed
///   differences; sum_p w_p . grad N_a(xi_p) follows from the moments of grad q_k.
///
/// Differences have the round-off of the whole cell. The mass m_a of a node can be below that, where its only
/// particle is near the opposite face of the cell; then p_a / m_a would be wrong. Mass and momentum are
/// therefore summed with N_a itself (CornerFunctions): terms of one sign, exact to round-off at every node.
/// The increments of particles are interpolated with N_a too, since the acceleration f_a / m_a of such a node
/// is as large as its N_a is small. T is a number, or a pack with a cell in every lane.
#pragma once

#include <vsb/views/static_for.hpp>
#include <vsb/views/tensor.hpp>

namespace vsb {

/// Coefficients or moments, one per monomial.
template <int Dim, class T>
using CellPolynomial = Vector<(1 << Dim), T>;

/// Nodal values f_a, a as in multilinear.hpp, to coefficients, in place.
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void coefficients_from_nodes(CellPolynomial<Dim, T>& f) {
  static_for<Dim>([&](auto i) VSB_UNROLLED {
    static_for<(1 << Dim)>([&](auto a) VSB_UNROLLED {
      if constexpr (a >> i & 1) f[a] = f[a] - f[a ^ (1 << i)];
    });
  });
}

/// Moments to sums at the nodes, in place.
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void nodes_from_moments(CellPolynomial<Dim, T>& m) {
  static_for<Dim>([&](auto i) VSB_UNROLLED {
    static_for<(1 << Dim)>([&](auto a) VSB_UNROLLED {
      if constexpr ((a >> i & 1) == 0) m[a] = m[a] - m[a | (1 << i)];
    });
  });
}

namespace detail {
/// The sum over the monomials of directions 0, ..., i, for the coefficients from `first` on; direction
/// `Derived`, if it is one of them, is differentiated.
template <int Derived, int i, int first, int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION T nested(const CellPolynomial<Dim, T>& c, const Vector<Dim, T>& xi) {
  if constexpr (i < 0)
    return c[first];
  else if constexpr (i == Derived)
    return nested<Derived, i - 1, (first | 1 << i), Dim>(c, xi);
  else
    return nested<Derived, i - 1, first, Dim>(c, xi) +
           nested<Derived, i - 1, (first | 1 << i), Dim>(c, xi) * xi[i];
}
}  // namespace detail

/// sum_k c_k q_k(xi).
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION T value_at(const CellPolynomial<Dim, T>& c, const Vector<Dim, T>& xi) {
  return detail::nested<-1, Dim - 1, 0, Dim>(c, xi);
}

/// d/dxi_j of it.
template <int j, int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION T derivative_at(const CellPolynomial<Dim, T>& c, const Vector<Dim, T>& xi) {
  return detail::nested<j, Dim - 1, 0, Dim>(c, xi);
}

/// The basis functions N_a(xi) of the corners, a as in multilinear.hpp, as products: N_a = row[r] last[c]
/// with a = r + c rows.
template <int Dim, class T>
struct CornerFunctions {
  /// Products of one function of each direction but the last.
  static constexpr int rows = 1 << (Dim - 1);
  Vector<rows, T> row;  ///< of all directions but the last; unused in 1D
  Vector<2, T> last;    ///< 1 - xi and xi of the last direction

  /// At the point xi of the cell, in [0, 1]^Dim.
  KOKKOS_FORCEINLINE_FUNCTION explicit CornerFunctions(const Vector<Dim, T>& xi) {
    if constexpr (Dim > 1) {
      row[0] = T(1) - xi[0];
      row[1] = xi[0];
    }
    if constexpr (Dim == 3) {
      row[2] = row[0] * xi[1];
      row[3] = row[1] * xi[1];
      const T lower = T(1) - xi[1];
      row[0] = row[0] * lower;
      row[1] = row[1] * lower;
    }
    last[0] = T(1) - xi[Dim - 1];
    last[1] = xi[Dim - 1];
  }
  /// sum_a N_a f_a.
  KOKKOS_FORCEINLINE_FUNCTION T interpolate(const Vector<(1 << Dim), T>& f) const {
    Vector<2, T> at;
    static_for<2>([&](auto c) VSB_UNROLLED {
      if constexpr (Dim == 1) {
        at[c] = f[c];
      } else {
        at[c] = row[0] * f[c * rows];
        static_for<rows - 1>([&](auto r) VSB_UNROLLED { at[c] += row[r + 1] * f[c * rows + r + 1]; });
      }
    });
    return last[0] * at[0] + last[1] * at[1];
  }
  /// sum_a += N_a w.
  KOKKOS_FORCEINLINE_FUNCTION void add(Vector<(1 << Dim), T>& sum, T w) const {
    static_for<2>([&](auto c) VSB_UNROLLED {
      const T part = w * last[c];
      static_for<rows>([&](auto r) VSB_UNROLLED {
        if constexpr (Dim == 1)
          sum[c] += part;
        else
          sum[c * rows + r] += part * row[r];
      });
    });
  }
};

/// The monomials; q_0 = 1 is stored, but sums need no product with it.
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION CellPolynomial<Dim, T> monomials(const Vector<Dim, T>& xi) {
  CellPolynomial<Dim, T> q;
  q[0] = T(1);
  static_for<Dim>([&](auto i) VSB_UNROLLED {
    q[1 << i] = xi[i];
    static_for<(1 << i)>([&](auto k) VSB_UNROLLED {
      if constexpr (k > 0) q[k | (1 << i)] = q[k] * xi[i];
    });
  });
  return q;
}

/// m_k += w q_k.
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void add_moments(CellPolynomial<Dim, T>& m, T w, const Vector<Dim, T>& xi) {
  Vector<(1 << (Dim - 1)), T> wq;  // over all directions but the last
  wq[0] = w;
  static_for<Dim - 1>([&](auto i) VSB_UNROLLED {
    static_for<(1 << i)>([&](auto k) VSB_UNROLLED { wq[k | (1 << i)] = wq[k] * xi[i]; });
  });
  static_for<(1 << (Dim - 1))>([&](auto k) VSB_UNROLLED {
    m[k] += wq[k];
    m[k | (1 << (Dim - 1))] += wq[k] * xi[Dim - 1];
  });
}

/// The same from computed monomials, for several w.
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void add_moments_of(CellPolynomial<Dim, T>& m, T w,
                                                const CellPolynomial<Dim, T>& q) {
  m[0] += w;
  static_for<(1 << Dim)>([&](auto k) VSB_UNROLLED {
    if constexpr (k > 0) m[k] += w * q[k];
  });
}

/// m_k += sum_i w_i dq_k/dxi_i; m_0 stays.
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void add_gradient_moments(CellPolynomial<Dim, T>& m, const Vector<Dim, T>& w,
                                                      const CellPolynomial<Dim, T>& q) {
  static_for<(1 << Dim)>([&](auto k) VSB_UNROLLED {
    static_for<Dim>([&](auto i) VSB_UNROLLED {
      if constexpr (k == (1 << i))
        m[k] += w[i];
      else if constexpr (k >> i & 1)
        m[k] += w[i] * q[k ^ (1 << i)];
    });
  });
}

/// The moments sum_p w_p (c . grad q_k) of a constant c from the moments m_k = sum_p w_p q_k. m of all
/// directions is not needed.
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION CellPolynomial<Dim, T> gradient_moments(const Vector<Dim, T>& c,
                                                                    const CellPolynomial<Dim, T>& m) {
  CellPolynomial<Dim, T> g;
  static_for<(1 << Dim)>([&](auto k) VSB_UNROLLED {
    g[k] = T(0);
    static_for<Dim>([&](auto i) VSB_UNROLLED {
      if constexpr (k >> i & 1) g[k] += c[i] * m[k ^ (1 << i)];
    });
  });
  return g;
}

/// The same for c along direction i.
template <int i, int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION CellPolynomial<Dim, T> gradient_moments_along(T c,
                                                                          const CellPolynomial<Dim, T>& m) {
  CellPolynomial<Dim, T> g;
  static_for<(1 << Dim)>([&](auto k) VSB_UNROLLED {
    if constexpr (k >> i & 1)
      g[k] = c * m[k ^ (1 << i)];
    else
      g[k] = T(0);
  });
  return g;
}

/// The moments of a weight, m[k] = sum_p w_p q_k and, with one direction squared, square[j][k] = sum_p w_p
/// xi_j^2 q_k, for k without j and of at most Dim - 2 directions. A stress that varies linearly needs no
/// others.
template <int Dim, class T>
struct SecondMoments {
  ///@{
  /// m[k] = sum_p w_p q_k(xi_p), and square[j][k] = sum_p w_p xi_pj^2 q_k(xi_p).
  CellPolynomial<Dim, T> m, square[Dim];
  ///@}

  /// Sets all moments to zero.
  KOKKOS_FORCEINLINE_FUNCTION void set_zero() {
    static_for<(1 << Dim)>([&](auto k) VSB_UNROLLED {
      m[k] = T(0);
      static_for<Dim>([&](auto j) VSB_UNROLLED { square[j][k] = T(0); });
    });
  }
  /// Adds a particle of weight w at xi in [0, 1]^Dim to all moments.
  KOKKOS_FORCEINLINE_FUNCTION void add(T w, const Vector<Dim, T>& xi) {
    add_moments<Dim>(m, w, xi);
    if constexpr (Dim > 1) static_for<Dim>([&](auto j) VSB_UNROLLED { add_square<j>(w, xi); });
  }
  /// The moments that a stress needs that varies along direction j alone.
  template <int j>
  KOKKOS_FORCEINLINE_FUNCTION void add_along(T w, const Vector<Dim, T>& xi) {
    add_moments<Dim>(m, w, xi);
    if constexpr (Dim > 1) add_square<j>(w, xi);
  }
  /// Adds a particle of weight w at xi to the moments with xi_j squared.
  template <int j>
  KOKKOS_FORCEINLINE_FUNCTION void add_square(T w, const Vector<Dim, T>& xi) {
    const T wjj = w * xi[j] * xi[j];
    square[j][0] += wjj;
    static_for<Dim>([&](auto i) VSB_UNROLLED {
      if constexpr (Dim > 2 && i != j) square[j][1 << i] += wjj * xi[i];
    });
  }
  /// The moment of xi_j q_k.
  template <int j, int k>
  KOKKOS_FORCEINLINE_FUNCTION const T& times() const {
    if constexpr (k >> j & 1)
      return square[j][k ^ (1 << j)];
    else
      return m[k | (1 << j)];
  }
};

/// The moments sum_p w_p (s(xi_p) . grad q_k) of s_i = b_i + sum_j d_ij xi_j.
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION CellPolynomial<Dim, T> gradient_moments(const Vector<Dim, T>& b,
                                                                    const Matrix<Dim, T>& d,
                                                                    const SecondMoments<Dim, T>& w) {
  CellPolynomial<Dim, T> g;
  static_for<(1 << Dim)>([&](auto k) VSB_UNROLLED {
    g[k] = T(0);
    static_for<Dim>([&](auto i) VSB_UNROLLED {
      if constexpr (k >> i & 1) {
        constexpr int rest = k ^ (1 << i);
        g[k] += b[i] * w.m[rest];
        static_for<Dim>([&](auto j) VSB_UNROLLED { g[k] += d(i, j) * w.template times<j, rest>(); });
      }
    });
  });
  return g;
}

/// The same of s along direction i that varies along j, s_i = b + d xi_j, from what add_along<j> added up.
template <int i, int j, int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION CellPolynomial<Dim, T> gradient_moments_along(T b, T d,
                                                                          const SecondMoments<Dim, T>& w) {
  CellPolynomial<Dim, T> g;
  static_for<(1 << Dim)>([&](auto k) VSB_UNROLLED {
    if constexpr (k >> i & 1) {
      constexpr int rest = k ^ (1 << i);
      g[k] = b * w.m[rest] + d * w.template times<j, rest>();
    } else {
      g[k] = T(0);
    }
  });
  return g;
}

}  // namespace vsb
