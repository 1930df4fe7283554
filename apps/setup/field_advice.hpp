// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What looks wrong about the virtual stress fields of a scene once its particles are placed.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"
#include "setup/place_particles.hpp"

namespace vsb::app {

/// Which cells hold particles; cells along the first logical axis first.
struct OccupiedCells {
  std::array<int, 3> cells{1, 1, 1};
  std::vector<bool> occupied;
};

/// Where and how much the virtual stress changes across a particle beyond what its divergence there tells.
/// Over a cube of the particle's volume, of width w, the mean of div sbar is the sum of the differences
/// between opposite faces over w (Gauss); what differs from fbar(x_p), times w, is a traction inside the
/// material that nobody asked for.
struct SpuriousTraction {
  double size = 0;  ///< Pa, the largest component
  Point position{};
  std::string traction;
};
SpuriousTraction spurious_traction(const Scene& scene, const PlacedParticles& placed);

/// The thinnest wall, along a grid axis, between void cells in which different tractions act.
struct ThinWall {
  int cells = 0;  ///< 0: there is none of fewer than `enough` cells
  Point position{};
  static constexpr int enough = 4;
};
ThinWall thin_wall(const Scene& scene, const OccupiedCells& grid);

/// Warnings about both, a sentence each.
std::vector<std::string> field_advice(const Scene& scene, const PlacedParticles& placed,
                                      const OccupiedCells& grid);

}  // namespace vsb::app
