// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The share of an axis-parallel box that lies in a region: its volume and its centroid.
///
/// Region::overlap tells first whether the box lies in the region as a whole or not at all; that is certain,
/// so that no thin feature is missed there. The other boxes are sampled: `samples_per_direction` lines per
/// transverse direction, each tested at its ends and at as many points in between. Where two neighbouring
/// points differ, bisection finds the crossing. The lines run along the direction that has the most
/// crossings, so that a face perpendicular to an axis is met exactly, a flat oblique one but for the lines
/// that leave the box through its sides, and the error at a smooth surface falls with the square of the
/// distance of the lines. What is thinner than that distance may be missed.
#pragma once

#include <array>

#include "scene/region.hpp"

namespace vsb::app {

constexpr int samples_per_direction(int dimension) {
  return dimension == 1 ? 64 : dimension == 2 ? 16 : 8;
}

struct BoxShare {
  double volume = 0;   ///< m^3 (area in 2D, length in 1D)
  Point centroid{};    ///< m; of a share without volume the middle of the box
  bool whole = false;  ///< the share is the box: volume and centroid are exactly the box's own
};

/// Integrals over the share of the products of different coordinates, each in shares of the box's edges from
/// its lower corner, divided by the box's volume. Product k has coordinate i where bit i of k is set.
using BoxMoments = std::array<double, 8>;

/// Product k of the coordinates of a position.
inline double value_of_product(size_t k, const Point& local) {
  double value = 1;
  for (size_t i = 0; i < 3; ++i)
    if (k >> i & 1) value *= local[i];
  return value;
}

double volume_of(const AxisBox& box, int dimension);
BoxShare share_of(const Region& region, const AxisBox& box, int dimension);
BoxMoments moments_of(const Region& region, const AxisBox& box, int dimension);

}  // namespace vsb::app
