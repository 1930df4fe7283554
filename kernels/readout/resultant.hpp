// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Resultant force and torque of tractions: the sum of their forces over all nodes, those with prescribed
/// components and ghost nodes beyond walls included. Of virtual stresses, Eq. (27), Eq. (28),
///   R = sum_p V_p sum_I chi_I (sbar . grad N_Ip + N_Ip fbar) - (the part of the faces of the grid).
/// The sum is the integral of a divergence, and so that of chi sbar . n over the whole surface of the
/// particles, chi = sum_I chi_I N_I. Where the body stands on a face of the grid, this surface includes the
/// face, at which no traction is meant. The part of the sum from pieces w of the face,
///   sum_w A_w sum_I chi_I N_I(x_w) sbar . n,
/// is removed in the components that the face prescribes, since the face takes it up. In free components it
/// loads the body, and stays in R.
///
/// A particle stands on a face if it is closer to it than the edge of a cube of its volume. It covers the
/// area A_w = V_p / (2 d) at the distance d, as the box around it does. The caller sets the area (FaceCover)
/// of particles of another shape: flat ones, or shares of boxes that a surface cuts. The whole cells of the
/// original method (kernels/particles/original_virtual_stress.hpp) have a part of the faces too. A surface
/// point adds sbar . a.
///
/// Reads particles, surface points and the marks of Algorithm 1. Sums have a fixed order.
#pragma once

#include <vsb/kernels/particles/ordered_sum.hpp>
#include <vsb/kernels/step.hpp>
#include <vsb/physics/mapped_grid.hpp>

