// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Stress and plastic strain of the particles of one slot of cell lanes over a step, for plastic materials:
///   sigma_trial = elastic(sigma, L dt) for all lanes at once;
///   the return to the yield surface lane by lane, where the trial stress of a lane may lie beyond it.
/// The plastic strain turns with the material. It is written only where a slot has some.
#pragma once

#include <vsb/physics/plastic_strain.hpp>
#include <vsb/views/cell_lanes.hpp>

namespace vsb {

namespace kernel {

/// Returns the stress of some lanes of a slot, which holds their trial stress, to the yield surface. The
/// state of a ghost is reset instead.
template <class Material, int Dim, class Real, class Device>
[[gnu::noinline]] KOKKOS_FUNCTION void return_lanes(const CellLanes<Dim, Real, Device>& lanes,
                                                    const Material& material, size_t entry,
                                                    typename Lanes<Real>::Pack::Mask which) {
  constexpr int remembered = Material::template state_size<Dim>();
  for (int l = 0; l < Lanes<Real>::width; ++l) {
    const size_t e = entry + static_cast<size_t>(l);
    if (!which[l]) continue;
    if (lanes.id(e) < 0) {
      lanes.clear(e);
      continue;
    }
    SymmetricTensor<Dim, Real> stress;
    Vector<remembered, Real> state;
    for (int c = 0; c < stress.size; ++c) stress[c] = *lanes.at(lanes.stress_column + c, e);
    for (int c = 0; c < remembered; ++c) state[c] = *lanes.at(lanes.state_column + c, e);
    material.return_stress(stress, state);
    for (int c = 0; c < stress.size; ++c) *lanes.at(lanes.stress_column + c, e) = stress[c];
    for (int c = 0; c < remembered; ++c) *lanes.at(lanes.state_column + c, e) = state[c];
  }
}

/// dt L is the displacement gradient of the step.
template <class Material, int Dim, class Real, class Device>
KOKKOS_FORCEINLINE_FUNCTION void advance_plastic_lanes(
    const CellLanes<Dim, Real, Device>& lanes, const Material& material, size_t entry,
    const SymmetricTensor<Dim, typename Lanes<Real>::Pack>& sigma,
    const Matrix<Dim, typename Lanes<Real>::Pack>& dt_L) {
  using P = typename Lanes<Real>::Pack;
  const auto trial = material.elastic.advance(sigma, dt_L, P(1));
  lanes.store_row(lanes.stress_column, entry, trial);
  auto state = lanes.template load_row<Material::template state_size<Dim>()>(lanes.state_column, entry);
  if constexpr (Dim > 1) {
    auto strained = !(state[0] == P(0));
    static_for<symmetric_components(Dim)>([&](auto c)
                                              VSB_UNROLLED { strained = strained | !(state[c] == P(0)); });
    if (any(strained)) {
      turn_plastic_strain(state, dt_L, P(1));
      static_for<symmetric_components(Dim)>(
          [&](auto c) VSB_UNROLLED { lanes.store(lanes.state_column + c, entry, state[c]); });
    }
  }
  const auto beyond = material.may_yield(trial, state);
  if (any(beyond)) return_lanes(lanes, material, entry, beyond);
}

}  // namespace kernel

}  // namespace vsb
