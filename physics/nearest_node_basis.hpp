// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Bins and tensor products of bases whose support nodes are the 3^Dim nodes around the nearest one. A bin is
/// a node-centred cell, the points nearest to its node, with the number of that node.
///
/// Points lie at least one cell away from the faces of `grid`. Its outermost layer of cells are ghost cells,
/// which with_ghost_layer adds to the grid of a scene. At a wall the nodes of this layer are mirror images
/// (see kernels/particles/mirror_nodes.hpp), so that fixed planes and planes of symmetry are exact.
#pragma once

#include <vsb/physics/shape.hpp>
#include <vsb/physics/uniform_grid.hpp>
#include <vsb/physics/walls.hpp>

namespace vsb {

/// A grid with one more layer of cells on every side.
template <int Dim, class Real>
KOKKOS_INLINE_FUNCTION UniformGrid<Dim, Real> with_ghost_layer(UniformGrid<Dim, Real> grid) {
  for (int i = 0; i < Dim; ++i) {
    grid.lower[i] -= grid.spacing[i];
    grid.cells[i] += 2;
  }
  return grid;
}

/// The functions of one direction at the nodes below, at and above the nearest one, and their derivatives per
/// cell.
template <class T>
struct NodeTriple {
  ///@{
  /// N and dN / dxi.
  T N[3], dN[3];
  ///@}
};

/// The products of one function of every direction. Digit i of a, to the base 3: the node is below, at or
/// above the nearest node in direction i.
template <int Dim, int Support, class T>
KOKKOS_FORCEINLINE_FUNCTION void multiply_triples(const NodeTriple<T> (&f)[Dim], Shape<Dim, Support, T>& s) {
  for (int a = 0; a < Support; ++a) {
    s.N[a] = 1;
    for (int j = 0; j < Dim; ++j) s.dN[a][j] = 1;
    for (int i = 0, digits = a; i < Dim; ++i, digits /= 3) {
      s.N[a] *= f[i].N[digits % 3];
      for (int j = 0; j < Dim; ++j) s.dN[a][j] *= i == j ? f[i].dN[digits % 3] : f[i].N[digits % 3];
    }
  }
}

/// What the bases around the nearest node share. Support node a is below, at or above the nearest node in
/// direction i, by digit i of a to the base 3.
template <int Dim, class Real>
struct NearestNodeBasis {
  static constexpr int dimension = Dim;  ///< of space: 1, 2 or 3
  /// Nodes whose functions may be non-zero at a point, 3^Dim.
  static constexpr int support = Dim == 1 ? 3 : Dim == 2 ? 9 : 27;
  static constexpr int ghost_layers = 1;         ///< see CellBasis
  static constexpr int bins_of_cell = 1 << Dim;  ///< see CellBasis
  using real = Real;                             ///< type of the numbers
  using Position = Vector<Dim, Real>;            ///< in m

  UniformGrid<Dim, Real> grid;  ///< with its ghost layer
  Walls<Dim> walls;             ///< at the faces between the ghost layer and the other cells

  /// Whether the nodes beyond a face are mirror images (see physics/walls.hpp).
  KOKKOS_FUNCTION bool mirrored(int axis, int side) const { return walls.mirrored(axis, side); }

  /// Whether x lies in the grid without its ghost layer; round-off at a face counts as inside, NaN as
  /// outside.
  KOKKOS_FUNCTION bool contains(const Position& x) const {
    const auto q = grid.in_cells(x);
    for (int i = 0; i < Dim; ++i) {
      const Real n = static_cast<Real>(grid.cells[i]), round_off = 16 * n * math::epsilon<Real>;
      if (!(q[i] >= 1 - round_off && q[i] <= n - 1 + round_off)) return false;
    }
    return true;
  }

  ///@{
  /// As in CellBasis; bins are node-centred cells.
  KOKKOS_FUNCTION int node_count() const { return grid.node_count(); }
  KOKKOS_FUNCTION int bin_count() const { return grid.node_count(); }
  KOKKOS_FUNCTION int bin(const Position& x) const { return grid.node_index(nearest_node(grid.in_cells(x))); }
  KOKKOS_FUNCTION int node_of_bin(int bin_index, int a) const { return bin_index + offset(a); }
  ///@}
  /// The bin whose support node a is `node`, or -1 where there is none.
  KOKKOS_FUNCTION int bin_of_node(int node, int a) const {
    const auto ijk = grid.node_ijk(node);
    for (int i = 0, digits = a; i < Dim; ++i, digits /= 3) {
      const int nearest = ijk[i] - (digits % 3 - 1);
      if (nearest < 1 || nearest >= grid.cells[i]) return -1;
    }
    return node - offset(a);
  }

  /// The node (i, j, k) nearest to q >= 0, a position in cells from node 0.
  KOKKOS_FORCEINLINE_FUNCTION static Vector<Dim, int> nearest_node(const Vector<Dim, Real>& q) {
    Vector<Dim, int> ijk;
    for (int i = 0; i < Dim; ++i) ijk[i] = static_cast<int>(q[i] + Real(0.5));
    return ijk;
  }

  /// The products of functions(i, xi), the NodeTriple of direction i at the distance xi, -1/2 <= xi <= 1/2,
  /// in cells from the nearest node.
  template <class Functions>
  KOKKOS_FORCEINLINE_FUNCTION Shape<Dim, support, Real> product_shape(const Position& x,
                                                                      const Functions& functions) const {
    const auto q = grid.in_cells(x);
    const auto nearest = nearest_node(q);
    NodeTriple<Real> f[Dim];
    for (int i = 0; i < Dim; ++i) {
      f[i] = functions(i, q[i] - static_cast<Real>(nearest[i]));
      for (int k = 0; k < 3; ++k) f[i].dN[k] *= grid.inverse_spacing[i];
    }
    const int centre = grid.node_index(nearest);
    Shape<Dim, support, Real> s;
    for (int a = 0; a < support; ++a) s.node[a] = centre + offset(a);
    multiply_triples(f, s);
    return s;
  }

 private:
  /// Node number of support node a less that of the nearest node.
  KOKKOS_FUNCTION int offset(int a) const {
    int sum = 0;
    for (int i = 0; i < Dim; ++i, a /= 3) sum += (a % 3 - 1) * grid.node_stride(i);
    return sum;
  }
};

}  // namespace vsb
