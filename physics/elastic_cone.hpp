// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A cone in stress space that lies within a yield surface, to tell elastic states without their principal
/// values:
///   sqrt(J2) + slope sigma_m <= strength,   sigma_m + 2 sqrt(J2 / 3) <= tensile strength,
/// with the mean stress sigma_m and the second invariant J2 of the deviator; the largest principal stress is
/// never above the left-hand side of the second.
#pragma once

#include <vsb/views/tensor.hpp>

namespace vsb {

/// J2 = 1/2 s : s of the deviator s of a stress with the given mean.
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION T second_invariant(const SymmetricTensor<Dim, T>& stress, T mean) {
  T twice = T(0), shear = T(0);
  for (int i = 0; i < 3; ++i) {
    const T s = stress[i] - mean;
    twice += s * s;
  }
  for (int c = 3; c < SymmetricTensor<Dim, T>::size; ++c) shear += stress[c] * stress[c];
  return T(0.5) * twice + shear;
}

/// (sxx + syy + szz) / 3.
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION T mean_stress(const SymmetricTensor<Dim, T>& stress) {
  return (T(1) / T(3)) * (stress[0] + stress[1] + stress[2]);
}

/// Whether sqrt(J2) + slope sigma_m > strength; on packs for every lane.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION auto outside_cone(T J2, T mean, T slope, T strength) {
  const T margin = strength - slope * mean;
  return (J2 > T(margin * margin)) | (margin < T(0));
}

/// Whether sigma_m + 2 sqrt(J2 / 3) > tensile strength; on packs for every lane.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION auto may_exceed_tension(T J2, T mean, T tensile_strength) {
  const T margin = tensile_strength - mean;
  return (T(T(4) / T(3) * J2) > T(margin * margin)) | (margin < T(0));
}

}  // namespace vsb
