// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Cut lattices: every box of a cell or uniform lattice that touches the body is one particle with the volume
/// and the centroid of (box cap body), or, with cut2x2, one for each half (quarter, octant) of a box that the
/// boundary cuts, or that touches a half of a neighbour that it cuts: that row more takes a tenth to a half
/// off the error of the stress. Other boxes that lie wholly in the body keep their centre and volume exactly.
#pragma once

#include <functional>

#include "scene/scene.hpp"
#include "setup/lattice_points.hpp"
#include "setup/place_particles.hpp"

namespace vsb::app {

/// The least share of a box, or of its half, that becomes a particle. Smaller ones are dropped, not merged
/// with a neighbour, whose centroid would lie too far from the boundary.
constexpr double least_share = 0.02;

struct LatticeShare {
  Point position;  ///< m
  double volume;   ///< m^3
  AxisBox box;     ///< the box, or its half, within the limits
  LatticeIndex index{};
  bool whole = false;  ///< the interval of that index in the lattice, uncut
};

/// Visits the shares of a body's boxes, along x first, the halves of one box in the same order. Boxes are cut
/// by `limits` too: at a plane of symmetry the body ends where the grid does. Returns what was visited and
/// dropped.
CutVolume for_each_lattice_share(const Scene& scene, const BodySpec& body, const AxisBox& limits,
                                 const std::function<void(const LatticeShare&)>& visit);

/// Whether the surface of a body, or a face of the grid, runs through a box of its lattice: where not,
/// cutting changes nothing. Of bodies on cell and uniform lattices of uniform grids.
bool cuts_boxes(const Scene& scene, const BodySpec& body);

}  // namespace vsb::app
