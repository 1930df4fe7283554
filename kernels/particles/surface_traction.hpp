// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Tractions on surface points: material points of the outermost layer, massless boundary particles, or nodes
/// of a conforming boundary, Eq. (12), Eq. (13),
///   f_I <- f_I + sum_b N_I(x_b) sbar(x_b) a_b,   a_b = A_b n_b,   sbar . n = t.
/// The points move with their carrier. Areas follow Nanson's formula,
///   a_b <- cof(F) a_b = det(F) F^-T a_b,   F = I + dt L,
/// step by step. The cofactor of a product is the product of the cofactors, so that no total deformation
/// gradient is stored.
///
/// Reads nodal velocities and particle positions; writes nodal forces, and forces, positions and areas of the
/// points.
#pragma once

#include <vsb/kernels/particles/locate_particles.hpp>
#include <vsb/kernels/particles/scatter.hpp>
#include <vsb/physics/kinematics.hpp>
#include <vsb/views/nodes.hpp>
#include <vsb/views/surface_points.hpp>

namespace vsb {

namespace kernel {

/// One point: sbar a. A kernel of its own, so that the scatter of the forces is one instance for all fields.
template <class Field, int Dim, class Real, class Device>
struct LoadSurfacePoint {
  SurfacePoints<Dim, Real, Device> points;
  Field virtual_stress;

  KOKKOS_FUNCTION void operator()(int b) const {
    const auto x = points.position_of(b);
    const auto force = virtual_stress.at(x, points.tractions(b)).stress * points.area_of(b);
    for (int i = 0; i < Dim; ++i) points.force(b, i) = force[i];
  }
};

/// The nodal forces of one point.
template <class Basis, int Dim, class Real, class Device>
struct SurfaceForce {
  static constexpr int columns = Dim;
  SurfacePoints<Dim, Real, Device> points;
  Basis basis;

  template <class Sink>
  KOKKOS_FUNCTION void operator()(int b, const Sink& sink) const {
    const auto force = points.force_of(b);
    const auto shape = basis.shape(points.position_of(b));
    for (int a = 0; a < Basis::support; ++a)
      for (int i = 0; i < Dim; ++i) sink(a, shape.node[a], i) += shape.N[a] * force[i];
  }
};

template <int Dim, class Real, class Device>
struct AddSurfaceForce {
  Nodes<Dim, Real, Device> nodes;
  typename Nodes<Dim, Real, Device>::Fields surface_force;
  KOKKOS_FUNCTION void operator()(int I) const {
    for (int i = 0; i < Dim; ++i) nodes.force(I, i) += surface_force(I, i);
  }
};

/// One point: its position and area at the end of the step. Called after the particles moved.
template <class Basis, int Dim, class Real, class Device>
struct MoveSurfacePoint {
  SurfacePoints<Dim, Real, Device> points;
  Particles<Dim, Real, Device> particles;
  Nodes<Dim, Real, Device> nodes;
  Basis basis;
  PositionVelocity position_velocity;
  Real dt;  ///< s

  KOKKOS_FUNCTION void operator()(int b) const {
    const int carrier = points.carrier(b);
    if (carrier == carried_by_none) return;
    const auto x = points.position_of(b);
    const auto shape = basis.shape(x);
    const auto area =
        cofactor(deformation_increment(shape.gradient(nodes.remapped_velocity), dt)) * points.area_of(b);
    const auto v = shape.interpolate(nodes.velocity_for(position_velocity));
    for (int i = 0; i < Dim; ++i) {
      points.area(b, i) = area[i];
      points.position(b, i) = carrier == carried_by_grid ? x[i] + dt * v[i] : particles.position(carrier, i);
    }
  }
};

}  // namespace kernel

/// Adds the tractions on surface points to the nodal forces. Returns -1, or the lowest number of a point
/// outside the grid, and then adds nothing. Does nothing where there are no points.
template <class Exec, class Basis, class Field, int Dim, class Real, class Device>
int add_surface_tractions(const Exec& exec, SurfacePoints<Dim, Real, Device>& points,
                          const Nodes<Dim, Real, Device>& nodes, ScatterWorkspace<Real, Device>& workspace,
                          const Basis& basis, const Field& virtual_stress, Scatter strategy) {
  if (points.count() == 0) return -1;
  const auto where = locate_particles(exec, points, points.bins, basis);
  if (where.lost >= 0) return where.lost;
  if (where.changed) sort_by_bin(exec, points.bins);
  Kokkos::parallel_for("vsb::load_surface_point", Kokkos::RangePolicy<Exec>(exec, 0, points.count()),
                       kernel::LoadSurfacePoint<Field, Dim, Real, Device>{points, virtual_stress});
  scatter(exec, "vsb::surface_force", strategy, points.count(), basis, points.bins, workspace,
          kernel::SurfaceForce<Basis, Dim, Real, Device>{points, basis}, points.node_force);
  Kokkos::parallel_for("vsb::add_surface_force", Kokkos::RangePolicy<Exec>(exec, 0, nodes.count()),
                       kernel::AddSurfaceForce<Dim, Real, Device>{nodes, points.node_force});
  return -1;
}

/// Moves the surface points at the end of a step of length dt, s.
template <class Exec, class Basis, int Dim, class Real, class Device>
void move_surface_points(const Exec& exec, const SurfacePoints<Dim, Real, Device>& points,
                         const Particles<Dim, Real, Device>& particles, const Nodes<Dim, Real, Device>& nodes,
                         const Basis& basis, PositionVelocity position_velocity, Real dt) {
  if (points.count() == 0) return;
  Kokkos::parallel_for("vsb::move_surface_points", Kokkos::RangePolicy<Exec>(exec, 0, points.count()),
                       kernel::MoveSurfacePoint<Basis, Dim, Real, Device>{points, particles, nodes, basis,
                                                                          position_velocity, dt});
}

}  // namespace vsb
