// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Tractions on surface points beside cell lanes, Eq. (12), Eq. (13) (see
/// kernels/particles/surface_traction.hpp):
///   f_I <- f_I + sum_b N_I(x_b) sbar(x_b) a_b,   a_b <- cof(I + dt L) a_b.
/// Points are worked on cell by cell: those of a cell share its nodal values of dt v and its polynomials of
/// dt v*.
///
/// Reads the nodal increments dt v and dt v*; writes the force of the nodes' sums, a layer each call, and
/// positions and areas of the points.
#pragma once

#include <vsb/kernels/lanes/build.hpp>
#include <vsb/kernels/particles/surface_traction.hpp>
#include <vsb/physics/cell_polynomial.hpp>
#include <vsb/physics/next_cell.hpp>
#include <vsb/views/lane_surface_points.hpp>

namespace vsb {

namespace kernel {

/// One point: finds its cell and xi from its position. A point outside the grid gets a cell outside the grid.
template <int Dim, class Real, class Device>
struct PackSurfacePoint {
  SurfacePoints<Dim, Real, Device> from;
  LaneSurfacePoints<Dim, Real, Device> points;
  UniformGrid<Dim, Real> grid;

  KOKKOS_FUNCTION void operator()(int b) const {
    const auto x = from.position_of(b);
    const auto q = grid.in_cells(x);
    const bool inside = grid.contains(x);
    for (int i = 0; i < Dim; ++i) {
      points.cell(b, i) = inside ? grid.cell_of(q)[i] : -1;
      points.xi(b, i) = inside ? q[i] - static_cast<Real>(points.cell(b, i)) : Real(0);
      points.area(b, i) = from.area(b, i);
    }
    points.tractions(b) = from.tractions(b);
    points.carrier(b) = from.carrier(b);
  }
};

template <int Dim, class Real, class Device>
struct UnpackSurfacePoint {
  LaneSurfacePoints<Dim, Real, Device> points;
  SurfacePoints<Dim, Real, Device> to;
  UniformGrid<Dim, Real> grid;

  KOKKOS_FUNCTION void operator()(int b) const {
    if (points.carrier(b) == carried_by_none) return;
    const auto x = grid.map(points.cell_of(b), points.xi_of(b)).x;
    for (int i = 0; i < Dim; ++i) {
      to.position(b, i) = x[i];
      to.area(b, i) = points.area(b, i);
    }
  }
};

/// Sorts the points by cell; a single work item. Points are few, and are sorted often: whenever one crosses a
/// face between cells. One kernel is faster here than half a dozen parallel ones. Results: the number of
/// runs, and the lowest number of a point outside the grid less the number of points, or 0.
template <int Dim, class Real, class Device>
struct SortSurfacePoints {
  LaneSurfacePoints<Dim, Real, Device> points;
  CellNumbering<Dim> grid;

  KOKKOS_FUNCTION void operator()(int, int& runs, int& lost) const {
    const int n = points.count(), cells = CellNumbering<Dim>{points.box.cells}.cell_count();
    const auto& count = points.cell_count;
    for (int c = 0; c <= cells; ++c) count(c) = 0;
    for (int b = n - 1; b >= 0; --b) {
      const auto cell = points.cell_of(b);
      ++count(number(cell));
      if (!in_grid(cell)) lost = b - n;
    }
    int sum = 0;
    for (int c = 0; c < cells; ++c) {
      const int here = count(c);
      count(c) = sum;
      if (here == 0) continue;
      points.run_cell(runs) = c;
      points.run_first(runs++) = sum;
      sum += here;
    }
    points.run_first(runs) = count(cells) = sum;
    for (int b = 0; b < n; ++b) points.order(count(number(points.cell_of(b)))++) = b;
  }
  KOKKOS_FUNCTION bool in_grid(const Vector<Dim, int>& cell) const {
    bool inside = true;
    for (int i = 0; i < Dim; ++i) inside = inside && cell[i] >= 0 && cell[i] < grid.cells[i];
    return inside;
  }
  /// The number of a cell in the box; all cells outside the box have the number of cells.
  KOKKOS_FUNCTION int number(const Vector<Dim, int>& cell) const {
    const CellNumbering<Dim> box{points.box.cells};
    Vector<Dim, int> c;
    for (int i = 0; i < Dim; ++i) {
      c[i] = cell[i] - points.box.first[i];
      if (c[i] < 0 || c[i] >= box.cells[i]) return box.cell_count();
    }
    return box.cell_index(c);
  }
};

/// The points of one cell: positions and areas at the end of the step. Counts points that change their cell.
template <int Dim, class Real, class Device>
struct MoveLaneSurfacePoints {
  CellLanes<Dim, Real, Device> lanes;
  LaneNodes<Dim, Real, Device> nodes;
  LaneSurfacePoints<Dim, Real, Device> points;
  UniformGrid<Dim, Real> grid;
  PositionVelocity position_velocity;

