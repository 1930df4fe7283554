// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The basis of uGIMP, the generalised interpolation material point method with particles that keep their
/// size: linear functions averaged over a particle of half-width l, in cells, l <= 1/2. At the distance xi
/// from the nearest node, in each direction, the node above it has
///   N = 0 for xi <= -l,   (xi + l)^2 / (4 l) for |xi| <= l,   xi for xi >= l,
/// the node below it the mirror image, and the nearest one the rest. l = 1/2 gives the quadratic B-spline.
#pragma once

#include <vsb/physics/nearest_node_basis.hpp>

namespace vsb {

/// The functions of one direction at the distance xi in cells from the nearest node, -1/2 <= xi <= 1/2, for a
/// particle of half-width 0 < l <= 1/2 in cells.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION NodeTriple<T> uniform_gimp(T xi, T half_width) {
  const T l = half_width, above = math::max(T(0), xi + l), below = math::max(T(0), l - xi);
  const T N_above = xi >= l ? xi : above * above / (4 * l), dN_above = xi >= l ? T(1) : above / (2 * l);
  const T N_below = xi <= -l ? -xi : below * below / (4 * l), dN_below = xi <= -l ? T(-1) : -below / (2 * l);
  return {{N_below, T(1) - N_below - N_above, N_above}, {dN_below, -dN_below - dN_above, dN_above}};
}

/// Products of uGIMP functions on a uniform grid with a ghost layer; the equation is at the top of this file.
template <int Dim, class Real>
struct UniformGimpBasis : NearestNodeBasis<Dim, Real> {
  using NearestNodeBasis<Dim, Real>::support;

  Vector<Dim, Real> half_width;  ///< of a particle, in cells, 0 < half_width <= 1/2

  /// The basis functions at x, which must lie in the grid without its ghost layer.
  KOKKOS_FORCEINLINE_FUNCTION Shape<Dim, support, Real> shape(const Vector<Dim, Real>& x) const {
    return this->product_shape(x, [this](int i, Real xi) { return uniform_gimp(xi, half_width[i]); });
  }
};

}  // namespace vsb
