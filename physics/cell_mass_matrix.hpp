// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The consistent mass matrix of one cell with multilinear basis functions, M_ab = sum_p m_p N_a(xi_p)
/// N_b(xi_p).
///
/// Along one direction a product of two basis functions is (1 - xi)^2, xi (1 - xi) or xi^2, so that M has
/// 3^Dim different numbers. Each is a sum of terms of one sign, exact to round-off even at a node of little
/// mass. Differences of moments would not be. T is a number, or a pack with a cell in every lane.
#pragma once

#include <vsb/views/static_for.hpp>
#include <vsb/views/tensor.hpp>

namespace vsb {

/// Number sum_i 3^i (bit i of a + bit i of b) is M_ab; corners as in multilinear.hpp.
template <int Dim, class T>
using CellMassMatrix = Vector<(Dim == 1   ? 3
                               : Dim == 2 ? 9
                                          : 27),
                              T>;

namespace detail {
KOKKOS_INLINE_FUNCTION constexpr int number_in_mass_matrix(int a, int b, int dim) {
  int number = 0, power = 1;
  for (int i = 0; i < dim; ++i, power *= 3) number += power * ((a >> i & 1) + (b >> i & 1));
  return number;
}
}  // namespace detail

/// M_ab += m N_a N_b.
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void add_mass(CellMassMatrix<Dim, T>& M, T m, const Vector<Dim, T>& xi) {
  constexpr int rows = CellMassMatrix<Dim, T>::size / 3;
  T along[Dim][3];
  static_for<Dim>([&](auto i) VSB_UNROLLED {
    const T other = T(1) - xi[i];
    along[i][0] = other * other;
    along[i][1] = other * xi[i];
    along[i][2] = xi[i] * xi[i];
  });
  Vector<rows, T> others;  // over all directions but the first
  static_for<rows>([&](auto r) VSB_UNROLLED {
    if constexpr (Dim == 2) others[r] = along[1][r];
    if constexpr (Dim == 3) others[r] = along[1][r % 3] * along[2][r / 3];
  });
  static_for<3>([&](auto k) VSB_UNROLLED {
    const T mk = m * along[0][k];
    static_for<rows>([&](auto r) VSB_UNROLLED {
      if constexpr (Dim == 1)
        M[k] += mk;
      else
        M[3 * r + k] += mk * others[r];
    });
  });
}

/// sum_b M_ab u_b, nodal values to nodal values.
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION Vector<(1 << Dim), T> times(const CellMassMatrix<Dim, T>& M,
                                                        const Vector<(1 << Dim), T>& u) {
  Vector<(1 << Dim), T> p;
  static_for<(1 << Dim)>([&](auto a) VSB_UNROLLED {
    p[a] = M[detail::number_in_mass_matrix(a, 0, Dim)] * u[0];
    static_for<(1 << Dim)>([&](auto b) VSB_UNROLLED {
      if constexpr (b > 0) p[a] += M[detail::number_in_mass_matrix(a, b, Dim)] * u[b];
    });
  });
  return p;
}

}  // namespace vsb
