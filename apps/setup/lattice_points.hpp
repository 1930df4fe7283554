// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The points of a body's lattice, wherever they lie.
#pragma once

#include <functional>

#include "scene/scene.hpp"

namespace vsb::app {

using LatticeIndex = std::array<long long, 3>;

/// Indices first, ..., last - 1 in every direction.
struct LatticeRange {
  LatticeIndex first{0, 0, 0}, last{1, 1, 1};
};

/// A cell lattice of a uniform grid, or a uniform lattice, as the latter.
UniformLattice uniform_lattice(const GridSpec& grid, const Lattice& lattice);
/// The intervals of a body's lattice that touch a box and the body's bounds.
LatticeRange lattice_range(const UniformLattice& lattice, const BodySpec& body, const AxisBox& box,
                           int dimension);

struct LatticePoint {
  Point x;        ///< m
  double volume;  ///< m^3 (area in 2D, length in 1D)
  Point shift;    ///< what the body's jitter adds to x, m
  Point edges;    ///< of its box or sector, across the faces of the grid that these stand on, m
};

/// Visits the lattice points of a body in a fixed order: for cell and uniform lattices those in the box of
/// the grid and in the body's bounds, along x first; for concentric ones all, along the angle first, then
/// ring by ring and layer by layer. A point's shift depends on its position in the lattice and the seed
/// alone, not on the points visited before.
void for_each_lattice_point(const Scene& scene, const BodySpec& body,
                            const std::function<void(const LatticePoint&)>& visit);

}  // namespace vsb::app
