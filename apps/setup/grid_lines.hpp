// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Particles on grid lines. The gradient of the linear basis jumps there: a particle on the line between two
/// cells loads the nodes of only one of them, and a patch under uniform stress is out of balance by a tenth.
#pragma once

#include "setup/place_particles.hpp"

namespace vsb::app {

struct ParticlesOnGridLines {
  int count;
  Point first;  ///< m, of the first of them
};

/// Particles within 1e-9 cells of a line between two cells, in any direction; faces of the grid do not count.
ParticlesOnGridLines find_on_grid_lines(const Scene& scene, const PlacedParticles& placed);

/// Throws SetupError where there are any, or warns on standard error where the scene allows them.
void refuse_on_grid_lines(const Scene& scene, const PlacedParticles& placed);

}  // namespace vsb::app