  KOKKOS_FUNCTION void operator()(int run, int& crossing) const {
    const int cell = points.run_cell(run);
    int node[1 << Dim];
    lanes.nodes_of_cell(cell / lanes.box.cells[0], cell % lanes.box.cells[0], node);
    CellPolynomial<Dim, Real> dx[Dim], u[Dim];
    for (int i = 0; i < Dim; ++i) {
      gather(nodes.remapped_column + i, node, u[i]);
      if (position_velocity == PositionVelocity::grid)
        gather(nodes.displacement_column + i, node, dx[i]);
      else
        dx[i] = grid.inverse_spacing[i] * grid.spacing[0] * u[i];
      coefficients_from_nodes<Dim>(u[i]);
    }
    for (int n = points.run_first(run); n < points.run_first(run + 1); ++n)
      if (move(points.order(n), dx, u)) ++crossing;
  }
  KOKKOS_FUNCTION void gather(int column, const int (&node)[1 << Dim], CellPolynomial<Dim, Real>& c) const {
    for (int a = 0; a < 1 << Dim; ++a) c[a] = node[a] < 0 ? Real(0) : *nodes.at(column, node[a]);
  }
  KOKKOS_FUNCTION bool move(int b, const CellPolynomial<Dim, Real> (&dx)[Dim],
                            const CellPolynomial<Dim, Real> (&u)[Dim]) const {
    if (points.carrier(b) == carried_by_none) return false;
    auto cell = points.cell_of(b);
    auto xi = points.xi_of(b);
    Matrix<Dim, Real> L;  // dt L
    static_for<Dim>([&](auto i) VSB_UNROLLED {
      static_for<Dim>([&](auto j) VSB_UNROLLED {
        L(i, j) = derivative_at<j, Dim>(u[i], xi) * (grid.inverse_spacing[j] * grid.spacing[0]);
      });
    });
    const auto area = cofactor(deformation_increment(L, Real(1))) * points.area_of(b);
    const CornerFunctions<Dim, Real> N(xi);
    Vector<Dim, Real> moved;
    for (int i = 0; i < Dim; ++i) moved[i] = xi[i] + N.interpolate(dx[i]);
    const bool leaves = to_next_cell(grid, cell, moved);
    for (int i = 0; i < Dim; ++i) {
      points.area(b, i) = area[i];
      points.xi(b, i) = moved[i];
      points.cell(b, i) = cell[i];
    }
    return leaves;
  }
};

/// One layer: the forces of its points, cell by cell, to its lower and upper sums.
template <class Field, int Dim, class Real, class Device>
struct LoadLaneSurface {
  CellLanes<Dim, Real, Device> lanes;
  LaneNodes<Dim, Real, Device> nodes;
  LaneSurfacePoints<Dim, Real, Device> points;
  UniformGrid<Dim, Real> grid;
  Field virtual_stress;

