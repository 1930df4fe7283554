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

/// Volumes of the bodies with cut lattices, m^3. Together they are the bodies' own, but for what is thinner
/// than the sampling sees.
struct CutVolume {
  double particles = 0;
  double dropped = 0;  ///< in slivers too small for a particle
};

struct PlacedParticles {
  std::vector<Point> position;
  std::vector<double> volume;
  std::vector<PlacedBody> bodies;
  CutVolume cut;
};

/// Puts a particle at every point of a body's lattice that lies in its shape and in the grid, then moves it
/// by the body's jitter; for a cut lattice see run/cut_lattice.hpp. Throws SetupError for an empty body, for
/// bodies that overlap, and for a jitter that moves a particle out of the grid.
PlacedParticles place_particles(const Scene& scene);

}  // namespace vsb::app
