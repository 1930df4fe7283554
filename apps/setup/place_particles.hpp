// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The particles of a scene at the start, on the host.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "scene/scene.hpp"
#include "setup/lattice_points.hpp"

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

/// What the fit of moments (setup/moment_fit.hpp) did.
struct MomentFit {
  std::array<int, 5> cells{};  ///< [0] left alone; [1 + n]: with the moments of products of n coordinates
  double volume_before = 0, volume_after = 0;  ///< of the fitted bodies' particles, m^3
};

/// Where the particles of a body with a cut lattice begin, so that it is cut once: whole boxes side by side
/// by the index of the first one, shares of boxes by their position.
class CutStarts {
 public:
  CutStarts() = default;
  explicit CutStarts(const UniformLattice& lattice) : lattice_(lattice) {}
  void add_whole(const LatticeIndex& box);
  void add_share(const Point& x);
  /// In the order in which they were added.
  void for_each(int dimension, const std::function<void(const Point&)>& visit) const;

 private:
  struct Run {
    LatticeIndex first;
    long long whole, shares;  ///< so many whole boxes, then so many shares
  };
  UniformLattice lattice_;
  std::vector<Run> runs_;
  std::vector<Point> shares_;
};

/// What a particle covers of a face of the grid across an axis; see FaceCover of
/// kernels/readout/resultant.hpp.
struct PlacedCover {
  int particle;
  size_t axis;
  double cover;
};

struct PlacedParticles {
  std::vector<Point> position;
  std::vector<double> volume;
  std::vector<PlacedBody> bodies;
  std::vector<PlacedCover> covers;  ///< where it is not that of the box around the particle
  std::vector<CutStarts> starts;    ///< [body]; of those with cut lattices
  CutVolume cut;
  MomentFit moment_fit;
};

/// Puts a particle at every point of a body's lattice that lies in its shape and in the grid, then moves it
/// by the body's jitter; for a cut lattice see setup/cut_lattice.hpp. Then fits moments, where asked. Throws
/// SetupError for an empty body, for bodies that overlap, for a jitter that moves a particle out of the grid,
/// and for an initial stress that a material cannot have.
PlacedParticles place_particles(const Scene& scene);

/// Their mass, kg, and its centre.
struct MassCentre {
  double mass = 0;
  Point position{};
};
MassCentre mass_centre(const Scene& scene, const PlacedParticles& placed);

/// The body of a particle.
const BodySpec& body_of(const Scene& scene, const PlacedParticles& placed, size_t particle);

/// Calls visit(x) for all of them in order, x being where they were placed. `starts`: of PlacedParticles; the
/// points of other lattices are found anew, so that nobody need keep them.
void for_each_start(const Scene& scene, const std::vector<CutStarts>& starts,
                    const std::function<void(const Point&)>& visit);

}  // namespace vsb::app