  KOKKOS_FUNCTION void operator()(int layer) const {
    const int per_layer = CellNumbering<Dim>{lanes.box.cells}.cell_count() / lanes.layers();
    for (int run = first_from(layer * per_layer); run < points.runs; ++run) {
      if (points.run_cell(run) >= (layer + 1) * per_layer) return;
      load(run);
    }
  }
  /// The first run in a cell of this number or a higher one.
  KOKKOS_FUNCTION int first_from(int cell) const {
    int low = 0, high = points.runs;
    while (low < high) {
      const int middle = (low + high) / 2;
      if (points.run_cell(middle) < cell)
        low = middle + 1;
      else
        high = middle;
    }
    return low;
  }
  KOKKOS_FUNCTION void load(int run) const {
    Vector<(1 << Dim), Real> f[Dim];
    for (auto& at_nodes : f) at_nodes = Vector<(1 << Dim), Real>::zero();
    for (int n = points.run_first(run); n < points.run_first(run + 1); ++n) {
      const int b = points.order(n);
      const auto xi = points.xi_of(b);
      const auto x = grid.map(points.cell_of(b), xi).x;
      const auto force = virtual_stress.at(x, points.tractions(b)).stress * points.area_of(b);
      const CornerFunctions<Dim, Real> N(xi);
      for (int i = 0; i < Dim; ++i) N.add(f[i], force[i]);
    }
    int node[1 << Dim];
    const int cell = points.run_cell(run);
    lanes.nodes_of_cell(cell / lanes.box.cells[0], cell % lanes.box.cells[0], node);
    for (int a = 0; a < 1 << Dim; ++a) {
      if (node[a] < 0) continue;  // without mass
      for (int i = 0; i < Dim; ++i) *nodes.at(nodes.sum_column(1 + Dim + i, a), node[a]) += f[i][a];
    }
  }
};

}  // namespace kernel

/// Surface points of a grid, ready for cell lanes.
template <class Exec, int Dim, class Real, class Device>
LaneSurfacePoints<Dim, Real, Device> pack_surface_points(const Exec& exec,
                                                         const SurfacePoints<Dim, Real, Device>& from,
                                                         const UniformGrid<Dim, Real>& grid) {
  const auto n = static_cast<size_t>(from.count());
  LaneSurfacePoints<Dim, Real, Device> points;
  points.cell = decltype(points.cell)("vsb::lane_surface_cell", n);
  points.xi = decltype(points.xi)("vsb::lane_surface_xi", n, Dim);
  points.area = decltype(points.area)("vsb::lane_surface_area", n, Dim);
  points.tractions = decltype(points.tractions)("vsb::lane_surface_tractions", n);
  points.carrier = decltype(points.carrier)("vsb::lane_surface_carrier", n);
  Kokkos::parallel_for("vsb::pack_surface_points", Kokkos::RangePolicy<Exec>(exec, 0, from.count()),
                       kernel::PackSurfacePoint<Dim, Real, Device>{from, points, grid});
  return points;
}

/// Writes positions and areas back.
template <class Exec, int Dim, class Real, class Device>
void unpack_surface_points(const Exec& exec, const LaneSurfacePoints<Dim, Real, Device>& points,
                           const UniformGrid<Dim, Real>& grid, const SurfacePoints<Dim, Real, Device>& to) {
  Kokkos::parallel_for("vsb::unpack_surface_points", Kokkos::RangePolicy<Exec>(exec, 0, points.count()),
                       kernel::UnpackSurfacePoint<Dim, Real, Device>{points, to, grid});
}

/// Sorts the points by the cells of the lanes' box, where they or the box are others than before. Returns -1,
/// or the lowest number of a point outside the grid.
template <class Exec, int Dim, class Real, class Device>
int sort_surface_points(const Exec& exec, const LaneMemory<Dim, Real, Device>& m,
                        LaneSurfacePoints<Dim, Real, Device>& points) {
  const auto& box = m.lanes.box;
  for (int i = 0; i < Dim; ++i)
    points.sorted =
        points.sorted && points.box.first[i] == box.first[i] && points.box.cells[i] == box.cells[i];
  if (points.sorted) return -1;
  const auto n = static_cast<size_t>(points.count()),
             cells = static_cast<size_t>(CellNumbering<Dim>{box.cells}.cell_count());
  using Ints = typename LaneSurfacePoints<Dim, Real, Device>::Ints;
  if (points.order.extent(0) != n) {
    points.order = Ints("vsb::lane_surface_order", n);
    points.run_cell = Ints("vsb::lane_surface_runs", n);
    points.run_first = Ints("vsb::lane_surface_run_first", n + 1);
  }
  if (points.cell_count.extent(0) != cells + 1)
    points.cell_count = Ints("vsb::lane_surface_cells", cells + 1);
  points.box = box;
  int lost = 0;
  points.runs = 0;
  Kokkos::parallel_reduce("vsb::sort_surface_points", Kokkos::RangePolicy<Exec>(exec, 0, 1),
                          kernel::SortSurfacePoints<Dim, Real, Device>{points, m.grid}, points.runs, lost);
  exec.fence();
  if (lost < 0) return points.count() + lost;
  points.sorted = true;
  return -1;
}

/// Moves the points by the nodal increments of the step. To be called before particles change their lanes;
/// particles may have been moved already. Waits for the device. Does nothing without points.
template <class Exec, int Dim, class Real, class Device>
void move_surface_points(const Exec& exec, const LaneMemory<Dim, Real, Device>& m,
                         LaneSurfacePoints<Dim, Real, Device>& points, PositionVelocity position_velocity) {
  if (points.count() == 0) return;
  sort_surface_points(exec, m, points);
  int crossing = 0;
  Kokkos::parallel_reduce(
      "vsb::move_lane_surface", Kokkos::RangePolicy<Exec>(exec, 0, points.runs),
      kernel::MoveLaneSurfacePoints<Dim, Real, Device>{m.lanes, m.nodes, points, m.grid, position_velocity},
      crossing);
  exec.fence();
  if (crossing > 0) points.sorted = false;
}

/// Adds the tractions on the points to the nodes' sums. Returns -1, or the lowest number of a point outside
/// the grid, and then adds nothing. Does nothing where there are no points.
template <class Exec, class Field, int Dim, class Real, class Device>
int add_surface_tractions(const Exec& exec, const LaneMemory<Dim, Real, Device>& m,
                          LaneSurfacePoints<Dim, Real, Device>& points, const Field& virtual_stress) {
  if (points.count() == 0) return -1;
  const int lost = sort_surface_points(exec, m, points);
  if (lost >= 0) return lost;
  Kokkos::parallel_for(
      "vsb::load_lane_surface", Kokkos::RangePolicy<Exec>(exec, 0, m.lanes.layers()),
      kernel::LoadLaneSurface<Field, Dim, Real, Device>{m.lanes, m.nodes, points, m.grid, virtual_stress});
  return -1;
}

}  // namespace vsb
