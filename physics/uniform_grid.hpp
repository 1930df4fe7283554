// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A uniform background grid: axis-parallel cells of equal size.
///
/// What a kernel asks of any grid: the numbering of its nodes and cells, node_position(node), contains(x),
/// cell_containing(x) and cell_volume(cell).
#pragma once

#include <vsb/physics/cell_numbering.hpp>

namespace vsb {

/// Axis-parallel cells of equal size from the lower corner on.
template <int Dim, class Real>
struct UniformGrid : CellNumbering<Dim> {
  using CellNumbering<Dim>::cells;
  using real = Real;  ///< type of the numbers

  Vector<Dim, Real> lower = Vector<Dim, Real>::zero();            ///< position of node 0, m
  Vector<Dim, Real> spacing = Vector<Dim, Real>::zero();          ///< cell size, m
  Vector<Dim, Real> inverse_spacing = Vector<Dim, Real>::zero();  ///< 1/m

  UniformGrid() = default;
  /// Of the lower corner in m, the cell size > 0 in m and the cells > 0 in each direction.
  KOKKOS_FUNCTION UniformGrid(const Vector<Dim, Real>& lower_corner, const Vector<Dim, Real>& cell_size,
                              const Vector<Dim, int>& cell_count)
      : CellNumbering<Dim>{cell_count}, lower(lower_corner), spacing(cell_size) {
    for (int i = 0; i < Dim; ++i) inverse_spacing[i] = Real(1) / spacing[i];
  }

  ///@{
  /// The volume of a cell, m^Dim; the same for all.
  KOKKOS_FUNCTION Real cell_volume() const {
    Real v = spacing[0];
    for (int i = 1; i < Dim; ++i) v *= spacing[i];
    return v;
  }
  KOKKOS_FUNCTION Real cell_volume(const Vector<Dim, int>&) const { return cell_volume(); }
  ///@}

  /// The position of a node, m.
  KOKKOS_FUNCTION Vector<Dim, Real> node_position(int node) const {
    const auto ijk = this->node_ijk(node);
    Vector<Dim, Real> x;
    for (int i = 0; i < Dim; ++i) x[i] = lower[i] + static_cast<Real>(ijk[i]) * spacing[i];
    return x;
  }

  /// x in units of cells, from node 0.
  KOKKOS_FUNCTION Vector<Dim, Real> in_cells(const Vector<Dim, Real>& x) const {
    Vector<Dim, Real> q;
    for (int i = 0; i < Dim; ++i) q[i] = in_cells(x[i], i);
    return q;
  }
  /// The same for one coordinate.
  KOKKOS_FUNCTION Real in_cells(Real x, int axis) const { return (x - lower[axis]) * inverse_spacing[axis]; }
  /// The point with local coordinates xi in [0, 1]^Dim of a cell.
  KOKKOS_FUNCTION CellPoint<Dim, Real> map(const Vector<Dim, int>& cell, const Vector<Dim, Real>& xi) const {
    CellPoint<Dim, Real> point{{}, cell_volume()};
    for (int i = 0; i < Dim; ++i) point.x[i] = lower[i] + (static_cast<Real>(cell[i]) + xi[i]) * spacing[i];
    return point;
  }
  /// The cell in which x lies; x must be in the grid.
  KOKKOS_FUNCTION Vector<Dim, int> cell_containing(const Vector<Dim, Real>& x) const {
    return cell_of(in_cells(x));
  }
  /// Whether x lies in the grid; round-off at a face counts as inside, NaN as outside.
  KOKKOS_FUNCTION bool contains(const Vector<Dim, Real>& x) const {
    const auto q = in_cells(x);
    for (int i = 0; i < Dim; ++i) {
      const Real n = static_cast<Real>(cells[i]), round_off = 16 * n * math::epsilon<Real>;
      if (!(q[i] >= -round_off && q[i] <= n + round_off)) return false;
    }
    return true;
  }
  /// The cell that contains a point given in cells, by its lowest node; the point must be in the grid.
  KOKKOS_FUNCTION Vector<Dim, int> cell_of(const Vector<Dim, Real>& q) const {
    Vector<Dim, int> ijk;
    for (int i = 0; i < Dim; ++i) ijk[i] = math::min(static_cast<int>(q[i]), cells[i] - 1);
    return ijk;
  }
};

}  // namespace vsb
