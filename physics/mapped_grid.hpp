// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A logically regular grid of multilinear cells with nodes at arbitrary positions, such as a graded or a
/// polar one.
///
/// In a rectilinear grid the cell that contains a point is found by bisection along each axis. In others it
/// is found by a walk. A uniform raster over the grid's bounding box gives a first cell near the point. As
/// long as the point lies beyond a face of the cell, the walk goes on in that direction. Its strides double
/// until one is too long, and are halved from then on. Both searches visit a number of cells that grows as
/// the logarithm of the cells along an axis. The result depends on the point alone, so that all kernels of a
/// step find the same cell.
#pragma once

#include <vsb/physics/multilinear.hpp>
#include <vsb/physics/uniform_grid.hpp>

namespace vsb {

/// A value that kernels copy; the memory it points to belongs to a MappedMesh
/// (kernels/mesh/make_mapped_mesh.hpp).
template <int Dim, class Real>
struct MappedGrid : CellNumbering<Dim> {
  using CellNumbering<Dim>::cells;
  using real = Real;  ///< type of the numbers

  const Real* position;           ///< [node][Dim], m
  const int* start_cell;          ///< [raster cell]: the first cell of a walk to a point in it
  UniformGrid<Dim, Real> raster;  ///< covers the bounding box
  bool rectilinear;               ///< coordinate i of a node depends on its number along axis i alone
  Real tolerance;                 ///< how far outside [0, 1] round-off may take local coordinates

  /// The position of a node, m.
  KOKKOS_FUNCTION Vector<Dim, Real> node_position(int node) const {
    Vector<Dim, Real> x;
    for (int i = 0; i < Dim; ++i) x[i] = position[node * Dim + i];
    return x;
  }
  /// Cell (i, j, k), by the positions of its corners.
  KOKKOS_FUNCTION MultilinearCell<Dim, Real> cell(const Vector<Dim, int>& ijk) const {
    const int lowest = this->node_index(ijk);
    MultilinearCell<Dim, Real> c;
    for (int a = 0; a < this->corners; ++a) c.corner[a] = node_position(lowest + this->corner_offset(a));
    return c;
  }
  /// The point with local coordinates xi in [0, 1]^Dim of a cell.
  KOKKOS_FUNCTION CellPoint<Dim, Real> map(const Vector<Dim, int>& ijk, const Vector<Dim, Real>& xi) const {
    const auto at = cell(ijk).at(xi);
    return {at.x, determinant(at.J)};
  }
  /// The volume of cell (i, j, k), m^Dim.
  KOKKOS_FUNCTION Real cell_volume(const Vector<Dim, int>& ijk) const { return cell(ijk).volume(); }

  /// A cell and the local coordinates in it.
  struct Location {
    Vector<Dim, int> cell;  ///< (i, j, k)
    Vector<Dim, Real> xi;   ///< in [0, 1]^Dim
    bool found;             ///< false: `cell` and `xi` mean nothing
  };

  /// The cell and local coordinates of x; not found outside the grid and at NaN. A point on a face belongs to
  /// one of its cells. A point outside the grid by round-off counts as inside.
  KOKKOS_FUNCTION Location locate(const Vector<Dim, Real>& x) const {
    if (!raster.contains(x)) return {Vector<Dim, int>::zero(), Vector<Dim, Real>::zero(), false};
    if (rectilinear) return bisect(x);
    const Location location = walk(x);
    return location.found ? location : search(x);
  }

  /// Whether x lies in the grid; false at NaN.
  KOKKOS_FUNCTION bool contains(const Vector<Dim, Real>& x) const { return locate(x).found; }

  /// The cell of a point of the grid.
  KOKKOS_FUNCTION Vector<Dim, int> cell_containing(const Vector<Dim, Real>& x) const {
    return locate(x).cell;
  }

  /// In a rectilinear grid. A point on a face belongs to the cell above it.
  KOKKOS_FUNCTION Location bisect(const Vector<Dim, Real>& x) const {
    Location location{Vector<Dim, int>::zero(), Vector<Dim, Real>::zero(), false};
    for (int i = 0; i < Dim; ++i) {
      const int stride = this->node_stride(i);
      int last = cells[i];
      while (last - location.cell[i] > 1) {
        const int middle = (location.cell[i] + last) / 2;
        (x[i] < position[middle * stride * Dim + i] ? last : location.cell[i]) = middle;
      }
    }
    inside(x, location);
    return location;
  }

