// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Algorithm 1: the nodes at which the virtual stress acts.
///   E1: void cells (no particle inside) that have an active node, that is, that touch a non-void cell;
///   E2: non-void cells that share a node with a cell of E1;
///   N1: active nodes whose support overlaps a cell of E1 or E2. For linear functions these are the nodes of
///   such cells, as in the paper. Wider functions (Basis::ghost_layers rings more) add a ring of nodes.
///   Without it a patch under uniform stress is out of balance by some 1e-3.
/// The fill criterion (kernels/boundary/mark_underfilled_cells.hpp) adds underfilled cells to E2. The void
/// filter (kernels/boundary/filter_voids.hpp) leaves void cells out of E1. Both are optional.
///
/// A traction acts at the nodes of N1 at which it is declared. It is declared at nodes of the grid; or, where
/// its surface moves with the material (views/carried_tractions.hpp), at the active nodes whose support
/// overlaps a cell with a particle that carries it.
///
/// Every "touches" is a dilation of bit rows (kernels/boundary/bit_rows.hpp). There are no cells beyond a
/// face of the grid, so that a fixed or symmetry plane there makes no boundary. A free boundary needs a void
/// cell beyond it. This algorithm leaves out the ghost cells beyond a wall: they mirror the cells inside, and
/// touch nothing that those do not. Ghost nodes are marked as their images are.
#pragma once

#include <vsb/kernels/boundary/bit_rows.hpp>
#include <vsb/kernels/particles/locate_particles.hpp>
#include <vsb/kernels/particles/mirror_nodes.hpp>
#include <vsb/views/particles.hpp>

namespace vsb {

namespace kernel {

/// One particle: marks its cell as non-void.
template <class Grid, int Dim, class Real, class Device>
struct MarkOccupied {
  Particles<Dim, Real, Device> particles;
  Grid grid;
  typename CellBits<Device>::Rows occupied;

  KOKKOS_FUNCTION void operator()(int p) const {
    const auto cell = grid.cell_containing(particles.position_of(p));
    Kokkos::atomic_fetch_or(&occupied(grid.row_index(cell), cell[0] / 64), std::uint64_t(1)
                                                                               << (cell[0] % 64));
  }
};

/// Marks cell x of a row for some tractions.
template <class Device>
KOKKOS_INLINE_FUNCTION void mark_carrying_cell(const CarriedTractions<Device>& c, TractionMask tractions,
                                               int row, int x) {
  for (int k = 0; k < c.count(); ++k)
    if (tractions >> k & 1u) Kokkos::atomic_fetch_or(&c.cells(k, row, x / 64), std::uint64_t(1) << (x % 64));
}

/// One particle: marks its cell for the tractions that it carries.
template <class Grid, int Dim, class Real, class Device>
struct MarkCarrying {
  Particles<Dim, Real, Device> particles;
  Grid grid;
  CarriedTractions<Device> carried;

