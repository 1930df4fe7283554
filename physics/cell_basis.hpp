// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The bins of bases whose support nodes are the corners of one cell. A bin collects the particles that share
/// their support nodes: here a cell, with the number of its lowest node.
#pragma once

#include <vsb/physics/cell_numbering.hpp>

namespace vsb {

/// What the bases on one cell share. Support node a is corner a of the cell, as in physics/multilinear.hpp.
template <class Grid>
struct CellBasis {
  static constexpr int dimension = Grid::dimension;  ///< of space: 1, 2 or 3
  static constexpr int support = Grid::corners;      ///< nodes whose functions are not zero in a cell, 2^Dim
  /// Rings of cells, beyond those around a node, that its support overlaps; a grid has as many layers of
  /// ghost cells.
  static constexpr int ghost_layers = 0;
  /// The bins of a cell's first corners, as many as this, have all its particles.
  static constexpr int bins_of_cell = 1;
  using real = typename Grid::real;          ///< type of the numbers
  using Position = Vector<dimension, real>;  ///< in m

  Grid grid;  ///< whose cells these are

  /// Whether the nodes beyond a face are mirror images (see physics/walls.hpp); here there are none.
  KOKKOS_FUNCTION bool mirrored(int, int) const { return false; }

  /// Whether x lies in the grid; false at NaN.
  KOKKOS_FUNCTION bool contains(const Position& x) const { return grid.contains(x); }

  /// Number of nodes.
  KOKKOS_FUNCTION int node_count() const { return grid.node_count(); }

  /// Number of bins; some of them may never hold a particle.
  KOKKOS_FUNCTION int bin_count() const { return grid.node_count(); }

  /// The bin of a point of the grid.
  KOKKOS_FUNCTION int bin(const Position& x) const { return grid.node_index(grid.cell_containing(x)); }

  /// Support node a of a bin's particles.
  KOKKOS_FUNCTION int node_of_bin(int bin_index, int a) const { return bin_index + grid.corner_offset(a); }

  /// The bin whose support node a is `node`, or -1 where there is none.
  KOKKOS_FUNCTION int bin_of_node(int node, int a) const {
    const auto ijk = grid.node_ijk(node);
    for (int i = 0; i < dimension; ++i) {
      const int cell = ijk[i] - (a >> i & 1);
      if (cell < 0 || cell >= grid.cells[i]) return -1;
    }
    return node - grid.corner_offset(a);
  }
};

}  // namespace vsb
