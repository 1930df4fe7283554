// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Bodies drawn at random: what they are, and where they, their lattices and the grid lie, as overrides of a
/// scene.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace vsb::app {

/// Bodies of a series, one for each seed.
struct RandomBodies {
  int count = 0;
  long long first_seed = 0;
  double half_width = 0;  ///< m, of the box that a body's shape is drawn in
};

/// Overrides that put a body in the place of the only one of a scene: two to four balls and boxes, added or
/// taken away one after the other, somewhere near the middle of a grid that begins anywhere; particles on a
/// lattice that lies anywhere, at 1/3.2 to 1/2 of the grid's spacing. The same with every standard library.
std::vector<std::string> random_body(const Scene& scene, long long seed, double half_width);

/// Why bodies cannot be drawn for a scene; empty where they can.
std::string why_no_random_body(const Scene& scene);

}  // namespace vsb::app
