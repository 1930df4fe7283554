// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Exact solutions of the column (Section 4.1) under an axial Cauchy traction, in uniaxial strain; x from the
/// fixed end. The stretch is l = 1 + u / x0.
#pragma once

#include <vsb/views/kokkos_compat.hpp>

namespace vsb {

/// Material in rate form: the stress is modulus ln l.
template <class T>
struct ExactColumn {
  T traction;  ///< at the free end, Pa, positive in compression
  T modulus;   ///< in uniaxial strain, Pa (Young's modulus for Poisson ratio 0)

  /// Axial Cauchy stress, Eq. (A2), Pa, tension positive.
  KOKKOS_FUNCTION T stress() const { return -traction; }

  /// Displacement of the particle that was at x0, m: the logarithmic strain ln(1 + u / x0) is -traction /
  /// modulus.
  KOKKOS_FUNCTION T displacement(T x0) const { return x0 * math::expm1(-traction / modulus); }

  /// Eq. (A1) as printed, with the sign of a shortening. It differs from the exact displacement by
  /// (traction / modulus)^3 / 6 x0.
  KOKKOS_FUNCTION T displacement_as_printed(T x0) const { return -x0 * math::log1p(traction / modulus); }
};

/// Hencky's law: the stress is modulus ln l / l. In tension it has the limit modulus / e.
template <class T>
struct ExactHenckyColumn {
  T traction;  ///< at the free end, Pa, positive in compression; >= -modulus / e
  T modulus;   ///< in uniaxial strain, Pa

  /// The largest tension over the modulus: 1 / e.
  static constexpr double limit() { return 0.36787944117144233; }

  /// Axial Cauchy stress, Pa, tension positive.
  KOKKOS_FUNCTION T stress() const { return -traction; }

  /// The root w = ln l of w + s exp(w), s = traction / modulus, by Newton's method from 0, which approaches
  /// it from one side (w = -W(s), Lambert's function).
  KOKKOS_FUNCTION T logarithmic_stretch() const {
    const T s = traction / modulus;
    T w = T(0);
    for (int i = 0; i < 60; ++i) {
      const T e = s * math::exp(w), slope = T(1) + e;
      if (!(slope > T(0))) break;  // at the limit
      const T before = w;
      w -= (w + e) / slope;
      if (w == before) break;
    }
    return w;
  }
  /// Displacement of the particle that was at x0, m: u = x0 (l - 1).
  KOKKOS_FUNCTION T displacement(T x0) const { return x0 * math::expm1(logarithmic_stretch()); }
};

}  // namespace vsb
