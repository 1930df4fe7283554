// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The surface of a scene's bodies as small flat pieces, found from their shapes alone.
#pragma once

#include <vector>

#include "scene/scene.hpp"

namespace vsb::app {

/// A piece of surface: a point that stands for it, and its area times the outward unit normal (m^2; m in 2D,
/// 1 in 1D).
struct SurfacePiece {
  Point position{}, area{};
};

/// Where the surface is looked for: the box of the grid. A body that goes on beyond a face of the grid has no
/// surface there.
struct SurfaceBox {
  int dimension;
  Point lower{};
  std::array<double, 3> interval{};  ///< distance of the sampling points, m
  std::array<int, 3> intervals{};    ///< number of intervals in each direction
};

/// The pieces of the boundary of a region: sampling intervals are cut into simplices, on whose edges the
/// crossings of the boundary are found by bisection. Pieces of a closed surface close to round-off: their
/// areas add up to zero. They integrate linear functions (quadratic ones in 3D) over flat faces exactly.
/// Edges and corners are cut off at the size of the interval.
std::vector<SurfacePiece> surface_pieces(const Region& region, const SurfaceBox& box);

/// The box of a scene's grid with `per_cell` intervals per cell and direction.
SurfaceBox surface_box(const Scene& scene, int per_cell);

/// All bodies together.
Region union_of_bodies(const Scene& scene);

}  // namespace vsb::app
