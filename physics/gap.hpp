// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The gap g of a material that carries no tension: the volumetric strain by which it has been pulled apart.
/// Where the yield surface ends at zero stress, the return to that apex would forget how far the material
/// has opened, so that it would carry stress as soon as it is pressed again. With the bulk modulus K,
///   trial' = trial + K g I,   sigma = return(trial'),
///   g <- mean(trial') / K where sigma is the apex, else 0:
/// an open gap takes the volumetric strain of a step without stress, and what is left of the strain once the
/// gap has closed goes to the stress. The plastic strain contains the gap.
#pragma once

#include <vsb/physics/linear_elastic.hpp>

namespace vsb {

/// The gap in the state of a plastic material, where it follows the plastic strain.
template <int Dim, int N, class T>
KOKKOS_FORCEINLINE_FUNCTION T gap_in(const Vector<N, T>& state) {
  return state[symmetric_components(Dim)];
}

/// Moves the gap from the state into the trial stress.
template <int Dim, int N, class Real>
KOKKOS_FUNCTION void press_into_gap(const LinearElastic<Real>& elastic, SymmetricTensor<Dim, Real>& trial,
                                    Vector<N, Real>& state) {
  const Real gap = gap_in<Dim>(state);
  if (!(gap > 0)) return;
  state[symmetric_components(Dim)] = 0;
  for (int i = 0; i < 3; ++i) {
    trial[i] += elastic.bulk_modulus() * gap;
    state[i] -= gap / 3;
  }
}

/// The gap of a trial stress of the given mean that returns to an apex at zero.
template <int Dim, int N, class Real>
KOKKOS_FUNCTION void open_gap(const LinearElastic<Real>& elastic, Real mean, Vector<N, Real>& state) {
  state[symmetric_components(Dim)] = math::max(mean, Real(0)) / elastic.bulk_modulus();
}

}  // namespace vsb
