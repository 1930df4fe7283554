// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// How many cells at the boundary (E2 of Algorithm 1) a traction loads: wholly, where some traction acts at
/// all their nodes; or partly, where none acts at some of them. Partly loaded cells are usual at the edge of
/// the region in which a traction is declared. Many of them are a sign that the boundary has left the region.
#pragma once

#include <vsb/kernels/boundary/update_occupancy.hpp>
#include <vsb/kernels/particles/ordered_sum.hpp>

namespace vsb {

/// Cells of one traction.
struct LoadedCells {
  ///@{
  /// Cells of E2 loaded wholly, and partly, as at the top of this file.
  int whole = 0, part = 0;
  ///@}
};

namespace kernel {

/// One row of cells. Masks: the tractions at node x of a row of nodes.
template <class Masks, int Dim, class Device>
struct CountLoadedCells {
  CellBits<Device> bits;
  BitRows<Dim> tiling;
  Masks masks;
  TractionMask traction;

  KOKKOS_FUNCTION void operator()(int r, Vector<2, double>& sum) const {
    const auto at = tiling.cell_row_indices(r);
    for (int w = 0; w < tiling.words; ++w) {
      const std::uint64_t cells = bits.boundary(r, w) & bits.occupied(r, w) & tiling.existing(at, w, 0);
      for (int b = 0; b < 64 && cells >> b != 0; ++b)
        if (cells >> b & 1) count(at, 64 * w + b, sum);
    }
  }
  KOKKOS_FUNCTION void count(const Vector<2, int>& at, int x, Vector<2, double>& sum) const {
    bool loaded = false, bare = false;
    for (int c = 0; c < 1 << Dim; ++c) {
      const int row = (at[1] + (c >> 2 & 1)) * tiling.node_rows[0] + at[0] + (c >> 1 & 1);
      const TractionMask mask = masks(row, x + (c & 1));
      loaded = loaded || (mask & traction) != 0;
      bare = bare || mask == 0;
    }
    if (loaded) sum[bare ? 1 : 0] += 1;
  }
};

template <class Device>
struct MasksOfGrid {
  BoundaryNodes<Device> boundary;
  int per_row;
  KOKKOS_FUNCTION TractionMask operator()(int row, int x) const { return boundary(row * per_row + x); }
};

}  // namespace kernel

namespace detail {

template <class Exec, class Masks, int Dim, class Device>
LoadedCells count_loaded_cells(const Exec& exec, const CellBits<Device>& bits, const BitRows<Dim>& tiling,
                               const Masks& masks, TractionMask traction) {
  const auto sum =
      ordered_sum<2, Device>(exec, "vsb::count_loaded_cells", tiling.cell_row_count(),
                             kernel::CountLoadedCells<Masks, Dim, Device>{bits, tiling, masks, traction});
  return {static_cast<int>(sum[0]), static_cast<int>(sum[1])};
}

}  // namespace detail

/// The cells of one traction, given by its bit. The marks must be up to date. Waits for the device.
template <class Exec, class Basis, class Device>
LoadedCells count_loaded_cells(const Exec& exec, const Occupancy<Device>& o, const Basis& basis,
                               TractionMask traction) {
  return detail::count_loaded_cells(exec, o.cells, BitRows<Basis::dimension>::of(basis),
                                    kernel::MasksOfGrid<Device>{o.boundary, basis.grid.cells[0] + 1},
                                    traction);
}

}  // namespace vsb
