// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Exact solution of the axially loaded column (Section 4.1), with logarithmic strain; x from the fixed end.
#pragma once

#include <vsb/views/kokkos_compat.hpp>

namespace vsb {

template <class T>
struct ExactColumn {
  T traction;  ///< at the free end, Pa, positive in compression
  T modulus;   ///< in uniaxial strain, Pa (Young's modulus for Poisson ratio 0)

  /// Axial Cauchy stress (A2), Pa, tension positive.
  KOKKOS_FUNCTION T stress() const { return -traction; }

  /// Displacement of the particle that was at x0, m: the logarithmic strain ln(1 + u / x0) is -traction /
  /// modulus.
  KOKKOS_FUNCTION T displacement(T x0) const { return x0 * math::expm1(-traction / modulus); }

  /// (A1) as printed, with the sign of a shortening. It differs from the exact one by (traction / modulus)^3
  /// / 6 x0.
  KOKKOS_FUNCTION T displacement_as_printed(T x0) const { return -x0 * math::log1p(traction / modulus); }
};

}  // namespace vsb
