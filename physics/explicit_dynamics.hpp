// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Explicit time integration at one node: local damping, and the time step that stability allows.
#pragma once

#include <vsb/views/pack.hpp>

namespace vsb {

///@{
/// Whether a node has mass to move: below the smallest normal number 1 / m overflows.
template <class Real>
KOKKOS_FORCEINLINE_FUNCTION bool has_mass(Real m) {
  return m >= math::smallest_normal<Real>;
}
template <class Real, int W>
KOKKOS_FORCEINLINE_FUNCTION typename Pack<Real, W>::Mask has_mass(Pack<Real, W> m) {
  return m >= Pack<Real, W>(math::smallest_normal<Real>);
}
///@}

/// Cundall's local damping of one force component: f <- f - alpha |f| sign(v). It is proportional to the
/// unbalanced force, and vanishes in equilibrium. It is not Galilean invariant: never use it on a body that
/// moves as a whole.
template <class T>
KOKKOS_INLINE_FUNCTION T cundall_damped(T force, T velocity, T alpha) {
  const T drag = alpha * math::abs(force);
  return math::select(velocity > T(0), T(force - drag),
                      math::select(velocity < T(0), T(force + drag), force));
}

/// dt = kappa h / sqrt(M / rho), Eq. (29): the share kappa of the time a compression wave takes to cross a
/// cell. h in m, constrained modulus M in Pa, density rho in kg/m^3; s.
inline double time_step(double kappa, double h, double constrained_modulus, double density) {
  return kappa * h / math::sqrt(constrained_modulus / density);
}

}  // namespace vsb
