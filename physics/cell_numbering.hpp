// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// How the nodes and cells of a logically regular grid are numbered: along x first, wherever the nodes are.
#pragma once

#include <vsb/views/tensor.hpp>

namespace vsb {

/// A position in a cell, and the volume there per volume of local coordinates.
template <int Dim, class Real>
struct CellPoint {
  Vector<Dim, Real> x;  ///< m
  Real volume_ratio;    ///< det(dx / dxi), m^Dim
};

/// Nodes and cells of a logically regular grid by their numbers (i, j, k) along each direction, and by one
/// number, i first. Cell (i, j, k) has node (i, j, k) as its lowest.
template <int Dim>
struct CellNumbering {
  static_assert(Dim >= 1 && Dim <= 3, "CellNumbering: dimension 1, 2 or 3");
  static constexpr int dimension = Dim;     ///< of space: 1, 2 or 3
  static constexpr int corners = 1 << Dim;  ///< nodes of a cell

  Vector<Dim, int> cells = Vector<Dim, int>::zero();  ///< cells in each direction

  /// Number of nodes.
  KOKKOS_FUNCTION int node_count() const {
    int n = 1;
    for (int i = 0; i < Dim; ++i) n *= cells[i] + 1;
    return n;
  }
  /// Number of cells.
  KOKKOS_FUNCTION int cell_count() const {
    int n = 1;
    for (int i = 0; i < Dim; ++i) n *= cells[i];
    return n;
  }

  /// Distance in node numbers between neighbours in direction `axis`.
  KOKKOS_FUNCTION int node_stride(int axis) const {
    int stride = 1;
    for (int i = 0; i < axis; ++i) stride *= cells[i] + 1;
    return stride;
  }
  /// The number of node (i, j, k).
  KOKKOS_FUNCTION int node_index(const Vector<Dim, int>& ijk) const {
    int index = 0;
    for (int i = Dim - 1; i >= 0; --i) index = index * (cells[i] + 1) + ijk[i];
    return index;
  }
  /// The numbers (i, j, k) of a node along the axes, from 0. node_position gives its position.
  KOKKOS_FUNCTION Vector<Dim, int> node_ijk(int node) const {
    Vector<Dim, int> ijk;
    for (int i = 0; i < Dim; ++i) {
      ijk[i] = node % (cells[i] + 1);
      node /= cells[i] + 1;
    }
    return ijk;
  }
  /// The number of corner a of a cell less that of the cell's lowest node. Bit i of a: the corner is on the
  /// upper side of the cell in direction i.
  KOKKOS_FUNCTION int corner_offset(int a) const {
    int offset = 0;
    for (int i = 0; i < Dim; ++i)
      if (a >> i & 1) offset += node_stride(i);
    return offset;
  }

  /// The number of cell (i, j, k).
  KOKKOS_FUNCTION int cell_index(const Vector<Dim, int>& ijk) const {
    int index = 0;
    for (int i = Dim - 1; i >= 0; --i) index = index * cells[i] + ijk[i];
    return index;
  }
  /// The number of the row of cells along x that contains a cell.
  KOKKOS_FUNCTION int row_index(const Vector<Dim, int>& ijk) const {
    int row = 0;
    for (int i = Dim - 1; i > 0; --i) row = row * cells[i] + ijk[i];
    return row;
  }
  /// The position (i, j, k) of a cell number.
  KOKKOS_FUNCTION Vector<Dim, int> cell_ijk(int cell) const {
    Vector<Dim, int> ijk;
    for (int i = 0; i < Dim; ++i) {
      ijk[i] = cell % cells[i];
      cell /= cells[i];
    }
    return ijk;
  }
};

}  // namespace vsb