namespace vsb {

/// The resultant of tractions over all nodes, without the faces of the grid; the equations are at the top of
/// this file.
template <int Dim>
struct TractionResultant {
  Vector<Dim, double> force;  ///< N
  Vector<3, double> torque;   ///< about the origin, N m; in 1D zero, in 2D along z
};

/// [particle][axis]: the area of a face of the grid across an axis that a particle covers, in units of
/// V_p / (2 d). 0: it does not stand on the face. Below 0, and where the array is empty: as the box around
/// it.
template <class Device>
using FaceCover = Kokkos::View<const float**, Device>;

namespace kernel {

/// Force, then torque.
template <int Dim>
using ResultantSums = Vector<Dim + 3, double>;

/// Adds a force f at x.
template <int Dim, class Real>
KOKKOS_FUNCTION void add_force(const Vector<Dim, Real>& position, const Vector<Dim, Real>& f,
                               ResultantSums<Dim>& sum) {
  auto x = Vector<3, double>::zero(), force = x;
  for (int i = 0; i < Dim; ++i) {
    x[i] = static_cast<double>(position[i]);
    force[i] = static_cast<double>(f[i]);
    sum[i] += force[i];
  }
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    sum[Dim + i] += x[j] * force[k] - x[k] * force[j];
  }
}

/// Adds the forces of the tractions in `among` at the nodes of a particle. position(a): the position of
/// support node a.
template <class Shape, class Field, class Boundary, class Position, int Dim, class Real>
KOKKOS_FUNCTION void add_traction(const Shape& shape, const Vector<Dim, Real>& x, Real V, const Field& field,
                                  TractionMask among, const Boundary& boundary, const Position& position,
                                  ResultantSums<Dim>& sum) {
  TractionMask any = 0;
  for (int a = 0; a < Shape::support; ++a) any |= boundary(shape.node[a]);
  if ((any & among) == 0) return;
  const TractionMask acting = field.acting_at(x) & among;
  TractionMask chi = 0;
  auto bar = VirtualStressValue<Dim, Real>::zero();
  for (int a = 0; a < Shape::support; ++a) {
    const TractionMask here = boundary(shape.node[a]) & acting;
    if (here == 0) continue;
    if (here != chi) bar = field.at(x, here);
    chi = here;
    add_force(position(a), V * (bar.stress * shape.dN[a] + shape.N[a] * bar.divergence), sum);
  }
}

/// A piece of a face of the grid that a body covers.
template <int Dim, class Real>
struct CoveredFace {
  Vector<Dim, Real> x;     ///< its middle, m
  Vector<Dim, Real> area;  ///< times the normal out of the grid, m^(Dim - 1)
};

/// Removes the part of such a piece from the sum. fixed(a): the components that the face prescribes at
/// support node a of `shape`, the basis functions at piece.x.
template <class Shape, class Field, class Boundary, class Fixed, class Position, int Dim, class Real>
KOKKOS_FUNCTION void take_out_support(const Shape& shape, const CoveredFace<Dim, Real>& piece,
                                      const Field& field, TractionMask acting, const Boundary& boundary,
                                      const Fixed& fixed, const Position& position, ResultantSums<Dim>& sum) {
  for (int a = 0; a < Shape::support; ++a) {
    const TractionMask chi = boundary(shape.node[a]) & acting;
    const ComponentMask components = fixed(a);
    if (chi == 0 || components == 0) continue;
    auto force = -shape.N[a] * (field.at(piece.x, chi).stress * piece.area);
    for (int i = 0; i < Dim; ++i)
      if ((components >> i & 1) == 0) force[i] = Real(0);
    add_force(position(a), force, sum);
  }
}

/// Row p, column `axis` of a FaceCover.
template <class Real, class Device>
KOKKOS_FUNCTION Real cover_of(const FaceCover<Device>& cover, int p, int axis) {
  return cover.size() == 0 ? Real(-1)
                           : static_cast<Real>(cover(static_cast<size_t>(p), static_cast<size_t>(axis)));
}

/// The area that a particle of volume V covers at the distance d from a face; 0 where it does not stand on
/// it.
template <int Dim, class Real>
KOKKOS_FUNCTION Real covered_area(Real V, Real d, Real cover) {
  if (cover >= Real(0)) return d > Real(0) ? cover * V / (2 * d) : Real(0);
  Real cube = 1;
  for (int i = 0; i < Dim; ++i) cube *= d;
  if (!(cube < V)) return Real(0);
  const Real edge = Dim == 1 ? V : Dim == 2 ? math::sqrt(V) : math::exp(math::log(V) / Real(3));
  return V / math::max(2 * d, edge / 4);
}

/// Finds the piece that a particle covers of the face of the scene's grid at the end `side` of an axis.
/// `grid` has `ghost_layers` layers of ghost cells outside that face. Returns false where the particle does
/// not stand on it.
template <int Dim, class Real>
KOKKOS_FUNCTION bool find_covered(const UniformGrid<Dim, Real>& grid, int ghost_layers,
                                  const Vector<Dim, Real>& x, Real V, Real cover, int axis, int side,
                                  CoveredFace<Dim, Real>& piece) {
  const int node = side == 0 ? ghost_layers : grid.cells[axis] - ghost_layers;
  const Real face = grid.lower[axis] + static_cast<Real>(node) * grid.spacing[axis];
  const Real area = covered_area<Dim>(V, side == 0 ? x[axis] - face : face - x[axis], cover);
  if (!(area > Real(0))) return false;
  piece.x = x;
  piece.x[axis] = face;
  piece.area = Vector<Dim, Real>::zero();
  piece.area[axis] = side == 0 ? -area : area;
  return true;
}

/// The direction out of a cell at its face, of unit length.
template <int Dim, class Real>
KOKKOS_FUNCTION Vector<Dim, Real> face_normal(const Matrix<Dim, Real>& J, int axis, int side) {
  const auto inverse_J = inverse(J);
  Vector<Dim, Real> n;
  Real square = 0;
  for (int i = 0; i < Dim; ++i) {
    n[i] = side == 0 ? -inverse_J(axis, i) : inverse_J(axis, i);
    square += n[i] * n[i];
  }
  return (Real(1) / math::sqrt(square)) * n;
}

template <int Dim, class Real>
KOKKOS_FUNCTION bool find_covered(const MappedGrid<Dim, Real>& grid, int, const Vector<Dim, Real>& x, Real V,
                                  Real cover, int axis, int side, CoveredFace<Dim, Real>& piece) {
  auto location = grid.locate(x);
  if (location.cell[axis] != (side == 0 ? 0 : grid.cells[axis] - 1)) return false;
  const Real away = side == 0 ? location.xi[axis] : Real(1) - location.xi[axis];
  if (!(away > Real(0))) return false;
  location.xi[axis] = static_cast<Real>(side);
  const auto cell = grid.cell(location.cell);
  const auto at = cell.at(location.xi);
  const auto n = face_normal(at.J, axis, side);
  const Real d = dot(at.x - x, n);
  Real area = 0;
  if (cover < Real(0)) {  // a cube in local coordinates, since cells may be far longer than wide
    const Real share = V / cell.volume();
    area = covered_area<Dim>(share, away, cover) * V * away / (share * d);
  } else {
    area = covered_area<Dim>(V, d, cover);
  }
  // The foot of the perpendicular on the face. Grid lines may meet the face at an angle, as chords of arcs
  // do.
  const auto foot = x + d * n;
  piece = {grid.contains(foot) ? foot : at.x, area * n};
  return area > Real(0);
}

/// The components that a face of the grid prescribes at a node.
template <class Basis, int Dim, class Real, class Device>
struct FixedAtFace {
  Basis basis;
  Nodes<Dim, Real, Device> nodes;
  KOKKOS_FUNCTION ComponentMask operator()(int node, int axis, int side) const {
    if constexpr (Basis::ghost_layers > 0)
      return basis.walls.fixed[axis][side];
    else
      return nodes.fixed_components(node);
  }
};

/// One particle: the forces of the virtual stress methods at its nodes, without the part of the faces.
template <class Basis, class Field, int Dim, class Real, class Device>
struct ParticleResultant {
  Particles<Dim, Real, Device> particles;
  Basis basis;
  FixedAtFace<Basis, Dim, Real, Device> fixed;
  BoundaryNodes<Device> boundary;
  Field virtual_stress;
  TractionMask among;
  FaceCover<Device> cover;

