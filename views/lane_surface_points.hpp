// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Surface points (views/surface_points.hpp) beside cell lanes. Their position is a cell and xi in it, as
/// that of particles in lanes.
#pragma once

#include <vsb/views/cell_lanes.hpp>
#include <vsb/views/surface_points.hpp>

namespace vsb {

/// Surface points, one row each, sorted by the cells of the lanes' box. A loaded material point starts at the
/// position of its particle and moves with the same velocities. It does not need the entry of its particle.
template <int Dim, class Real, class Device>
struct LaneSurfacePoints {
  using Fields = Kokkos::View<Real**, Kokkos::LayoutRight, Device>;  ///< one row per point
  using Ints = Kokkos::View<int*, Device>;                           ///< numbers of points and cells
  Kokkos::View<int* [Dim], Device> cell;                             ///< [point][Dim], of the grid
  Fields xi;                                      ///< [point][Dim]: position in the cell, in [0, 1)
  Fields area;                                    ///< [point][Dim]: as in SurfacePoints
  Kokkos::View<TractionMask*, Device> tractions;  ///< [point]: the tractions that act on it
  Ints carrier;                                   ///< [point]: see SurfaceCarrier
  CellBox<Dim> box;                               ///< of the lanes, when the points were sorted
  Ints order;       ///< [point]: point numbers by cell of the box, increasing within a cell; those outside
                    ///< the box last
  Ints run_cell;    ///< [run of points in one cell]: number of the cell in the box, increasing
  Ints run_first;   ///< [run + 1]: where it begins in `order`
  Ints cell_count;  ///< [cell of the box + 1]: scratch of the sort
  int runs = 0;     ///< of points in the box
  bool sorted = false;  ///< whether all this is up to date for `box`

  /// Number of surface points.
  KOKKOS_FUNCTION int count() const { return static_cast<int>(xi.extent(0)); }
  /// The cell (i, j, k) of the grid in which a point is.
  KOKKOS_FUNCTION Vector<Dim, int> cell_of(int b) const {
    Vector<Dim, int> c;
    for (int i = 0; i < Dim; ++i) c[i] = cell(b, i);
    return c;
  }
  /// The position of a point in its cell, [0, 1)^Dim.
  KOKKOS_FUNCTION Vector<Dim, Real> xi_of(int b) const { return row(xi, b); }
  /// Area times outward unit normal of a point; m^2 (1 in 1D, m in 2D).
  KOKKOS_FUNCTION Vector<Dim, Real> area_of(int b) const { return row(area, b); }

 private:
  KOKKOS_FUNCTION static Vector<Dim, Real> row(const Fields& field, int b) {
    Vector<Dim, Real> v;
    for (int i = 0; i < Dim; ++i) v[i] = field(b, i);
    return v;
  }
};

}  // namespace vsb
