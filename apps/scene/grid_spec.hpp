// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The background grid of a scene: uniform, rectilinear (nodes at given coordinates per axis) or polar (nodes
/// at given radii, angles and heights, joined by straight edges). The last two are mapped grids to the
/// kernels. Host only.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "scene/region.hpp"

namespace vsb::app {

struct GridSpec {
  std::array<double, 3> lower{}, spacing{};  ///< m; of mapped grids only `lower` of a rectilinear one is set
  std::array<int, 3> cells{1, 1, 1};
  /// Node coordinates along each logical axis, increasing: x, y, z in m, or r in m, theta in radians, z.
  /// Empty for a uniform grid.
  std::array<std::vector<double>, 3> coordinates;
  bool polar = false;
  Point center{};  ///< of a polar grid

  bool mapped() const { return !coordinates[0].empty(); }
  /// What a logical axis is called, as in the names of the faces.
  std::string axis_name(size_t axis) const;
};

/// The position of coordinates along the logical axes (r in m, theta in radians on a polar grid), and back;
/// the angle is the one nearest to the grid's.
Point position_of(const GridSpec& grid, const Point& q);
Point logical_coordinates(const GridSpec& grid, const Point& x);

/// First and last node coordinate along a logical axis.
std::pair<double, double> extent(const GridSpec& grid, size_t axis);

/// Where a node is; logical axes beyond the dimension count for nothing.
Point node_position(const GridSpec& grid, int dimension, const std::array<int, 3>& ijk);

/// The length of the shortest edge of a cell, m: h of Eq. (29).
double shortest_edge(const GridSpec& grid, int dimension);

/// The smallest box around the grid.
AxisBox bounding_box(const GridSpec& grid, int dimension);

/// Whether a point lies in the grid; a polar grid counts with its arcs, not with their chords.
bool contains(const GridSpec& grid, int dimension, const Point& x);

/// A share of a cell: its middle and its volume.
struct CellShare {
  Point position;
  double volume;
  Point edges;  ///< along the grid's axes, m
};

/// Share (i, j, k) where every cell of a mapped grid is divided into per_cell equal intervals of the axes'
/// coordinates. On a polar grid these are sectors, of volume r dr dtheta (dz).
CellShare cell_share(const GridSpec& grid, int dimension, const std::array<int, 3>& per_cell,
                     const std::array<long long, 3>& ijk);

}  // namespace vsb::app
