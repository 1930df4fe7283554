// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// From cell to cell of a uniform grid, for points that are stored as a cell and the local coordinates xi in
/// it, off the cell's faces (physics/multilinear.hpp).
#pragma once

#include <vsb/physics/multilinear.hpp>
#include <vsb/physics/uniform_grid.hpp>

namespace vsb {

/// Moves a point with local coordinates xi of `cell`, which may lie outside [0, 1], to the cell that contains
/// it. Returns whether that is another cell. A point outside the grid by round-off counts as inside, as
/// everywhere (UniformGrid::contains). Points that are not finite, or too far from the cell, get a cell
/// outside the grid, and so do points closer than `margin` cells to a face of the grid.
template <int Dim, class Real>
KOKKOS_INLINE_FUNCTION bool to_next_cell(const UniformGrid<Dim, Real>& grid, Vector<Dim, int>& cell,
                                         Vector<Dim, Real>& xi, Real margin = 0) {
  bool out = false;
  for (int i = 0; i < Dim; ++i) {
    const Real round_off = 16 * static_cast<Real>(grid.cells[i]) * math::epsilon<Real>;
    const bool inside = xi[i] >= Real(0) && xi[i] < Real(1);
    const bool at_lower_face = cell[i] == 0 && xi[i] < Real(0) && xi[i] >= -round_off;
    const bool at_upper_face =
        cell[i] == grid.cells[i] - 1 && xi[i] >= Real(1) && xi[i] <= Real(1) + round_off;
    if (inside || at_lower_face || at_upper_face) {
      xi[i] = off_the_faces(xi[i]);
      continue;
    }
    const Real whole = math::floor(xi[i]);
    if (!(math::abs(whole) < Real(1 << 20))) {
      out = true;
      cell[i] = -1;
      continue;
    }
    xi[i] -= whole;
    const bool just_below_zero = xi[i] >= Real(1);  // by less than round-off of 1
    const int steps = static_cast<int>(whole) + (just_below_zero ? 1 : 0);
    xi[i] = off_the_faces(just_below_zero ? Real(0) : xi[i]);
    cell[i] += steps;
    out = out || steps != 0;
  }
  if (margin == Real(0)) return out;
  for (int i = 0; i < Dim; ++i) {
    const int last = grid.cells[i] - 1;
    const Real round_off = 16 * static_cast<Real>(grid.cells[i]) * math::epsilon<Real>;
    const bool below = cell[i] == 0 && xi[i] < margin - round_off,
               above = cell[i] == last && xi[i] > 1 - margin + round_off;
    if (!below && !above) continue;
    out = true;
    cell[i] += above ? 1 : -1;  // the position does not change
    xi[i] += above ? Real(-1) : Real(1);
  }
  return out;
}

}  // namespace vsb
