// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Multilinear functions of local coordinates xi in [0, 1]^Dim, and the cell they map to:
///   N_a(xi) = prod_i (xi_i or 1 - xi_i),   x(xi) = sum_a N_a X_a,   J = dx/dxi.
/// Corner a lies at xi_i = bit i of a. A cell with det J > 0 is an interval, a convex quadrilateral, or a
/// hexahedron whose faces may be warped.
#pragma once

#include <vsb/views/tensor.hpp>

namespace vsb {

/// The functions and their derivatives; those with respect to x_i are `slope`_i = dxi_i / dx_i times those
/// with respect to xi_i.
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void multilinear(const Vector<Dim, T>& xi, const Vector<Dim, T>& slope,
                                             T (&N)[1 << Dim], Vector<Dim, T> (&dN)[1 << Dim]) {
  T factors[Dim][2];
  for (int i = 0; i < Dim; ++i) {
    factors[i][1] = xi[i];
    factors[i][0] = T(1) - xi[i];
  }
  for (int a = 0; a < 1 << Dim; ++a) {
    N[a] = T(1);
    for (int j = 0; j < Dim; ++j) dN[a][j] = (a >> j & 1) ? slope[j] : -slope[j];
    for (int i = 0; i < Dim; ++i) {
      const T factor = factors[i][a >> i & 1];
      N[a] *= factor;
      for (int j = 0; j < Dim; ++j)
        if (i != j) dN[a][j] *= factor;
    }
  }
}

/// A local coordinate in [0, 1], moved off the faces of its cell by round-off. A particle on a face adds no
/// mass to the nodes on the opposite face, N_a = 0, but grad N_a is not zero there. Its force at these nodes
/// would be lost, and its velocity gradient would be wrong, since nodes without mass are at rest.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION T off_the_faces(T xi) {
  return math::min(math::max(xi, math::epsilon<T>), T(1) - T(0.5) * math::epsilon<T>);
}

/// One cell, by the positions of its corners in m.
template <int Dim, class T>
struct MultilinearCell {
  static constexpr int corners = 1 << Dim;  ///< 2^Dim
  Vector<Dim, T> corner[corners];           ///< X_a

  /// The functions at a point of the cell, with respect to xi, and the map there.
  struct Point {
    T N[corners];                ///< N_a
    Vector<Dim, T> dN[corners];  ///< dN_a / dxi
    Vector<Dim, T> x;            ///< m
    Matrix<Dim, T> J;            ///< J(i, k) = dx_i / dxi_k
  };
  /// The functions and the map at xi in [0, 1]^Dim.
  KOKKOS_FUNCTION Point at(const Vector<Dim, T>& xi) const {
    Vector<Dim, T> one;
    for (int i = 0; i < Dim; ++i) one[i] = T(1);
    Point p;
    multilinear(xi, one, p.N, p.dN);
    p.x = Vector<Dim, T>::zero();
    p.J = Matrix<Dim, T>::zero();
    for (int a = 0; a < corners; ++a)
      for (int i = 0; i < Dim; ++i) {
        p.x[i] += p.N[a] * corner[a][i];
        for (int k = 0; k < Dim; ++k) p.J(i, k) += p.dN[a][k] * corner[a][i];
      }
    return p;
  }

  /// m^Dim. Two Gauss points per direction are exact: det J is at most quadratic in each xi_i.
  KOKKOS_FUNCTION T volume() const {
    const T offset = T(0.5) / math::sqrt(T(3));
    T sum = 0;
    for (int g = 0; g < corners; ++g) {
      Vector<Dim, T> xi;
      for (int i = 0; i < Dim; ++i) xi[i] = T(0.5) + ((g >> i & 1) ? offset : -offset);
      sum += determinant(at(xi).J);
    }
    return sum / T(corners);
  }

  /// Local coordinates of x. Without convergence the point is outside the cell, in the direction of the
  /// coordinates.
  struct Inverse {
    Vector<Dim, T> xi;  ///< beyond [0, 1]^Dim outside the cell
    bool converged;     ///< whether `xi` is the solution of x(xi) = x
  };
  /// Newton's method from the centre. Iterates are limited to the cell, where J is regular. An iterate that
  /// no longer moves shows that x lies beyond a face.
  KOKKOS_FORCEINLINE_FUNCTION Inverse inverse(const Vector<Dim, T>& x) const {
    constexpr int most_iterations = 32;
    Vector<Dim, T> c[corners];
    coefficients(c);
    c[0] -= x;
    Inverse result{Vector<Dim, T>::zero(), false};
    Vector<Dim, T> xi;
    for (int i = 0; i < Dim; ++i) xi[i] = T(0.5);
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      Vector<Dim, T> residual;
      Matrix<Dim, T> J;
      evaluate(c, xi, residual, J);
      if (!(determinant(J) > T(0))) break;
      const auto step = vsb::inverse(J) * residual;
      T length = 0, moved = 0;
      for (int i = 0; i < Dim; ++i) {
        result.xi[i] = xi[i] - step[i];
        const T next = math::max(T(0), math::min(T(1), result.xi[i]));
        length = math::max(length, math::abs(step[i]));
        moved = math::max(moved, math::abs(next - xi[i]));
        xi[i] = next;
      }
      // Convergence is quadratic: after a step of sqrt(epsilon), round-off remains.
      if (length * length <= math::epsilon<T>) {
        result.converged = true;
        break;
      }
      if (moved == T(0)) break;
    }
    return result;
  }

 private:
  /// The map as a polynomial: x = sum_a c_a prod_(i in a) xi_i.
  KOKKOS_FORCEINLINE_FUNCTION void coefficients(Vector<Dim, T> (&c)[corners]) const {
    for (int a = 0; a < corners; ++a) c[a] = corner[a];
    for (int i = 0; i < Dim; ++i)
      for (int a = 0; a < corners; ++a)
        if (a >> i & 1) c[a] -= c[a ^ 1 << i];
  }
  /// The polynomial and its derivatives J(i, k) = dx_i / dxi_k.
  KOKKOS_FORCEINLINE_FUNCTION static void evaluate(const Vector<Dim, T> (&c)[corners],
                                                   const Vector<Dim, T>& xi, Vector<Dim, T>& x,
                                                   Matrix<Dim, T>& J) {
    T products[corners];
    products[0] = T(1);
    for (int i = 0; i < Dim; ++i)
      for (int a = 0; a < 1 << i; ++a) products[a | 1 << i] = products[a] * xi[i];
    for (int i = 0; i < Dim; ++i) {
      x[i] = c[0][i];
      for (int a = 1; a < corners; ++a) x[i] += c[a][i] * products[a];
      for (int k = 0; k < Dim; ++k) {
        J(i, k) = c[1 << k][i];
        for (int a = 0; a < corners; ++a)
          if ((a >> k & 1) && a != 1 << k) J(i, k) += c[a][i] * products[a ^ 1 << k];
      }
    }
  }
};

}  // namespace vsb