  /// From the raster's cell to the one that contains x.
  KOKKOS_FUNCTION Location walk(const Vector<Dim, Real>& x) const {
    return walk(x, start_cell[raster.cell_index(raster.cell_containing(x))]);
  }
  /// From a given cell. Not found where the walk ends at a face of the grid, or goes in circles. This happens
  /// for points outside the grid, and in cells that are far from rectangles.
  KOKKOS_FUNCTION Location walk(const Vector<Dim, Real>& x, int start) const {
    Location location{this->cell_ijk(start), Vector<Dim, Real>::zero(), false};
    auto stride = Vector<Dim, int>::zero();  // the last one along an axis; negative: backwards
    bool halve[Dim] = {};                    // whether one was too long
    int most_hops = 0;                       // a bound far above the steps of a walk that succeeds
    for (int i = 0; i < Dim; ++i)
      for (int n = cells[i]; n > 0; n /= 2) most_hops += 8;
    for (int hop = 0; hop <= most_hops; ++hop) {
      if (inside(x, location)) return location;
      int axis = -1;
      Real beyond = tolerance;
      for (int i = 0; i < Dim; ++i) {
        const Real b = math::max(-location.xi[i], location.xi[i] - Real(1));
        const bool last = location.xi[i] < Real(0) ? location.cell[i] == 0 : location.cell[i] == cells[i] - 1;
        if (b > beyond && !last) {
          axis = i;
          beyond = b;
        }
      }
      if (axis < 0) break;
      const int direction = location.xi[axis] < Real(0) ? -1 : 1, before = direction * stride[axis];
      halve[axis] = halve[axis] || before < 0;
      const int length = math::max(1, halve[axis] ? math::abs(before) / 2 : 2 * before);
      stride[axis] = direction * length;
      location.cell[axis] = math::max(0, math::min(location.cell[axis] + stride[axis], cells[axis] - 1));
      if (halve[axis] && length == 1) {  // from here anew
        halve[axis] = false;
        stride[axis] = 0;
      }
    }
    location.found = false;
    return location;
  }

  /// Tests all cells for x, for the few points that a walk does not find.
  KOKKOS_FUNCTION Location search(const Vector<Dim, Real>& x) const {
    Location location{Vector<Dim, int>::zero(), Vector<Dim, Real>::zero(), false};
    for (int n = 0; n < this->cell_count(); ++n) {
      location.cell = this->cell_ijk(n);
      if (near(x, location.cell) && inside(x, location)) return location;
    }
    location.cell = Vector<Dim, int>::zero();
    return location;
  }

  /// Sets the local coordinates of x in location.cell (where x is outside, they tell in which direction) and
  /// whether it is inside.
  KOKKOS_FUNCTION bool inside(const Vector<Dim, Real>& x, Location& location) const {
    const auto inverse = cell(location.cell).inverse(x);
    location.xi = inverse.xi;
    location.found = inverse.converged;
    for (int i = 0; i < Dim; ++i)
      if (!(location.xi[i] >= -tolerance && location.xi[i] <= Real(1) + tolerance)) location.found = false;
    return location.found;
  }

 private:
  /// Whether x lies within a cell's bounding box, widened on all sides.
  KOKKOS_FUNCTION bool near(const Vector<Dim, Real>& x, const Vector<Dim, int>& ijk) const {
    const auto c = cell(ijk);
    for (int i = 0; i < Dim; ++i) {
      Real low = c.corner[0][i], high = low;
      for (int a = 1; a < this->corners; ++a) {
        low = math::min(low, c.corner[a][i]);
        high = math::max(high, c.corner[a][i]);
      }
      const Real margin = Real(0.01) * (high - low);
      if (!(x[i] >= low - margin && x[i] <= high + margin)) return false;
    }
    return true;
  }
};

}  // namespace vsb