  KOKKOS_FUNCTION void operator()(int p) const {
    const TractionMask mask = carried.particle(p);
    if (mask == 0) return;
    const auto cell = grid.cell_containing(particles.position_of(p));
    mark_carrying_cell(carried, mask, grid.row_index(cell), cell[0]);
  }
};

/// E1, word by word.
template <int Dim, class Device>
struct FindExterior {
  CellBits<Device> bits;
  BitRows<Dim> tiling;
  KOKKOS_FUNCTION void operator()(int i) const {
    const int r = i / tiling.words, w = i % tiling.words;
    bits.exterior(r, w) = touching_cells(bits.occupied, tiling, r, w) & ~bits.occupied(r, w);
  }
};

/// Removes cells that do not belong to the outside from E1, word by word.
template <class Device>
struct KeepOutside {
  CellBits<Device> bits;
  int words;
  KOKKOS_FUNCTION void operator()(int i) const {
    bits.exterior(i / words, i % words) &= bits.outside(i / words, i % words);
  }
};

/// E1 and E2, word by word; E2 are the non-void cells that touch E1.
template <int Dim, class Device>
struct FindBoundary {
  CellBits<Device> bits;
  BitRows<Dim> tiling;
  KOKKOS_FUNCTION void operator()(int i) const {
    const int r = i / tiling.words, w = i % tiling.words;
    bits.boundary(r, w) =
        bits.exterior(r, w) | (touching_cells(bits.exterior, tiling, r, w) & bits.occupied(r, w));
  }
};

/// Adds the underfilled cells to the union of E1 and E2, word by word. Void cells do not count as
/// underfilled.
template <class Device>
struct AddUnderfilled {
  CellBits<Device> bits;
  int words;
  KOKKOS_FUNCTION void operator()(int i) const {
    const int r = i / words, w = i % words;
    bits.boundary(r, w) |= bits.underfilled(r, w) & bits.occupied(r, w);
  }
};

/// Word w of row r of nodes: where carried traction k is declared. ghost_layers: of the basis.
template <int Dim, class Device>
KOKKOS_INLINE_FUNCTION std::uint64_t carried_nodes(const CarriedTractions<Device>& carried, int k,
                                                   const BitRows<Dim>& tiling, const Vector<2, int>& at,
                                                   int w, int ghost_layers) {
  const auto cells = [&](int row, int word) { return carried.cells(k, row, word); };
  return dilated_word(cells, tiling, w, {{at[0] - 1 - ghost_layers, at[1] - 1 - ghost_layers}},
                      {{at[0] + ghost_layers, at[1] + ghost_layers}}, ghost_layers, 1 + ghost_layers);
}

/// N1: one word of nodes; counts those at which a traction acts. Ghost nodes beyond walls are left out.
template <int Dim, class Device>
struct MarkNodes {
  CellBits<Device> bits;
  BitRows<Dim> tiling;
  int ghost_layers;  ///< of the basis
  BoundaryNodes<Device> tractions;
  BoundaryNodes<Device> boundary;
  TractionMask at_all_active_nodes;

