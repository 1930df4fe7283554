// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Initial stresses that a material cannot have.
#pragma once

#include "setup/place_particles.hpp"

namespace vsb::app {

/// Throws SetupError where a particle begins with a stress beyond the yield surface of its material, which
/// would return it to the surface in the first step. A stress on the surface may be off by round-off.
void refuse_stress_beyond_yield(const Scene& scene, const PlacedParticles& placed);

}  // namespace vsb::app
