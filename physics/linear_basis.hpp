// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Multilinear basis functions on a uniform grid: N_I = prod_i (1 - |x_i - x_Ii| / h_i) within one cell of
/// node I.
///
/// What a kernel asks of any basis: `dimension`, `real`, `support`, `ghost_layers`, shape(x), contains(x),
/// mirrored(axis, side), and bins (see physics/cell_basis.hpp).
#pragma once

#include <vsb/physics/cell_basis.hpp>
#include <vsb/physics/multilinear.hpp>
#include <vsb/physics/shape.hpp>
#include <vsb/physics/uniform_grid.hpp>

namespace vsb {

/// Linear, bilinear or trilinear functions on a uniform grid; the equation is at the top of this file.
template <int Dim, class Real>
struct LinearBasis : CellBasis<UniformGrid<Dim, Real>> {
  using CellBasis<UniformGrid<Dim, Real>>::grid;
  using CellBasis<UniformGrid<Dim, Real>>::support;

  /// The basis functions at x, which must lie in the grid. Support node a is the cell's corner whose position
  /// in direction i is bit i of a.
  KOKKOS_FORCEINLINE_FUNCTION Shape<Dim, support, Real> shape(const Vector<Dim, Real>& x) const {
    const auto q = grid.in_cells(x);
    const auto cell = grid.cell_of(q);
    const int lowest = grid.node_index(cell);
    Vector<Dim, Real> xi;
    for (int i = 0; i < Dim; ++i) xi[i] = off_the_faces(q[i] - static_cast<Real>(cell[i]));
    Shape<Dim, support, Real> s;
    multilinear(xi, grid.inverse_spacing, s.N, s.dN);
    for (int a = 0; a < support; ++a) s.node[a] = lowest + grid.corner_offset(a);
    return s;
  }
};

}  // namespace vsb
