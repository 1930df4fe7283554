// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// One explicit MUSL step with FLIP velocities and traction boundaries, in the paper's order.
#pragma once

#include <vector>
#include <vsb/kernels/particles/assemble_forces.hpp>
#include <vsb/kernels/particles/grid_to_particles.hpp>
#include <vsb/kernels/particles/remap_velocity.hpp>
#include <vsb/kernels/particles/update_nodes.hpp>
#include <vsb/kernels/particles/update_stress.hpp>

namespace vsb {

/// What a step works on.
template <int Dim, class Real, class Device>
struct State {
  Particles<Dim, Real, Device> particles;       ///< Views of the caller's particles
  Nodes<Dim, Real, Device> nodes;               ///< of the whole grid
  Occupancy<Device> occupancy;                  ///< bins, declared tractions, and the nodes at which they act
  SurfacePoints<Dim, Real, Device> surface;     ///< none, unless a traction is imposed on points
  ForceWorkspace<Real, Device> sums_workspace;  ///< memory of assemble_forces
  ScatterWorkspace<Real, Device> remap_workspace;  ///< memory of remap_velocity
  MeanDivergence<Real, Device> mean_divergence;    ///< empty unless steps average
  bool weighed = false;      ///< whether the particles have been found to have masses and volumes
  bool loads_found = false;  ///< whether the load has been found to act at some node
};

/// Allocates the nodes and the occupancy for given particles. Call it again after particles were added or
/// removed, or their arrays moved.
template <class Basis, int Dim, class Real, class Device>
State<Dim, Real, Device> make_state(const Particles<Dim, Real, Device>& particles, const Basis& basis) {
  particles.check();
  check_grid(basis.grid);
  State<Dim, Real, Device> s;
  s.particles = particles;
  s.nodes = allocate_nodes<Dim, Real, Device>(basis.node_count());
  s.occupancy = allocate_occupancy<Device>(particles.count(), basis);
  return s;
}

/// What stays the same over many steps.
template <int Dim, class Real>
struct StepOptions {
  Real dt = 0;       ///< length of a step, s
  Real damping = 0;  ///< Cundall's alpha, 0 <= alpha < 1
  Real pic = 0;  ///< share of PIC in the velocities of particles, 0 <= eta < 1: takes away what the nodes do
                 ///< not see; a wave of n cells loses pi^2 eta / (2 n kappa) of its amplitude a period
  Vector<Dim, Real> gravity = Vector<Dim, Real>::zero();  ///< body force per mass, m/s^2
  VolumeUpdate volume_update = DeterminantVolume{};       ///< determinant or exponential, see kinematics.hpp
  Scatter scatter = Scatter::gathered;  ///< how sums over particles are made; gathered: the same bits for any
                                        ///< number of threads
  /// Volumetric::averaged: against volumetric locking, see physics/mean_divergence.hpp.
  Volumetric volumetric = Volumetric::full;
  PositionVelocity position_velocity = PositionVelocity::strain;  ///< by which particles move
};

/// Refuses options with which no step can be made.
template <int Dim, class Real>
void check_options(const StepOptions<Dim, Real>& options) {
  if (!(options.dt > Real(0)) || !std::isfinite(options.dt))
    detail::refuse("StepOptions::dt is ", options.dt,
                   " s: set it to a time above 0 (vsb::time_step gives a stable one)");
  if (!(options.damping >= Real(0) && options.damping < Real(1)))
    detail::refuse("StepOptions::damping is ", options.damping, ": set it to 0 or more, below 1");
  if (!(options.pic >= Real(0) && options.pic < Real(1)))
    detail::refuse("StepOptions::pic is ", options.pic, ": set it to 0 or more, below 1");
  for (int i = 0; i < Dim; ++i)
    if (!std::isfinite(options.gravity[i]))
      detail::refuse("StepOptions::gravity is ", options.gravity[i], " m/s^2 in direction ", i);
}

namespace detail {

/// Refuses input that would make a step wrong without any sign of it.
template <class Basis, int Dim, class Real, class Device>
void check_step(const State<Dim, Real, Device>& s, const std::vector<Body<Real>>& bodies, const Basis& basis,
                const StepOptions<Dim, Real>& options) {
  check_options(options);
  s.particles.check();
  check_bodies(bodies, s.particles.count());
  for (const auto& body : bodies) check_material_state(s.particles, body);
  check_rows("State::nodes", s.nodes.sums.extent(0), basis.node_count(),
             "make the state with the basis of the step");
  if (s.surface.count() > 0)
    check_rows("SurfacePoints::node_force", s.surface.node_force.extent(0), basis.node_count(),
               "allocate the surface points with the basis of the step");
}

}  // namespace detail

/// Advances the state by one step; `virtual_stress` is the field at the end of the step. Returns -1 after the
/// step. Where a particle lies outside the grid, returns its lowest number; where a surface point does, that
/// of the point plus the number of particles. Then the step is not made. Throws std::invalid_argument, before
/// anything is changed, where something is missing that a step needs (kernels/preconditions.hpp).
template <class Exec, class Basis, class Field, int Dim, class Real, class Device>
int step(const Exec& exec, State<Dim, Real, Device>& s, const std::vector<Body<Real>>& bodies,
         const Basis& basis, const Field& virtual_stress, const StepOptions<Dim, Real>& options) {
  const ProfilingRegion region("vsb::step");
  require_accessible<Exec, Device>();
  detail::check_step(s, bodies, basis, options);
  if (!s.weighed) check_masses(exec, s.particles);
  s.weighed = true;

  const int lost = update_occupancy(exec, s.particles, s.occupancy, basis);
  if (lost >= 0) return lost;
  check_load(virtual_stress, s.occupancy.declared | s.occupancy.cells.carried.tractions,
             s.surface.count() > 0);
  if constexpr (Field::loaded) {
    if (!s.loads_found && s.surface.count() == 0) check_loaded(s.occupancy.boundary_node_count);
    s.loads_found = true;
  }
  const int lost_point = assemble_forces(exec, s.particles, s.occupancy, s.surface, s.nodes, s.sums_workspace,
                                         basis, virtual_stress, options.gravity, options.scatter);
  if (lost_point >= 0) return s.particles.count() + lost_point;
  update_nodes(exec, s.nodes, basis, options.damping, options.dt);
  grid_to_particles(exec, s.particles, s.nodes, basis, options.pic, options.dt);
  remap_velocity(exec, s.particles, s.occupancy.bins, s.nodes, s.remap_workspace, basis, options.scatter);
  if (options.volumetric == Volumetric::averaged)
    average_divergence(exec, s.particles, s.occupancy.bins, s.nodes.remapped_velocity, bodies, basis,
                       s.mean_divergence, options.scatter);
  update_stress(exec, s.particles, s.nodes, bodies, basis, options.volume_update, options.position_velocity,
                options.dt, s.mean_divergence);
  move_surface_points(exec, s.surface, s.particles, s.nodes, basis, options.position_velocity, options.dt);
  return -1;
}

}  // namespace vsb
