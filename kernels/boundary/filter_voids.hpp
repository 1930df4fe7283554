// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The void filter, an addition to Algorithm 1: a void cell that touches the body is a cell of E1 only if it
/// belongs to the outside. A cell without particles inside a stretched body is then not loaded.
///
/// The outside O_n is a set of void cells. Each change n of the occupancy makes it from the one before:
///   O_n = the void cells that are connected, through faces and void cells, to a void cell that was in
///         O_n-1 or shares a face with a cell that was.
/// The outside therefore moves with the body and enters a hole that opens to it. A cell that turns void
/// belongs to it only if it touches it. A void of the outside stays in it as long as the void exists. A void
/// that closes altogether and opens again is inside. set_void_filter and its caller set O_0. O changes only
/// where cells change, so that it does not depend on how often it is brought up to date. A run is resumed
/// from its particles and O.
///
/// Rows of bits as in kernels/boundary/mark_boundary_nodes.hpp. Each pass dilates the outside by one cell
/// within the voids, until no cell is added. Most changes need one or two passes.
#pragma once

#include <vsb/kernels/boundary/mark_boundary_nodes.hpp>

namespace vsb {

namespace kernel {

/// One word of cells: the void ones that are in `from` or share a face with a cell of it; counts the words
/// that differ from `from`.
template <int Dim, class Device>
struct FloodVoids {
  using Rows = typename CellBits<Device>::Rows;
  Rows occupied, from, to;
  BitRows<Dim> tiling;

  KOKKOS_FUNCTION void operator()(int i, int& changed) const {
    const int r = i / tiling.words, w = i % tiling.words;
    const auto row = tiling.cell_row_indices(r);
    const int j = row[0], k = row[1];
    std::uint64_t reached = dilated_word(from, tiling, w, row, row, 1, 1);
    reached |= word(j - 1, k, w) | word(j + 1, k, w) | word(j, k - 1, w) | word(j, k + 1, w);
    to(r, w) = reached & ~occupied(r, w) & tiling.existing(row, w, 0);
    if (to(r, w) != from(r, w)) ++changed;
  }
  /// Word w of a row of `from`; nothing beyond the faces of the grid.
  KOKKOS_FUNCTION std::uint64_t word(int j, int k, int w) const {
    const bool exists = j >= 0 && j < tiling.cell_rows[0] && k >= 0 && k < tiling.cell_rows[1];
    return exists ? from(tiling.cell_row(j, k), w) : 0;
  }
};

/// One word of cells: how many are in one set and not in another.
template <class Device>
struct CountDifference {
  using Rows = typename CellBits<Device>::Rows;
  Rows in, not_in;
  int words;

  KOKKOS_FUNCTION void operator()(int i, int& count) const {
    std::uint64_t rest = in(i / words, i % words) & ~not_in(i / words, i % words);
    for (; rest != 0; rest &= rest - 1) ++count;
  }
};

}  // namespace kernel

/// Brings the outside, CellBits::outside, from the cells of the last call to those of the particles. Waits
/// for the device. Overwrites the occupied and exterior cells, as mark_boundary_nodes does again.
template <class Exec, class Basis, int Dim, class Real, class Device>
void update_outside(const Exec& exec, const Particles<Dim, Real, Device>& particles,
                    const CellBits<Device>& bits, const Basis& basis) {
  const auto tiling = BitRows<Dim>::of(basis);
  mark_occupied_cells(exec, particles, bits, basis.grid);
  const auto flood = [&](const auto& from, const auto& to) {
    int changed = 0;
    Kokkos::parallel_reduce("vsb::flood_voids",
                            Kokkos::RangePolicy<Exec>(exec, 0, tiling.cell_row_count() * tiling.words),
                            kernel::FloodVoids<Dim, Device>{bits.occupied, from, to, tiling}, changed);
    exec.fence();
    return changed > 0;
  };
  do flood(bits.outside, bits.exterior);
  while (flood(bits.exterior, bits.outside));
}

/// The cells and nodes that the filter removes from the boundary.
struct VoidFilterEffect {
  int false_voids = 0;    ///< void cells that touch the body and do not belong to the outside
  int dropped_nodes = 0;  ///< nodes at which a traction would act without the filter
};

/// The effect of the filter on a boundary of `boundary_node_count` nodes that is up to date;
/// `at_all_active_nodes` as for mark_boundary_nodes. Waits for the device.
template <class Exec, class Basis, int Dim, class Real, class Device>
VoidFilterEffect void_filter_effect(const Exec& exec, const Particles<Dim, Real, Device>& particles,
                                    const CellBits<Device>& bits, const Basis& basis,
                                    const BoundaryNodes<Device>& tractions, int boundary_node_count,
                                    TractionMask at_all_active_nodes = 0) {
  auto unfiltered = allocate_cell_bits<Device>(basis.grid);
  unfiltered.underfilled = bits.underfilled;
  unfiltered.carried = bits.carried;
  const BoundaryNodes<Device> boundary("vsb::unfiltered_boundary_nodes", tractions.extent(0));
  VoidFilterEffect effect;
  effect.dropped_nodes =
      mark_boundary_of_located(exec, particles, unfiltered, basis, tractions, boundary, at_all_active_nodes) -
      boundary_node_count;
  const BitRows<Dim> tiling(basis.grid);
  Kokkos::parallel_reduce(
      "vsb::count_false_voids", Kokkos::RangePolicy<Exec>(exec, 0, tiling.cell_row_count() * tiling.words),
      kernel::CountDifference<Device>{unfiltered.exterior, bits.outside, tiling.words}, effect.false_voids);
  exec.fence();
  return effect;
}

}  // namespace vsb
