// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The basis functions at one point, as a value, by which particles and nodes exchange data.
#pragma once

#include <vsb/views/tensor.hpp>

namespace vsb {

/// The Support nodes whose basis functions may be non-zero at a point.
template <int Dim, int Support, class T>
struct Shape {
  static constexpr int support = Support;  ///< number of nodes
  int node[Support];                       ///< node numbers
  T N[Support];                            ///< basis functions N_I(x)
  Vector<Dim, T> dN[Support];              ///< their gradients, 1/m

  /// sum_I N_I f(I), Eq. (8); `field` maps a node number to a Vector.
  VSB_ANY_CALLABLE
  template <class Field>
  KOKKOS_FORCEINLINE_FUNCTION Vector<Dim, T> interpolate(const Field& field) const {
    Vector<Dim, T> value = Vector<Dim, T>::zero();
    for (int a = 0; a < Support; ++a)
      for (int i = 0; i < Dim; ++i) value[i] += N[a] * field(node[a], i);
    return value;
  }

  /// sum_I f(I) (x) grad N_I: the gradient G(i, j) = d f_i / d x_j of the interpolated field.
  VSB_ANY_CALLABLE
  template <class Field>
  KOKKOS_FORCEINLINE_FUNCTION Matrix<Dim, T> gradient(const Field& field) const {
    Matrix<Dim, T> g = Matrix<Dim, T>::zero();
    for (int a = 0; a < Support; ++a)
      for (int i = 0; i < Dim; ++i)
        for (int j = 0; j < Dim; ++j) g(i, j) += field(node[a], i) * dN[a][j];
    return g;
  }
};

}  // namespace vsb
