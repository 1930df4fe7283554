// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The particles of a scene at the start, on the host.
#pragma once

#include <array>
#include <functional>
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

/// What the fit of moments (run/moment_fit.hpp) did.
struct MomentFit {
  std::array<int, 5> cells{};  ///< [0] left alone; [1 + n]: with the moments of products of n coordinates
  double volume_before = 0, volume_after = 0;  ///< of the fitted bodies' particles, m^3
};

struct PlacedParticles {
  std::vector<Point> position;
  std::vector<double> volume;
  std::vector<PlacedBody> bodies;
  CutVolume cut;
  MomentFit moment_fit;
};

/// Puts a particle at every point of a body's lattice that lies in its shape and in the grid, then moves it
/// by the body's jitter; for a cut lattice see run/cut_lattice.hpp. Then fits moments, where asked. Throws
/// SetupError for an empty body, for bodies that overlap, and for a jitter that moves a particle out of the
/// grid.
PlacedParticles place_particles(const Scene& scene);

/// Their mass, kg, and its centre.
struct MassCentre {
  double mass = 0;
  Point position{};
};
MassCentre mass_centre(const Scene& scene, const PlacedParticles& placed);

/// Calls visit(x) for all of them in order, x being where they are placed, and keeps none.
void for_each_start(const Scene& scene, const std::function<void(const Point&)>& visit);

}  // namespace vsb::app