  KOKKOS_FUNCTION void operator()(int i, int& count) const {
    const int r = i / tiling.words, w = i % tiling.words;
    const Vector<2, int> at{{r % tiling.node_rows[0], r / tiling.node_rows[0]}};
    const Vector<2, int> from{{at[0] - 1 - ghost_layers, at[1] - 1 - ghost_layers}},
        to{{at[0] + ghost_layers, at[1] + ghost_layers}};
    const std::uint64_t active = tiling.existing(at, w, 1) & dilated_word(bits.occupied, tiling, w, from, to,
                                                                          ghost_layers, 1 + ghost_layers);
    const std::uint64_t marked =
        active & dilated_word(bits.boundary, tiling, w, from, to, ghost_layers, 1 + ghost_layers);
    const auto& carried = bits.carried;
    for (int k = 0; k < carried.count(); ++k)
      carried.nodes(k, r, w) = carried_nodes(carried, k, tiling, at, w, ghost_layers);
    const int nodes = math::min(tiling.cells_x + 1 - 64 * w, 64);
    for (int b = 0; b < nodes; ++b) {
      const int node = r * (tiling.cells_x + 1) + 64 * w + b;
      boundary(node) = marked >> b & 1   ? tractions(node) | carried.at(r, 64 * w + b)
                       : active >> b & 1 ? tractions(node) & at_all_active_nodes
                                         : 0;
      if (boundary(node) != 0) ++count;
    }
  }
};

}  // namespace kernel

/// Overwrites the set of non-void cells. All particles must lie in the grid.
template <class Exec, class Grid, int Dim, class Real, class Device>
void mark_occupied_cells(const Exec& exec, const Particles<Dim, Real, Device>& particles,
                         const CellBits<Device>& bits, const Grid& grid) {
  Kokkos::deep_copy(exec, bits.occupied, std::uint64_t(0));
  Kokkos::parallel_for("vsb::mark_occupied", Kokkos::RangePolicy<Exec>(exec, 0, particles.count()),
                       kernel::MarkOccupied<Grid, Dim, Real, Device>{particles, grid, bits.occupied});
}

/// Overwrites the sets of cells that hold carriers of tractions; all particles must lie in the grid.
template <class Exec, class Grid, int Dim, class Real, class Device>
void mark_carrying_cells(const Exec& exec, const Particles<Dim, Real, Device>& particles,
                         const CarriedTractions<Device>& carried, const Grid& grid) {
  if (!carried.any()) return;
  Kokkos::deep_copy(exec, carried.cells, std::uint64_t(0));
  Kokkos::parallel_for("vsb::mark_carrying", Kokkos::RangePolicy<Exec>(exec, 0, particles.count()),
                       kernel::MarkCarrying<Grid, Dim, Real, Device>{particles, grid, carried});
}

/// mark_boundary_nodes for particles that are known to lie in the grid.
template <class Exec, class Basis, int Dim, class Real, class Device>
int mark_boundary_of_located(const Exec& exec, const Particles<Dim, Real, Device>& particles,
                             const CellBits<Device>& bits, const Basis& basis,
                             const BoundaryNodes<Device>& tractions, const BoundaryNodes<Device>& boundary,
                             TractionMask at_all_active_nodes = 0) {
  const auto tiling = BitRows<Dim>::of(basis);
  const Kokkos::RangePolicy<Exec> over_cell_words(exec, 0, tiling.cell_row_count() * tiling.words);
  const Kokkos::RangePolicy<Exec> over_node_words(exec, 0, tiling.node_row_count() * tiling.words);
  mark_occupied_cells(exec, particles, bits, basis.grid);
  mark_carrying_cells(exec, particles, bits.carried, basis.grid);
  Kokkos::parallel_for("vsb::find_exterior_cells", over_cell_words,
                       kernel::FindExterior<Dim, Device>{bits, tiling});
  if (bits.outside.size() > 0)
    Kokkos::parallel_for("vsb::keep_outside_cells", over_cell_words,
                         kernel::KeepOutside<Device>{bits, tiling.words});
  Kokkos::parallel_for("vsb::find_boundary_cells", over_cell_words,
                       kernel::FindBoundary<Dim, Device>{bits, tiling});
  if (bits.underfilled.size() > 0)
    Kokkos::parallel_for("vsb::add_underfilled_cells", over_cell_words,
                         kernel::AddUnderfilled<Device>{bits, tiling.words});
  int count = 0;
  Kokkos::parallel_reduce("vsb::mark_boundary_nodes", over_node_words,
                          kernel::MarkNodes<Dim, Device>{bits, tiling, Basis::ghost_layers, tractions,
                                                         boundary, at_all_active_nodes},
                          count);
  mirror_masks(exec, basis, boundary);
  exec.fence();
  return count;
}

/// Overwrites boundary[node] with tractions[node] at the nodes of N1 and with 0 elsewhere. Bit k of
/// tractions[node]: traction k is declared at the node. Tractions that particles carry (bits.carried) are
/// added. Those of `at_all_active_nodes` act at all active nodes, also outside N1. Reads positions alone.
/// Returns the number of nodes, without ghost nodes, at which a traction acts; waits for the device. Throws
/// std::invalid_argument for a particle outside the grid or at NaN.
template <class Exec, class Basis, int Dim, class Real, class Device>
int mark_boundary_nodes(const Exec& exec, const Particles<Dim, Real, Device>& particles,
                        const CellBits<Device>& bits, const Basis& basis,
                        const BoundaryNodes<Device>& tractions, const BoundaryNodes<Device>& boundary,
                        TractionMask at_all_active_nodes = 0) {
  require_accessible<Exec, Device>();
  const BitRows<Dim> rows(basis.grid);
  if (bits.occupied.extent(0) != static_cast<size_t>(rows.cell_row_count()) ||
      bits.occupied.extent(1) != static_cast<size_t>(rows.words))
    detail::refuse("the bits of the cells are those of another grid: allocate_cell_bits(basis.grid)");
  detail::check_rows("tractions", tractions.extent(0), basis.node_count(),
                     "give one mask per node of the basis");
  detail::check_rows("boundary", boundary.extent(0), basis.node_count(),
                     "give one mask per node of the basis");
  if (const int outside = find_outside(exec, particles, basis); outside >= 0)
    detail::refuse("mark_boundary_nodes: the position of particle ", outside,
                   " is outside the grid or no number: mark the nodes of particles in the grid");
  return mark_boundary_of_located(exec, particles, bits, basis, tractions, boundary, at_all_active_nodes);
}

}  // namespace vsb
