// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Tractions whose surface moves with the material. Particles carry them; they are declared at the nodes of
/// the cells that hold such particles (see kernels/boundary/mark_boundary_nodes.hpp).
#pragma once

#include <vsb/views/kokkos_compat.hpp>
#include <vsb/views/masks.hpp>

namespace vsb {

/// Which particles carry which tractions, and where these are declared. Tractions are numbered from 0 to 31.
template <class Device>
struct CarriedTractions {
  /// Sets of cells or nodes as bits: bit x % 64 of word x / 64 is cell or node x of a row.
  using Words = Kokkos::View<std::uint64_t***, Kokkos::LayoutRight, Device>;
  Kokkos::View<TractionMask*, Device> particle;  ///< [particle]: the tractions it carries; no rows: none
  TractionMask tractions = 0;                    ///< those that some particle carries
  Words cells;  ///< [traction][row of cells][word]: cells with such particles
  Words nodes;  ///< [traction][row of nodes][word]: where they are declared

  /// Whether any particle carries a traction.
  KOKKOS_FUNCTION bool any() const { return tractions != 0; }
  /// The number of the highest traction carried, plus one.
  KOKKOS_FUNCTION int count() const {
    int n = 0;
    while (n < 32 && tractions >> n != 0) ++n;
    return n;
  }
  /// The tractions declared at node x of a row of nodes.
  KOKKOS_FUNCTION TractionMask at(int row, int x) const {
    TractionMask mask = 0;
    for (int k = 0; k < count(); ++k)
      mask |= static_cast<TractionMask>(nodes(k, row, x / 64) >> (x % 64) & 1) << k;
    return mask;
  }
};

/// Allocates the words for rows of cells and of nodes, unless they are allocated already.
template <class Device>
void fit_carried(CarriedTractions<Device>& c, size_t cell_rows, size_t node_rows, size_t words) {
  if (!c.any() || (c.cells.extent(1) == cell_rows && c.cells.extent(2) == words)) return;
  using Words = typename CarriedTractions<Device>::Words;
  const auto tractions = static_cast<size_t>(c.count());
  c.cells = Words("vsb::carrying_cells", tractions, cell_rows, words);
  c.nodes = Words("vsb::carried_declarations", tractions, node_rows, words);
}

}  // namespace vsb
