// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Takes particles out of bodies, and out of the memory of the particle kernels.
#pragma once

#include <algorithm>
#include <string>
#include <vsb/kernels/particles/remove_particles.hpp>
#include "setup/execution_space.hpp"
#include "setup/set_up_particles.hpp"

namespace vsb::app {

/// Which particles, and which rows of material state, stay.
struct Kept {
  std::vector<int> particles, states;
};

/// Leaves the bodies with the particles that have a 0 in `removed`.
template <int Dim, class Real>
Kept keep_in_bodies(std::vector<Body<Real>>& bodies, const std::vector<unsigned char>& removed) {
  Kept kept;
  for (auto& body : bodies) {
    const bool has_state = state_size<Dim>(body.material) > 0;
    const int begin = static_cast<int>(kept.particles.size());
    for (int p = body.first; p < body.last; ++p) {
      if (removed[static_cast<size_t>(p)] != 0) continue;
      kept.particles.push_back(p);
      if (has_state) kept.states.push_back(p + body.state_offset);
    }
    body.first = begin;
    body.last = static_cast<int>(kept.particles.size());
  }
  number_states<Dim>(bodies);
  return kept;
}

template <int Dim, class Real, class Device>
ParticleBlock<Dim, Real, Device> keep_in_block(const ExecutionSpace& exec,
                                               const ParticleBlock<Dim, Real, Device>& block,
                                               const Kept& kept) {
  const auto on_device = [](const std::string& name, const std::vector<int>& numbers) {
    const Kokkos::View<int*, Device> view(name, numbers.size());
    const auto host = Kokkos::create_mirror_view(view);
    std::copy(numbers.begin(), numbers.end(), host.data());
    Kokkos::deep_copy(view, host);
    return view;
  };
  return keep_particles<ExecutionSpace, Dim, Real, Device>(exec, block,
                                                           on_device("vsb::kept_particles", kept.particles),
                                                           on_device("vsb::kept_states", kept.states));
}

}  // namespace vsb::app
