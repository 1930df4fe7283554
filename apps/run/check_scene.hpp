// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What can be said of a scene before it runs: `vsb check`.
#pragma once

#include "setup/place_particles.hpp"

namespace vsb::app {

/// Prints the resolved scene and what a run of it would cost; writes no file. `placed`: the particles, where
/// they have been placed already. Throws SetupError.
void check_scene(const Scene& scene, PlacedParticles* placed);

}  // namespace vsb::app
