// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Exact solution of the internally pressurised thick-walled cylinder in plane strain about the origin,
/// Eq. (A3), Eq. (A4), Eq. (A5).
#pragma once

#include <vsb/physics/polar.hpp>

namespace vsb {

/// Radial displacement and stress in a linear elastic cylinder of inner radius a < b whose outer face is
/// free; Eq. (A3), Eq. (A4), Eq. (A5).
template <class T>
struct ExactCylinder {
  T inner_radius;    ///< a, m
  T outer_radius;    ///< b, m
  T pressure;        ///< p_i in the hole, Pa, positive in compression
  T youngs_modulus;  ///< E, Pa
  T poisson_ratio;   ///< nu

  /// u_r, Eq. (A3), m.
  KOKKOS_FUNCTION T radial_displacement(T r) const {
    const T b_r = outer_radius / r;
    return (1 + poisson_ratio) / youngs_modulus * scale() * r * ((1 - 2 * poisson_ratio) + b_r * b_r);
  }
  /// sigma_rr, Eq. (A4), and sigma_tt, Eq. (A5), Pa, tension positive.
  KOKKOS_FUNCTION PolarStress<T> stress(T r) const {
    const T b_r = outer_radius / r;
    return {scale() * (1 - b_r * b_r), scale() * (1 + b_r * b_r), T(0)};
  }

 private:
  KOKKOS_FUNCTION T scale() const {
    const T b_a = outer_radius / inner_radius;
    return pressure / (b_a * b_a - 1);
  }
};

}  // namespace vsb