  KOKKOS_FUNCTION void operator()(int p, ResultantSums<Dim>& sum) const {
    const auto x = particles.position_of(p);
    const Real V = particles.volume(p);
    const auto shape = basis.shape(x);
    add_traction(
        shape, x, V, virtual_stress, among, boundary,
        [&](int a) { return basis.grid.node_position(shape.node[a]); }, sum);
    for (int axis = 0; axis < Dim; ++axis)
      for (int side = 0; side < 2; ++side) {
        CoveredFace<Dim, Real> piece;
        if (!find_covered(basis.grid, Basis::ghost_layers, x, V, cover_of<Real>(cover, p, axis), axis, side,
                          piece))
          continue;
        const auto there = basis.shape(piece.x);
        take_out_support(
            there, piece, virtual_stress, virtual_stress.acting_at(x) & among, boundary,
            [&](int a) { return fixed(there.node[a], axis, side); },
            [&](int a) { return basis.grid.node_position(there.node[a]); }, sum);
      }
  }
};

/// One node: its force.
template <class Grid, int Dim, class Real, class Device>
struct NodeForce {
  Grid grid;
  Nodes<Dim, Real, Device> nodes;
  KOKKOS_FUNCTION void operator()(int I, ResultantSums<Dim>& sum) const {
    Vector<Dim, Real> f;
    for (int i = 0; i < Dim; ++i) f[i] = nodes.force(I, i);
    add_force(grid.node_position(I), f, sum);
  }
};

/// One cell: the part of the faces of the grid in the sums over whole boundary cells of the original method.
/// These sums are subtracted, and so the sign is the opposite.
template <class Basis, class Field, int Dim, class Real, class Device>
struct WholeCellsAtFaces {
  Basis basis;
  FixedAtFace<Basis, Dim, Real, Device> fixed;
  BoundaryNodes<Device> boundary;
  Field virtual_stress;

  KOKKOS_FUNCTION void operator()(int c, ResultantSums<Dim>& sum) const {
    const auto cell = basis.grid.cell_ijk(c);
    if (!virtual_stress.is_boundary(cell)) return;
    for (int axis = 0; axis < Dim; ++axis)
      for (int side = 0; side < 2; ++side)
        if (cell[axis] == (side == 0 ? 0 : basis.grid.cells[axis] - 1)) add_face(cell, axis, side, sum);
  }
  KOKKOS_FUNCTION void add_face(const Vector<Dim, int>& cell, int axis, int side,
                                ResultantSums<Dim>& sum) const {
    const GaussPoints<Real> gauss(virtual_stress.gauss_points);
    int points = 1;
    for (int i = 1; i < Dim; ++i) points *= gauss.count;
    for (int g = 0; g < points; ++g) {
      Vector<Dim, Real> xi;
      Real weight = 1;
      xi[axis] = static_cast<Real>(side);
      for (int i = 1, k = g; i < Dim; ++i, k /= gauss.count) {
        xi[(axis + i) % Dim] = gauss.point[k % gauss.count];
        weight *= gauss.weight[k % gauss.count];
      }
      // Nanson: the area of a face of the cell is det J J^-T times that of the unit cube.
      const auto J = jacobian(basis.grid, cell, xi);
      const auto point = basis.grid.map(cell, xi);
      const auto inverse_J = inverse(J);
      CoveredFace<Dim, Real> piece{point.x, {}};
      for (int i = 0; i < Dim; ++i)
        piece.area[i] = (side == 0 ? Real(1) : Real(-1)) * weight * point.volume_ratio * inverse_J(axis, i);
      const auto shape = basis.shape(piece.x);
      take_out_support(
          shape, piece, virtual_stress, virtual_stress.original, boundary,
          [&](int a) { return fixed(shape.node[a], axis, side); },
          [&](int a) { return basis.grid.node_position(shape.node[a]); }, sum);
    }
  }

