// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Quadratic B-splines on a uniform grid: in each direction, at the distance xi in cells from the nearest
/// node,
///   N = (1/2 - xi)^2 / 2,  3/4 - xi^2,  (1/2 + xi)^2 / 2
/// at the nodes below, at and above it. The functions and their gradients are continuous; the support of a
/// node is 1.5 cells on either side. Values at nodes are not values of the field there.
#pragma once

#include <vsb/physics/nearest_node_basis.hpp>

namespace vsb {

/// The functions of one direction at the distance xi in cells from the nearest node, -1/2 <= xi <= 1/2.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION NodeTriple<T> quadratic_bspline(T xi) {
  const T below = T(0.5) - xi, above = T(0.5) + xi;
  return {{T(0.5) * below * below, T(0.75) - xi * xi, T(0.5) * above * above}, {-below, -2 * xi, above}};
}

/// Products of quadratic B-splines on a uniform grid with a ghost layer; the equation is at the top of this
/// file.
template <int Dim, class Real>
struct QuadraticBSplineBasis : NearestNodeBasis<Dim, Real> {
  using NearestNodeBasis<Dim, Real>::support;

  /// The basis functions at x, which must lie in the grid without its ghost layer.
  KOKKOS_FORCEINLINE_FUNCTION Shape<Dim, support, Real> shape(const Vector<Dim, Real>& x) const {
    return this->product_shape(x, [](int, Real xi) { return quadratic_bspline(xi); });
  }
};

}  // namespace vsb
