// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The resultant of kernels/readout/resultant.hpp for particles in cell lanes, of tractions that the sweeps
/// apply.
#pragma once

#include <vsb/kernels/lanes/linear_step.hpp>
#include <vsb/kernels/lanes/spline_step.hpp>
#include <vsb/kernels/readout/resultant.hpp>

namespace vsb {

namespace kernel {

/// A particle in its lane, cells being those of the scene's grid: its nodes and their functions.
template <int Dim, class Real, class Device>
struct LaneParticle {
  static constexpr int support = 1 << Dim;
  const CellLanes<Dim, Real, Device>& lanes;
  const LaneNodes<Dim, Real, Device>& nodes;
  const UniformGrid<Dim, Real>& grid;
  Vector<Dim, int> cell;
  Vector<Dim, Real> xi;
  Shape<Dim, support, Real> shape;

  KOKKOS_FUNCTION void find(const LaneGroup<Dim>& group, int lane) {
    for (int a = 0; a < support; ++a) shape.node[a] = group.node[a >> 1] + lane + (a & 1);
    multilinear(xi, grid.inverse_spacing, shape.N, shape.dN);
  }
  /// Moves the functions to the face of the grid at the end `side` of an axis. Returns false where none of
  /// the nodes lie on that face.
  KOKKOS_FUNCTION bool move_to_face(int axis, int side) {
    if (cell[axis] != (side == 0 ? 0 : grid.cells[axis] - 1)) return false;
    auto there = xi;
    there[axis] = static_cast<Real>(side);
    multilinear(there, grid.inverse_spacing, shape.N, shape.dN);
    return true;
  }
  KOKKOS_FUNCTION Vector<Dim, Real> position(int a) const {
    Vector<Dim, Real> corner;
    for (int i = 0; i < Dim; ++i) corner[i] = static_cast<Real>(a >> i & 1);
    return grid.map(cell, corner).x;
  }
  KOKKOS_FUNCTION ComponentMask fixed(int a, int, int) const {
    const int node = shape.node[a];
    ComponentMask components = 0;
    for (int i = 0; i < Dim; ++i)
      components = static_cast<ComponentMask>(
          components | (nodes.fixed(node / lanes.width, i) >> (node % lanes.width) & 1) << i);
    return components;
  }
};

/// The same with quadratic B-splines; `grid` is the node-centred one.
template <int Dim, class Real, class Device>
struct SplineLaneParticle {
  static constexpr int support = Dim == 1 ? 3 : Dim == 2 ? 9 : 27;
  const CellLanes<Dim, Real, Device>& lanes;
  const Walls<Dim>& walls;
  const UniformGrid<Dim, Real>& grid;
  Vector<Dim, int> cell;  ///< the number of the middle node
  Vector<Dim, Real> xi;
  Shape<Dim, support, Real> shape;
  NodeTriple<Real> f[Dim] = {};

  KOKKOS_FUNCTION void find(const LaneGroup<Dim>& group, int lane) {
    const auto& stencil = lanes.stencils(lanes.number_of(group));
    for (int a = 0; a < support; ++a) shape.node[a] = stencil.node[a / 3] + lane + a % 3;
    for (int i = 0; i < Dim; ++i) {
      f[i] = quadratic_bspline(xi[i] - Real(0.5));
      for (int k = 0; k < 3; ++k) f[i].dN[k] *= grid.inverse_spacing[i];
    }
    multiply_triples(f, shape);
  }
  /// On the face the function of a node on it is 3/4, and 1/8 of a node beside it. Ghosts have the loads of
  /// their images.
  KOKKOS_FUNCTION bool move_to_face(int axis, int side) {
    const int from_middle = (side == 0 ? 0 : grid.cells[axis] - 1) - cell[axis];
    if (from_middle < -1 || from_middle > 1) return false;
    auto there = f[axis];
    if (from_middle == 0) {
      there = quadratic_bspline(Real(0));
    } else {
      there.N[1 - from_middle] = 0;
      there.N[1] = Real(0.25);
      there.N[1 + from_middle] = Real(0.75);
    }
    const auto before = f[axis];
    f[axis] = there;
    multiply_triples(f, shape);
    f[axis] = before;
    return true;
  }
  KOKKOS_FUNCTION Vector<Dim, Real> position(int a) const {
    Vector<Dim, Real> at;
    for (int i = 0, digits = a; i < Dim; ++i, digits /= 3) at[i] = static_cast<Real>(digits % 3) - Real(0.5);
    return grid.map(cell, at).x;
  }
  KOKKOS_FUNCTION ComponentMask fixed(int, int axis, int side) const { return walls.fixed[axis][side]; }
};

/// One group: its particles, one by one. Groups without loaded nodes are skipped. Particle: one of the two
/// types above, with `source` in it.
template <class Particle, class Source, class Field, int Dim, class Real, class Device>
struct LaneResultant {
  CellLanes<Dim, Real, Device> lanes;
  Source source;                 ///< nodes or walls
  UniformGrid<Dim, Real> grid;   ///< whose cells are those of the lanes
  UniformGrid<Dim, Real> scene;  ///< whose faces are those of the scene
  BoundaryNodes<Device> tractions;
  Field virtual_stress;
  TractionMask among;
  FaceCover<Device> cover;

