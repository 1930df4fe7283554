// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Multilinear basis functions on a mapped grid: N_I(x) = N_a(xi(x)), grad N_I = J^-T dN_a/dxi, with the
/// local coordinates xi of x in its cell.
#pragma once

#include <vsb/physics/cell_basis.hpp>
#include <vsb/physics/mapped_grid.hpp>
#include <vsb/physics/shape.hpp>

namespace vsb {

/// Linear, bilinear or trilinear functions on a mapped grid; the equations are at the top of this file.
template <int Dim, class Real>
struct MappedLinearBasis : CellBasis<MappedGrid<Dim, Real>> {
  using CellBasis<MappedGrid<Dim, Real>>::grid;
  using CellBasis<MappedGrid<Dim, Real>>::support;

  /// The basis functions at x, which must lie in the grid. Support node a is corner a of the cell.
  KOKKOS_FUNCTION Shape<Dim, support, Real> shape(const Vector<Dim, Real>& x) const {
    auto location = grid.locate(x);
    for (int i = 0; i < Dim; ++i) location.xi[i] = off_the_faces(location.xi[i]);
    const int lowest = grid.node_index(location.cell);
    const auto point = grid.cell(location.cell).at(location.xi);
    const auto inverse_J = inverse(point.J);
    Shape<Dim, support, Real> s;
    for (int a = 0; a < support; ++a) {
      s.node[a] = lowest + grid.corner_offset(a);
      s.N[a] = point.N[a];
      for (int j = 0; j < Dim; ++j) {
        s.dN[a][j] = point.dN[a][0] * inverse_J(0, j);
        for (int k = 1; k < Dim; ++k) s.dN[a][j] += point.dN[a][k] * inverse_J(k, j);
      }
    }
    return s;
  }
};

}  // namespace vsb
