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

/// Puts a particle at every point of a body's lattice that lies in its shape and in the grid, then moves it
/// by the body's jitter. Throws SetupError for an empty body, for bodies that overlap, and for a jitter that
/// moves a particle out of the grid.
PlacedParticles place_particles(const Scene& scene);

}  // namespace vsb::app
