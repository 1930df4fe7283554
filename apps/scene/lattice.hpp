// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Lattices: where a body has its particles, and how much volume each stands for. Plain data. A body keeps
/// the lattice points that lie in its shape and in the grid.
#pragma once

#include <array>
#include <cstdint>
#include <variant>

namespace vsb::app {

/// Equal intervals of every grid cell in every direction, a particle in the middle of each.
struct CellLattice {
  std::array<int, 3> particles_per_cell{1, 1, 1};
};

/// Particles at origin + (k + 1/2) spacing, of the volume of one interval.
struct UniformLattice {
  std::array<double, 3> origin{}, spacing{};  ///< m

  /// Coordinate of a point, in the middle of its interval.
  double point(const std::array<long long, 3>& index, size_t axis) const {
    return origin[axis] + (static_cast<double>(index[axis]) + 0.5) * spacing[axis];
  }
};

/// Rings around an axis along z: in the middle of ring i of equal width dr, r_i = a + (i + 1/2) dr,
/// `per_ring` particles in the middles of equal angles dtheta; V = r dr dtheta, the sector's own area. In 3D
/// in layers of equal height, V = r dr dtheta dz.
struct ConcentricLattice {
  std::array<double, 2> center{};             ///< m
  double inner_radius = 0, outer_radius = 0;  ///< m
  int rings = 1, per_ring = 1;
  double first_angle = 0, last_angle = 0;  ///< rad, from the x axis towards y
  double lower = 0, upper = 0;             ///< m along z, in 3D
  int layers = 1;
};

using Lattice = std::variant<CellLattice, UniformLattice, ConcentricLattice>;

/// Moves each particle of a cell or uniform lattice, in every direction, by a random share of the spacing
/// between -amount and amount.
struct Jitter {
  double amount = 0;
  std::uint64_t seed = 1;
};

/// What becomes of the lattice boxes that the boundary of the body cuts (see setup/cut_lattice.hpp).
enum class BoundaryBoxes {
  keep,   ///< whole if their centre lies in the body, else nothing
  cut,    ///< one particle at the centroid of what lies in the body, of its volume
  cut2x2  ///< the same for each of their halves (quarters, octants)
};

}  // namespace vsb::app
