// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Tractions on surface points beside cell lanes (Eqs. 12, 13; see kernels/surface_traction.hpp):
///   f_I <- f_I + sum_b N_I(x_b) sbar(x_b) a_b,   a_b <- cof(I + dt L) a_b,
/// cell by cell: the points of a cell share its polynomials of dt v and dt v*, and their forces are summed up
/// as moments.
///
/// Reads the increments that the nodes bring to the particles; writes the force of the nodes' sums, each
/// layer its own, and places and areas of the points.
#pragma once

#include <vsb/kernels/build_lanes.hpp>
#include <vsb/kernels/surface_traction.hpp>
#include <vsb/physics/cell_polynomial.hpp>
#include <vsb/physics/next_cell.hpp>
#include <vsb/views/lane_surface_points.hpp>

namespace vsb {

namespace kernel {

/// One point: from its position in the grid; one outside it gets a cell outside.
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

/// Points by the cells of a box, as locate_particles asks for them.
template <int Dim, class Real, class Device>
struct CellsOfPoints {
  LaneSurfacePoints<Dim, Real, Device> points;
  KOKKOS_FUNCTION int count() const { return points.count(); }
  KOKKOS_FUNCTION Vector<Dim, int> position_of(int b) const { return points.cell_of(b); }
};
template <int Dim>
struct BinsOfBox {
  CellNumbering<Dim> grid;
  CellBox<Dim> box;

  KOKKOS_FUNCTION bool contains(const Vector<Dim, int>& cell) const {
    for (int i = 0; i < Dim; ++i)
      if (cell[i] < 0 || cell[i] >= grid.cells[i]) return false;
    return true;
  }
  KOKKOS_FUNCTION int bin(const Vector<Dim, int>& cell) const {
    const CellNumbering<Dim> in_box{box.cells};
    Vector<Dim, int> c;
    for (int i = 0; i < Dim; ++i) {
      c[i] = cell[i] - box.first[i];
      if (c[i] < 0 || c[i] >= box.cells[i]) return in_box.cell_count();
    }
    return in_box.cell_index(c);
  }
};

/// Where the lanes keep the nodes of a cell, numbered as in multilinear.hpp; -1 where they do not.
template <int Dim, class Real, class Device>
KOKKOS_INLINE_FUNCTION void nodes_of_cell(const CellLanes<Dim, Real, Device>& lanes,
                                          const Vector<Dim, int>& cell, int (&node)[1 << Dim]) {
  for (int a = 0; a < 1 << Dim; ++a) {
    auto ijk = cell;
    for (int i = 0; i < Dim; ++i) ijk[i] += a >> i & 1;
    node[a] = lanes.node_at(ijk);
  }
}

/// The points of one cell: places and areas at the end of the step. Counts those that go to another cell.
template <int Dim, class Real, class Device>
struct MoveLaneSurfacePoints {
  CellLanes<Dim, Real, Device> lanes;
  LaneNodes<Dim, Real, Device> nodes;
  LaneSurfacePoints<Dim, Real, Device> points;
  UniformGrid<Dim, Real> grid;

  KOKKOS_FUNCTION void operator()(int s, int& leaving) const {
    const auto& bins = points.bins;
    const int bin = bins.occupied(s), begin = bins.offset(bin), end = bins.offset(bin + 1);
    int node[1 << Dim];
    nodes_of_cell(lanes, points.cell_of(bins.order(begin)), node);
    bool active = false;  // points outside the box have no such node
    for (int a = 0; a < 1 << Dim; ++a) active = active || node[a] >= 0;
    if (!active) return;
    CellPolynomial<Dim, Real> dx[Dim], u[Dim];
    for (int i = 0; i < Dim; ++i) {
      gather(nodes.displacement_column + i, node, dx[i]);
      gather(nodes.remapped_column + i, node, u[i]);
    }
    for (int n = begin; n < end; ++n)
      if (move(bins.order(n), dx, u)) ++leaving;
  }
  KOKKOS_FUNCTION void gather(int column, const int (&node)[1 << Dim], CellPolynomial<Dim, Real>& c) const {
    for (int a = 0; a < 1 << Dim; ++a) c[a] = node[a] < 0 ? Real(0) : *nodes.at(column, node[a]);
    coefficients_from_nodes<Dim>(c);
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
    Vector<Dim, Real> moved;
    for (int i = 0; i < Dim; ++i) moved[i] = xi[i] + value_at<Dim>(dx[i], xi);
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
    const auto& bins = points.bins;
    const int per_layer = CellNumbering<Dim>{lanes.box.cells}.cell_count() / lanes.layers();
    for (int s = first_from(layer * per_layer); s < bins.occupied_count; ++s) {
      const int bin = bins.occupied(s);
      if (bin >= (layer + 1) * per_layer) return;
      load(bins.offset(bin), bins.offset(bin + 1));
    }
  }
  /// The first occupied bin of those from `bin` on.
  KOKKOS_FUNCTION int first_from(int bin) const {
    int low = 0, high = points.bins.occupied_count;
    while (low < high) {
      const int middle = (low + high) / 2;
      if (points.bins.occupied(middle) < bin)
        low = middle + 1;
      else
        high = middle;
    }
    return low;
  }
  KOKKOS_FUNCTION void load(int begin, int end) const {
    const auto cell = points.cell_of(points.bins.order(begin));
    CellPolynomial<Dim, Real> f[Dim];
    for (auto& moments : f) moments = CellPolynomial<Dim, Real>::zero();
    for (int n = begin; n < end; ++n) {
      const int b = points.bins.order(n);
      const auto xi = points.xi_of(b);
      const auto bar = virtual_stress.at(grid.map(cell, xi).x, points.tractions(b)).stress;
      const auto force = bar * points.area_of(b);
      for (int i = 0; i < Dim; ++i) add_moments<Dim>(f[i], force[i], xi);
    }
    for (auto& moments : f) nodes_from_moments<Dim>(moments);
    int node[1 << Dim];
    nodes_of_cell(lanes, cell, node);
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
    if (points.box.first[i] != box.first[i] || points.box.cells[i] != box.cells[i]) points.sorted = false;
  if (points.sorted) return -1;
  const int bins = CellNumbering<Dim>{box.cells}.cell_count() + 1;
  if (static_cast<int>(points.bins.slot.extent(0)) != bins)
    points.bins = allocate_bins<Device>(points.count(), bins);
  points.box = box;
  const auto where = locate_particles(exec, kernel::CellsOfPoints<Dim, Real, Device>{points}, points.bins,
                                      kernel::BinsOfBox<Dim>{m.grid, box});
  if (where.lost >= 0) return where.lost;
  if (where.changed) sort_by_bin(exec, points.bins);
  points.sorted = true;
  return -1;
}

/// Moves the points by the increments of the step that the nodes have made; particles may have gone ahead,
/// but not to other lanes. Waits for the device. Does nothing where there are no points.
template <class Exec, int Dim, class Real, class Device>
void move_surface_points(const Exec& exec, const LaneMemory<Dim, Real, Device>& m,
                         LaneSurfacePoints<Dim, Real, Device>& points) {
  if (points.count() == 0) return;
  sort_surface_points(exec, m, points);
  int leaving = 0;
  Kokkos::parallel_reduce(
      "vsb::move_lane_surface", Kokkos::RangePolicy<Exec>(exec, 0, points.bins.occupied_count),
      kernel::MoveLaneSurfacePoints<Dim, Real, Device>{m.lanes, m.nodes, points, m.grid}, leaving);
  exec.fence();
  if (leaving > 0) points.sorted = false;
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
