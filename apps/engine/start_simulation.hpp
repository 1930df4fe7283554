// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Makes the simulation of a scene on its basis; compiled for each dimension and precision once for all
/// bases, from simulation_instance.cpp.in.
#pragma once

#include "engine/scene_basis.hpp"

namespace vsb::app {

/// `placed`: as of make_simulation. Throws SetupError.
template <int Dim, class Real>
std::unique_ptr<Simulation> start_simulation(const Scene& scene, PlacedParticles* placed,
                                             std::unique_ptr<SceneBasis<Dim, Real>> basis);

}  // namespace vsb::app
