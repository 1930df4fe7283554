// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Sets of cells and nodes as bits: rows along x, 64 to a word. "The cells that touch a set" is the set
/// dilated by one cell in every direction.
#pragma once

#include <vsb/kernels/preconditions.hpp>
#include <vsb/physics/cell_numbering.hpp>
#include <vsb/views/carried_tractions.hpp>

namespace vsb {

/// Bit sets of cells, one row of words per row of cells along x; kept between calls.
template <class Device>
struct CellBits {
  using Word = std::uint64_t;                                      ///< 64 cells or nodes side by side along x
  using Rows = Kokkos::View<Word**, Kokkos::LayoutRight, Device>;  ///< a set
  Rows occupied;                                                   ///< [row][word]: non-void cells
  Rows exterior;                                                   ///< [row][word]: E1
  Rows boundary;                                                   ///< [row][word]: E1 and E2
  Rows underfilled;  ///< [row][word]: cells of E2 for want of particles; no rows without a fill criterion
  Rows outside;      ///< [row][word]: void cells that may be of E1; no rows without a void filter
  CarriedTractions<Device> carried;  ///< those whose surface moves with the material
};

namespace kernel {

/// The bits of word w that stand for one of `count` cells or nodes.
KOKKOS_INLINE_FUNCTION std::uint64_t valid_bits(int w, int count) {
  const int left = count - 64 * w;
  return left >= 64 ? ~std::uint64_t(0) : left <= 0 ? 0 : (std::uint64_t(1) << left) - 1;
}

}  // namespace kernel

/// How rows of bits along x tile a grid.
template <int Dim>
struct BitRows {
  int cells_x;               ///< cells of a row
  Vector<2, int> cell_rows;  ///< rows of cells in y and z
  Vector<2, int> node_rows;  ///< rows of nodes in y and z
  int words;                 ///< words per row, of cells and of nodes
  ///@{
  /// The lowest and the highest cell that exist in each direction; 0 in those left out.
  Vector<3, int> first, last;
  ///@}

  /// All cells of a grid exist.
  KOKKOS_FUNCTION explicit BitRows(const CellNumbering<Dim>& grid) : cells_x(grid.cells[0]) {
    for (int i = 0; i < 2; ++i) {
      cell_rows[i] = i + 1 < Dim ? grid.cells[i + 1] : 1;
      node_rows[i] = i + 1 < Dim ? grid.cells[i + 1] + 1 : 1;
    }
    words = (cells_x + 1 + 63) / 64;
    for (int i = 0; i < 3; ++i) {
      first[i] = 0;
      last[i] = i < Dim ? grid.cells[i < Dim ? i : 0] - 1 : 0;
    }
  }
  /// Without the ghost cells beyond walls.
  template <class Basis>
  KOKKOS_FUNCTION static BitRows of(const Basis& basis) {
    BitRows rows(basis.grid);
    for (int i = 0; i < Dim; ++i) {
      if (basis.mirrored(i, 0)) ++rows.first[i];
      if (basis.mirrored(i, 1)) --rows.last[i];
    }
    return rows;
  }
  ///@{
  /// The row of cells at (j, k), and back; CellNumbering::row_index says the same of a cell.
  KOKKOS_FUNCTION int cell_row(int j, int k) const { return k * cell_rows[0] + j; }
  KOKKOS_FUNCTION Vector<2, int> cell_row_indices(int r) const {
    return {{r % cell_rows[0], r / cell_rows[0]}};
  }
  ///@}
  /// Rows of cells.
  KOKKOS_FUNCTION int cell_row_count() const { return cell_rows[0] * cell_rows[1]; }
  /// Rows of nodes.
  KOKKOS_FUNCTION int node_row_count() const { return node_rows[0] * node_rows[1]; }

  /// The bits of word w that stand for cells (upper = 0) or nodes (upper = 1) first, ..., last + upper of the
  /// row at (j, k).
  KOKKOS_FUNCTION std::uint64_t existing(const Vector<2, int>& at, int w, int upper) const {
    for (int i = 0; i < 2; ++i)
      if (at[i] < first[i + 1] || at[i] > last[i + 1] + (i + 1 < Dim ? upper : 0)) return 0;
    return kernel::valid_bits(w, last[0] + upper + 1) & ~kernel::valid_bits(w, first[0]);
  }
};

/// Allocates bit sets for a grid.
template <class Device, int Dim>
CellBits<Device> allocate_cell_bits(const CellNumbering<Dim>& grid) {
  check_grid(grid);
  const BitRows<Dim> rows(grid);
  const auto r = static_cast<size_t>(rows.cell_row_count()), w = static_cast<size_t>(rows.words);
  using Rows = typename CellBits<Device>::Rows;
  return {Rows("vsb::cells_occupied", r, w),
          Rows("vsb::cells_exterior", r, w),
          Rows("vsb::cells_boundary", r, w),
          Rows(),
          Rows(),
          {}};
}

namespace kernel {

/// Word w of the union of cell rows (j, k), first[0] <= j <= last[0], first[1] <= k <= last[1], each dilated
/// by `down` cells towards lower x and by `up` towards higher x.
template <int Dim, class Rows>
KOKKOS_INLINE_FUNCTION std::uint64_t dilated_word(const Rows& bits, const BitRows<Dim>& tiling, int w,
                                                  const Vector<2, int>& first, const Vector<2, int>& last,
                                                  int down, int up) {
  std::uint64_t result = 0;
  for (int k = math::max(first[1], 0); k <= math::min(last[1], tiling.cell_rows[1] - 1); ++k)
    for (int j = math::max(first[0], 0); j <= math::min(last[0], tiling.cell_rows[0] - 1); ++j) {
      const int row = tiling.cell_row(j, k);
      const std::uint64_t x = bits(row, w);
      result |= x;
      for (int n = 1; n <= up; ++n) {
        result |= x << n;
        if (w > 0) result |= bits(row, w - 1) >> (64 - n);
      }
      for (int n = 1; n <= down; ++n) {
        result |= x >> n;
        if (w + 1 < tiling.words) result |= bits(row, w + 1) << (64 - n);
      }
    }
  return result;
}

/// Word w of row r: the existing cells that touch a cell of `source`, the cells of `source` included.
template <int Dim, class Rows>
KOKKOS_INLINE_FUNCTION std::uint64_t touching_cells(const Rows& source, const BitRows<Dim>& tiling, int r,
                                                    int w) {
  const auto at = tiling.cell_row_indices(r);
  return dilated_word(source, tiling, w, {{at[0] - 1, at[1] - 1}}, {{at[0] + 1, at[1] + 1}}, 1, 1) &
         tiling.existing(at, w, 0);
}

}  // namespace kernel

}  // namespace vsb
