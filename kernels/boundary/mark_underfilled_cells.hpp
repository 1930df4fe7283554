// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The fill criterion, an addition to Algorithm 1: a non-void cell whose particles fill too little of it,
///   sum_p V_p < (1 - tau) V_cell,
/// is a cell of E2, whether a void cell is near or not. The criterion finds boundaries without void cells,
/// such as a hole with a particle in every cell that it touches.
///
/// Reads the bins sorted by sort_by_bin and the present volumes; writes CellBits::underfilled. The sum over a
/// cell's particles runs in increasing particle number, so that the cells do not depend on the number of
/// threads.
#pragma once

#include <vsb/kernels/boundary/mark_boundary_nodes.hpp>
#include <vsb/views/particle_bins.hpp>

namespace vsb {

namespace kernel {

/// One word of cells: the underfilled ones; counts the words that change.
template <class Basis, int Dim, class Real, class Device>
struct MarkUnderfilled {
  Particles<Dim, Real, Device> particles;
  ParticleBins<Device> bins;
  Basis basis;
  BitRows<Dim> tiling;
  Real minimum_fill;  ///< of the cell's volume
  typename CellBits<Device>::Rows underfilled;

  KOKKOS_FUNCTION void operator()(int i, int& changed) const {
    const int r = i / tiling.words, w = i % tiling.words;
    Vector<Dim, int> cell;
    cell[0] = 64 * w;
    const auto row = tiling.cell_row_indices(r);
    for (int k = 1; k < Dim; ++k) cell[k] = row[k - 1];
    const int first_node = basis.grid.node_index(cell), cells = math::min(tiling.cells_x - 64 * w, 64);
    std::uint64_t word = 0;
    for (int b = 0; b < cells; ++b, ++cell[0])
      if (is_underfilled(first_node + b, cell)) word |= std::uint64_t(1) << b;
    if (word != underfilled(r, w)) ++changed;
    underfilled(r, w) = word;
  }

  KOKKOS_FUNCTION bool is_underfilled(int lowest_node, const Vector<Dim, int>& cell) const {
    Real volume = 0;
    for (int a = 0; a < Basis::bins_of_cell; ++a) {
      const int bin = lowest_node + basis.grid.corner_offset(a);
      for (int k = bins.offset(bin); k < bins.offset(bin + 1); ++k) {
        const int p = bins.order(k);
        if (Basis::bins_of_cell == 1 || is_in(cell, p)) volume += particles.volume(p);
      }
    }
    return volume < minimum_fill * basis.grid.cell_volume(cell);
  }
  KOKKOS_FUNCTION bool is_in(const Vector<Dim, int>& cell, int p) const {
    const auto containing = basis.grid.cell_containing(particles.position_of(p));
    bool same = true;
    for (int i = 0; i < Dim; ++i) same = same && containing[i] == cell[i];
    return same;
  }
};

}  // namespace kernel

/// Overwrites `underfilled` with the cells of which the particles fill less than `minimum_fill`, void cells
/// among them. Returns whether this changed any; waits for the device.
template <class Exec, class Basis, int Dim, class Real, class Device>
bool mark_underfilled_cells(const Exec& exec, const Particles<Dim, Real, Device>& particles,
                            const ParticleBins<Device>& bins, const Basis& basis, double minimum_fill,
                            const typename CellBits<Device>::Rows& underfilled) {
  const BitRows<Dim> tiling(basis.grid);
  int changed = 0;
  Kokkos::parallel_reduce("vsb::mark_underfilled_cells",
                          Kokkos::RangePolicy<Exec>(exec, 0, tiling.cell_row_count() * tiling.words),
                          kernel::MarkUnderfilled<Basis, Dim, Real, Device>{
                              particles, bins, basis, tiling, static_cast<Real>(minimum_fill), underfilled},
                          changed);
  exec.fence();
  return changed > 0;
}

}  // namespace vsb
