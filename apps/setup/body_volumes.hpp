// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What the particles of every body have at the start, beside what the shape of the body holds in the grid:
/// a lattice whose intervals do not end at the surface has less, or more.
#pragma once

#include <string>
#include <vector>

#include "setup/place_particles.hpp"

namespace vsb::app {

struct BodyVolume {
  double particles = 0, shape = 0;  ///< m^3 (area in 2D, length in 1D)
  double shape_error = 0;           ///< what the shape's may be off, about

  /// By how much the particles have more, as a share of the shape's.
  double surplus() const { return particles / shape - 1; }
};

/// Body by body.
std::vector<BodyVolume> body_volumes(const Scene& scene, const PlacedParticles& placed);

/// A line for each body, which begins with `prefix`.
void print_body_volumes(const Scene& scene, const std::vector<BodyVolume>& volumes,
                        const std::string& prefix);

/// A sentence for each body whose particles have a hundredth more or less than its shape, and more than the
/// shape's volume may be off.
std::vector<std::string> volume_advice(const Scene& scene, const std::vector<BodyVolume>& volumes);

}  // namespace vsb::app
