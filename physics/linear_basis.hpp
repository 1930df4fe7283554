// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Multilinear basis functions on a uniform grid: N_I = prod_i (1 - |x_i - x_Ii| / h_i) within one cell of
/// node I.
///
/// What a kernel asks of any basis: `dimension`, `real`, `support`, shape(x), contains(x), and bins. A bin
/// collects the particles that share their support nodes; here it is a cell, and it carries the number of the
/// cell's lowest node.
#pragma once

#include <vsb/physics/shape.hpp>
#include <vsb/physics/uniform_grid.hpp>

namespace vsb {

template <int Dim, class Real>
struct LinearBasis {
  static constexpr int dimension = Dim;
  static constexpr int support = 1 << Dim;
  using real = Real;

  UniformGrid<Dim, Real> grid;

  /// The basis functions at x, which must lie in the grid. Support node a is the cell's corner whose position
  /// in direction i is bit i of a.
  KOKKOS_FORCEINLINE_FUNCTION Shape<Dim, support, Real> shape(const Vector<Dim, Real>& x) const {
    const auto q = grid.in_cells(x);
    const auto cell = grid.cell_of(q);
    const int lowest = grid.node_index(cell);
    Real N[Dim][2];
    for (int i = 0; i < Dim; ++i) {
      N[i][1] = q[i] - static_cast<Real>(cell[i]);
      N[i][0] = Real(1) - N[i][1];
    }
    Shape<Dim, support, Real> s;
    for (int a = 0; a < support; ++a) {
      s.node[a] = lowest + node_offset(a);
      s.N[a] = Real(1);
      for (int j = 0; j < Dim; ++j)
        s.dN[a][j] = (a >> j & 1) ? grid.inverse_spacing[j] : -grid.inverse_spacing[j];
      for (int i = 0; i < Dim; ++i) {
        const Real factor = N[i][a >> i & 1];
        s.N[a] *= factor;
        for (int j = 0; j < Dim; ++j)
          if (i != j) s.dN[a][j] *= factor;
      }
    }
    return s;
  }

  KOKKOS_FUNCTION bool contains(const Vector<Dim, Real>& x) const { return grid.contains(x); }

  KOKKOS_FUNCTION int node_count() const { return grid.node_count(); }

  /// Number of bins; some of them may never hold a particle.
  KOKKOS_FUNCTION int bin_count() const { return grid.node_count(); }

  /// The bin of a point of the grid.
  KOKKOS_FUNCTION int bin(const Vector<Dim, Real>& x) const {
    return grid.node_index(grid.cell_of(grid.in_cells(x)));
  }

  /// Support node a of a bin's particles.
  KOKKOS_FUNCTION int node_of_bin(int bin_index, int a) const { return bin_index + node_offset(a); }

  /// The bin whose support node a is `node`, or -1 where there is none.
  KOKKOS_FUNCTION int bin_of_node(int node, int a) const {
    const auto ijk = grid.node_coordinates(node);
    for (int i = 0; i < Dim; ++i) {
      const int cell = ijk[i] - (a >> i & 1);
      if (cell < 0 || cell >= grid.cells[i]) return -1;
    }
    return node - node_offset(a);
  }

 private:
  KOKKOS_FUNCTION int node_offset(int a) const {
    int offset = 0;
    for (int i = 0; i < Dim; ++i)
      if (a >> i & 1) offset += grid.node_stride(i);
    return offset;
  }
};

}  // namespace vsb