 private:
  KOKKOS_FUNCTION static Matrix<Dim, Real> jacobian(const UniformGrid<Dim, Real>& grid,
                                                    const Vector<Dim, int>&, const Vector<Dim, Real>&) {
    auto J = Matrix<Dim, Real>::zero();
    for (int i = 0; i < Dim; ++i) J(i, i) = grid.spacing[i];
    return J;
  }
  KOKKOS_FUNCTION static Matrix<Dim, Real> jacobian(const MappedGrid<Dim, Real>& grid,
                                                    const Vector<Dim, int>& cell,
                                                    const Vector<Dim, Real>& xi) {
    return grid.cell(cell).at(xi).J;
  }
};

/// One surface point.
template <class Field, int Dim, class Real, class Device>
struct SurfacePointResultant {
  SurfacePoints<Dim, Real, Device> points;
  Field virtual_stress;
  TractionMask among;
  KOKKOS_FUNCTION void operator()(int b, ResultantSums<Dim>& sum) const {
    const auto x = points.position_of(b);
    add_force(x, virtual_stress.at(x, points.tractions(b) & among).stress * points.area_of(b), sum);
  }
};

}  // namespace kernel

/// The resultant of the tractions in `among`. The occupancy must be up to date. Waits for the device.
template <class Exec, class Basis, class Field, int Dim, class Real, class Device>
TractionResultant<Dim> resultant(const Exec& exec, const State<Dim, Real, Device>& s, const Basis& basis,
                                 const Field& virtual_stress, TractionMask among = ~TractionMask(0),
                                 const FaceCover<Device>& cover = {}) {
  auto total = kernel::ResultantSums<Dim>::zero();
  const auto add = [&](const char* label, int count, const auto& term) {
    if (count > 0) total += ordered_sum<kernel::ResultantSums<Dim>::size, Device>(exec, label, count, term);
  };
  const kernel::FixedAtFace<Basis, Dim, Real, Device> fixed{basis, s.nodes};
  const auto& boundary = s.occupancy.boundary;
  if constexpr (Field::loaded)
    add("vsb::particle_resultant", s.particles.count(),
        kernel::ParticleResultant<Basis, Field, Dim, Real, Device>{s.particles, basis, fixed, boundary,
                                                                   virtual_stress, among, cover});
  if constexpr (Field::cell_quadrature) {
    auto field = virtual_stress;
    field.original &= among;
    auto cells = s.nodes;
    cells.sums = typename Nodes<Dim, Real, Device>::Fields("vsb::cell_sums", s.nodes.sums.extent(0),
                                                           Nodes<Dim, Real, Device>::sum_columns);
    subtract_cell_virtual_stress(exec, cells, boundary, basis, field);
    add("vsb::node_forces", cells.count(),
        kernel::NodeForce<decltype(basis.grid), Dim, Real, Device>{basis.grid, cells});
    add("vsb::whole_cells_at_faces", basis.grid.cell_count(),
        kernel::WholeCellsAtFaces<Basis, Field, Dim, Real, Device>{basis, fixed, boundary, field});
  }
  if constexpr (!std::is_same_v<Field, NoVirtualStress>)
    add("vsb::surface_point_resultant", s.surface.count(),
        kernel::SurfacePointResultant<Field, Dim, Real, Device>{s.surface, virtual_stress, among});
  TractionResultant<Dim> result;
  for (int i = 0; i < Dim; ++i) result.force[i] = total[i];
  for (int i = 0; i < 3; ++i) result.torque[i] = total[Dim + i];
  return result;
}

}  // namespace vsb
