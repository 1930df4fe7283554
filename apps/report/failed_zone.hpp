// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// How far failure reaches from a round hole, and how even it is along the hole and around it. Positions are
/// those of the start, in the frame of the lattice.
#pragma once

#include <vector>

#include "scene/removal_spec.hpp"

namespace vsb::app {

/// What has become of a particle of the start.
enum class Fate : unsigned char { gone, present, failed };

struct FailedZone {
  double rows = 0;           ///< of the failed particle farthest from the hole: its distance from it in rows
  double rows_axis = 0;      ///< the same for the particles in the first rows beside an axis across the hole
  double rows_diagonal = 0;  ///< and for those next to a line at 45 degrees to it
  double rows_mean = 0;      ///< of a round zone with as many particles as are gone and failed
  double per_layer = 0;      ///< failed particles in a layer across the hole, on average
  double layer_spread = 0;   ///< most in a layer less the fewest, over the average
  double asymmetry = 0;      ///< share of the failed particles with a mirror image that has not failed
};

/// Mirror images are those at the two axes and the two diagonals across the hole, and turned by right angles,
/// as far as there are particles.
FailedZone measure_failed_zone(const HoleSpec& hole, int dimension, const std::vector<Point>& start,
                               const std::vector<Fate>& fate);

}  // namespace vsb::app