  KOKKOS_FUNCTION void operator()(int g, ResultantSums<Dim>& sum) const {
    const auto& group = lanes.groups(g);
    if (group.load == GroupLoad::none) return;
    for (size_t e = lanes.begin(group); e < lanes.end(group); ++e)
      if (lanes.id(e) >= 0) add(group, e, sum);
  }
  KOKKOS_FUNCTION void add(const LaneGroup<Dim>& group, size_t e, ResultantSums<Dim>& sum) const {
    const int lane = static_cast<int>(e % lanes.width);
    Particle p{lanes, source, grid, lanes.cell(group, lane), {}, {}};
    for (int i = 0; i < Dim; ++i) p.xi[i] = *lanes.at(lanes.xi_column + i, e);
    p.find(group, lane);
    const Real V = *lanes.at(lanes.volume_column, e);
    const auto x = grid.map(p.cell, p.xi).x;
    const auto position = [&](int a) { return p.position(a); };
    add_traction(p.shape, x, V, virtual_stress, among, tractions, position, sum);
    for (int axis = 0; axis < Dim; ++axis)
      for (int side = 0; side < 2; ++side) {
        CoveredFace<Dim, Real> piece;
        const Real covers = cover_of<Real>(cover, lanes.id(e), axis);
        if (!find_covered(scene, 0, x, V, covers, axis, side, piece) || !p.move_to_face(axis, side)) continue;
        take_out_support(
            p.shape, piece, virtual_stress, virtual_stress.acting_at(x) & among, tractions,
            [&](int a) { return p.fixed(a, axis, side); }, position, sum);
      }
  }
};

}  // namespace kernel

namespace detail {

template <class Particle, class Exec, class Source, class Field, int Dim, class Real, class Device>
TractionResultant<Dim> lane_resultant(const Exec& exec, const LaneState<Dim, Real, Device>& s,
                                      const Source& source, const UniformGrid<Dim, Real>& scene,
                                      const Field& field, TractionMask among,
                                      const FaceCover<Device>& cover) {
  TractionResultant<Dim> result{Vector<Dim, double>::zero(), Vector<3, double>::zero()};
  if constexpr (Field::loaded) {
    const auto& m = s.memory;
    const auto sum = ordered_sum<kernel::ResultantSums<Dim>::size, Device>(
        exec, "vsb::lane_resultant", m.lanes.group_count,
        kernel::LaneResultant<Particle, Source, Field, Dim, Real, Device>{
            m.lanes, source, m.grid, scene, s.boundary.tractions, field, among, cover});
    for (int i = 0; i < Dim; ++i) result.force[i] = sum[i];
    for (int i = 0; i < 3; ++i) result.torque[i] = sum[Dim + i];
  }
  return result;
}

}  // namespace detail

///@{
/// The resultant of the tractions in `among` on the particles at their present positions. Waits for the
/// device.
template <class Exec, class Field, int Dim, class Real, class Device>
TractionResultant<Dim> resultant(const Exec& exec, const LaneState<Dim, Real, Device>& s,
                                 const Field& virtual_stress, TractionMask among = ~TractionMask(0),
                                 const FaceCover<Device>& cover = {}) {
  return detail::lane_resultant<kernel::LaneParticle<Dim, Real, Device>>(
      exec, s, s.memory.nodes, s.memory.grid, virtual_stress, among, cover);
}
template <class Exec, class Field, int Dim, class Real, class Device>
TractionResultant<Dim> resultant(const Exec& exec, const SplineLaneState<Dim, Real, Device>& s,
                                 const Field& virtual_stress, TractionMask among = ~TractionMask(0),
                                 const FaceCover<Device>& cover = {}) {
  return detail::lane_resultant<kernel::SplineLaneParticle<Dim, Real, Device>>(
      exec, s, s.memory.walls, s.grid, virtual_stress, among, cover);
}
///@}

}  // namespace vsb
