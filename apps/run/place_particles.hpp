// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The particles of a scene at the start, on the host.
#pragma once

#include <vector>

#include "scene/scene.hpp"

namespace vsb::app {

/// Particles first, ..., last - 1 of a body.
struct PlacedBody {
  int first, last;
};

struct PlacedParticles {
  std::vector<Point> position;
  std::vector<double> volume;
  std::vector<PlacedBody> bodies;
};

/// Puts a particle at every lattice point that lies in a body: particles_per_cell equal intervals of every
/// cell in every direction, a particle in the middle of each. Throws SetupError for an empty body and for
/// bodies that overlap.
PlacedParticles place_particles(const Scene& scene);

}  // namespace vsb::app
