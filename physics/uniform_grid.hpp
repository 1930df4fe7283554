// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A uniform background grid: axis-parallel cells of equal size. Nodes and cells are numbered along x first.
#pragma once

#include <limits>
#include <vsb/views/tensor.hpp>

namespace vsb {

template <int Dim, class Real>
struct UniformGrid {
  static_assert(Dim >= 1 && Dim <= 3, "UniformGrid: dimension 1, 2 or 3");
  static constexpr int dimension = Dim;
  using real = Real;

  Vector<Dim, Real> lower;            ///< position of node 0, m
  Vector<Dim, Real> spacing;          ///< cell size, m
  Vector<Dim, Real> inverse_spacing;  ///< 1/m
  Vector<Dim, int> cells;             ///< cells in each direction

  UniformGrid() = default;
  KOKKOS_FUNCTION UniformGrid(const Vector<Dim, Real>& lower_corner, const Vector<Dim, Real>& cell_size,
                              const Vector<Dim, int>& cell_count)
      : lower(lower_corner), spacing(cell_size), cells(cell_count) {
    for (int i = 0; i < Dim; ++i) inverse_spacing[i] = Real(1) / spacing[i];
  }

  KOKKOS_FUNCTION int node_count() const {
    int n = 1;
    for (int i = 0; i < Dim; ++i) n *= cells[i] + 1;
    return n;
  }
  KOKKOS_FUNCTION int cell_count() const {
    int n = 1;
    for (int i = 0; i < Dim; ++i) n *= cells[i];
    return n;
  }
  KOKKOS_FUNCTION Real cell_volume() const {
    Real v = spacing[0];
    for (int i = 1; i < Dim; ++i) v *= spacing[i];
    return v;
  }

  /// Distance in node numbers between neighbours in direction `axis`.
  KOKKOS_FUNCTION int node_stride(int axis) const {
    int stride = 1;
    for (int i = 0; i < axis; ++i) stride *= cells[i] + 1;
    return stride;
  }
  KOKKOS_FUNCTION int node_index(const Vector<Dim, int>& ijk) const {
    int index = 0;
    for (int i = Dim - 1; i >= 0; --i) index = index * (cells[i] + 1) + ijk[i];
    return index;
  }
  KOKKOS_FUNCTION Vector<Dim, int> node_coordinates(int node) const {
    Vector<Dim, int> ijk;
    for (int i = 0; i < Dim; ++i) {
      ijk[i] = node % (cells[i] + 1);
      node /= cells[i] + 1;
    }
    return ijk;
  }
  KOKKOS_FUNCTION Vector<Dim, Real> node_position(int node) const {
    const auto ijk = node_coordinates(node);
    Vector<Dim, Real> x;
    for (int i = 0; i < Dim; ++i) x[i] = lower[i] + static_cast<Real>(ijk[i]) * spacing[i];
    return x;
  }

  /// x in units of cells, from node 0.
  KOKKOS_FUNCTION Vector<Dim, Real> in_cells(const Vector<Dim, Real>& x) const {
    Vector<Dim, Real> q;
    for (int i = 0; i < Dim; ++i) q[i] = (x[i] - lower[i]) * inverse_spacing[i];
    return q;
  }
  /// The place with local coordinates xi in [0, 1] of a cell, and the cell's volume per volume of [0, 1]^Dim.
  struct Place {
    Vector<Dim, Real> x;
    Real volume_ratio;
  };
  KOKKOS_FUNCTION Place map(const Vector<Dim, int>& cell, const Vector<Dim, Real>& xi) const {
    Place place{{}, cell_volume()};
    for (int i = 0; i < Dim; ++i) place.x[i] = lower[i] + (static_cast<Real>(cell[i]) + xi[i]) * spacing[i];
    return place;
  }
  /// The cell in which x lies; x must be in the grid.
  KOKKOS_FUNCTION Vector<Dim, int> cell_containing(const Vector<Dim, Real>& x) const {
    return cell_of(in_cells(x));
  }
  /// Whether x lies in the grid; round-off at a face counts as inside, NaN as outside.
  KOKKOS_FUNCTION bool contains(const Vector<Dim, Real>& x) const {
    const auto q = in_cells(x);
    for (int i = 0; i < Dim; ++i) {
      constexpr Real epsilon = std::numeric_limits<Real>::epsilon();
      const Real n = static_cast<Real>(cells[i]), round_off = 16 * n * epsilon;
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
