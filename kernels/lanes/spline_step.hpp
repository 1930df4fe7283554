// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// One explicit MUSL step on cell lanes with quadratic B-splines, as kernels/lanes/linear_step.hpp makes it
/// with linear functions: two sweeps, and tractions of the (modified) virtual stress boundary method alone.
///
/// A lane holds a node-centred cell: the points nearest to one node of the scene's grid. All particles of a
/// node-centred cell have the same 3^Dim nodes. Nodes beyond a wall are mirror images (physics/walls.hpp).
#pragma once

#include <vsb/kernels/lanes/linear_step.hpp>
#include <vsb/kernels/lanes/spline_mark_nodes.hpp>
#include <vsb/kernels/lanes/spline_sweeps.hpp>

namespace vsb {

/// The cells around the nodes of a grid.
template <int Dim, class Real>
UniformGrid<Dim, Real> node_centred_grid(const UniformGrid<Dim, Real>& grid) {
  auto node_centred = grid;
  for (int i = 0; i < Dim; ++i) {
    node_centred.lower[i] -= node_centred.spacing[i] / 2;
    ++node_centred.cells[i];
  }
  return node_centred;
}

/// What a step works on. Unlike in LaneState, memory.grid is the node-centred grid, and boundary.declared is
/// [node of the grid with its ghost layer].
template <int Dim, class Real, class Device>
struct SplineLaneState : LaneState<Dim, Real, Device> {
  static constexpr bool splines = true;  ///< whether cells are node-centred
  UniformGrid<Dim, Real> grid;           ///< of the scene, without a ghost layer
  LaneGhosts<Device> ghosts;             ///< the nodes beyond walls, and their images
  LaneCorners<Device> corners;           ///< which cells of the scene's grid the particles are in
  Kokkos::View<int*, Device> crossed;    ///< [layer]: 1 where particles changed the cell of the scene's grid
  SmallMeans<Device> small_means;        ///< memory of average_lane_divergence
};

/// The grid of the scene; before packing.
template <int Dim, class Real, class Device>
void set_grid(SplineLaneState<Dim, Real, Device>& s, const UniformGrid<Dim, Real>& grid) {
  s.grid = grid;
  s.memory.grid = node_centred_grid(grid);
  s.memory.lanes.node_centred = true;
  s.memory.remap_method = RemapMethod::second_sweep;
}

/// Sweep A alone, of all layers or of some.
template <class Exec, class Field, int Dim, class Real, class Device>
void sum_lanes(const Exec& exec, const SplineLaneState<Dim, Real, Device>& s, const Field& field,
               const Kokkos::View<int*, Device>& only = {}) {
  Kokkos::parallel_for(
      "vsb::sum_spline_lanes", detail::over_layers(exec, s),
      kernel::SumSplineLanes<Field, Dim, Real, Device>{detail::loaded_lanes(s), s.memory.nodes, field, only});
}

/// Whether cells of the scene's grid turned void or filled in a step.
template <class Exec, int Dim, class Real, class Device>
bool cells_changed(const Exec& exec, SplineLaneState<Dim, Real, Device>& s, int migrating) {
  if (migrating == 0) {
    int layers = 0;
    Kokkos::parallel_reduce("vsb::count_crossed", Kokkos::RangePolicy<Exec>(exec, 0, s.memory.lanes.layers()),
                            kernel::AddUp<Device>{s.crossed}, layers);
    exec.fence();
    if (layers == 0) return false;
  }
  return update_spline_occupied(exec, s.memory.lanes, s.corners, s.boundary);
}

/// Marks the boundary anew where a field acts and cells of the scene's grid changed. Returns whether it did.
template <class Field, class Exec, int Dim, class Real, class Device>
bool bring_marks_up_to_date(const Exec& exec, SplineLaneState<Dim, Real, Device>& s) {
  if (!s.unmarked || !Field::loaded) return false;
  const auto& m = s.memory;
  mark_spline_lanes(exec, m.lanes, s.grid.cells, m.walls, s.ghosts, s.boundary, false);
  s.unmarked = false;
  return true;
}

/// Marks the boundary of lanes that were packed anew.
template <class Exec, int Dim, class Real, class Device>
void mark_packed_lanes(const Exec& exec, SplineLaneState<Dim, Real, Device>& s) {
  const auto& m = s.memory;
  detail::take_declarations(exec, s.boundary, with_ghost_layer(s.grid).node_count());
  s.ghosts = list_ghosts(m.lanes, s.grid.cells, m.walls);
  s.crossed = decltype(s.crossed)("vsb::crossed", static_cast<size_t>(m.lanes.layers()));
  fit_boundary(exec, m.lanes, s.boundary);
  update_spline_occupied(exec, m.lanes, s.corners, s.boundary);
  mark_spline_lanes(exec, m.lanes, s.grid.cells, m.walls, s.ghosts, s.boundary, true);
  s.unmarked = false;
}

namespace detail {

/// Packs by pack(), particles that may be outside the grid.
template <class Exec, int Dim, class Real, class Device, class Pack>
int pack_spline_lanes(const Exec& exec, const Particles<Dim, Real, Device>& particles,
                      SplineLaneState<Dim, Real, Device>& s, const Pack& pack) {
  check_grid(s.grid);
  s.prepared = false;
  set_grid(s, UniformGrid<Dim, Real>(s.grid));
  int lost = find_outside(exec, particles, s.grid);
  if (lost < 0) lost = pack();
  if (lost < 0) mark_packed_lanes(exec, s);
  return lost;
}

}  // namespace detail

/// Packs the particles; s.grid, s.memory.walls and what s.boundary declares must be set. Returns -1, or the
/// lowest number of a particle outside the grid.
template <class Exec, int Dim, class Real, class Device>
int pack_lanes(const Exec& exec, const Particles<Dim, Real, Device>& particles,
               SplineLaneState<Dim, Real, Device>& s) {
  return detail::pack_spline_lanes(exec, particles, s,
                                   [&] { return pack_particles(exec, particles, s.memory); });
}

/// The same for particles that are not needed any more (see pack_particles).
template <class Exec, int Dim, class Real, class Device>
int pack_lanes(const Exec& exec, ParticleBlock<Dim, Real, Device>&& block,
               SplineLaneState<Dim, Real, Device>& s) {
  return detail::pack_spline_lanes(exec, Particles<Dim, Real, Device>(block.particles), s,
                                   [&] { return pack_particles(exec, std::move(block), s.memory); });
}

/// Nodes at which a traction acts, ghost nodes beyond walls aside. Waits for the device.
template <class Exec, int Dim, class Real, class Device>
int count_loaded_nodes(const Exec& exec, const SplineLaneState<Dim, Real, Device>& s) {
  return count_marked_nodes(exec, s.memory.lanes, s.grid.cells, s.memory.walls, s.boundary);
}

/// prepare_lane_step with quadratic B-splines.
template <class Exec, class Field, int Dim, class Real, class Device>
void prepare_lane_step(const Exec& exec, SplineLaneState<Dim, Real, Device>& s, const Field& virtual_stress) {
  detail::check_packed<Exec>(s);
  detail::forget_declarations(s.boundary);
  mark_packed_lanes(exec, s);
  check_load(virtual_stress, declared_tractions(s.boundary), false);
  detail::check_loaded<Field>(exec, s);
  sum_lanes(exec, s, virtual_stress);
  detail::note_prepared(s);
}

/// Advances by one step, and prepares the next one with its virtual stress. Returns -1, or the lowest number
/// of a particle that left the grid.
template <class Exec, class Field, class Material, class Volume, int Dim, class Real, class Device>
int lane_step(const Exec& exec, SplineLaneState<Dim, Real, Device>& s, const Material& material,
              const Volume& volume, const Field& next_virtual_stress, const StepOptions<Dim, Real>& options) {
  const ProfilingRegion region("vsb::lane_step");
  auto& m = s.memory;
  detail::check_lane_step(s, material, next_virtual_stress, options);
  bring_marks_up_to_date<Field>(exec, s);
  const Kokkos::RangePolicy<Exec> over_node_groups(exec, 0, m.lanes.node_count / m.lanes.width);
  const auto fold = [&](bool momentum_alone) {
    kernel::for_each_image(
        "vsb::fold_lane_ghosts", exec, s.ghosts,
        kernel::FoldLaneGhosts<Dim, Real, Device>{m.nodes, s.ghosts, options.gravity, momentum_alone});
  };
  const auto mirror = [&](int first, int vectors) {
    kernel::for_each_image("vsb::mirror_lane_ghosts", exec, s.ghosts,
                           kernel::MirrorLaneGhosts<Dim, Real, Device>{m.nodes, s.ghosts, first, vectors});
  };

  fold(false);
  Kokkos::parallel_for("vsb::update_lane_nodes", over_node_groups,
                       kernel::UpdateLaneNodes<Dim, Real, Device, 3>{{m.nodes},
                                                                     options.gravity,
                                                                     m.grid.inverse_spacing,
                                                                     options.damping,
                                                                     options.pic,
                                                                     options.dt,
                                                                     true,
                                                                     options.position_velocity});
  // With PositionVelocity::grid displacement_column too.
  mirror(m.nodes.increment_column, options.position_velocity == PositionVelocity::grid ? 2 : 1);
  Kokkos::parallel_for("vsb::accelerate_spline_lanes", detail::over_layers(exec, s),
                       kernel::AccelerateSplineLanes<Dim, Real, Device>{m.lanes, m.nodes, options.pic});
  fold(true);
  Kokkos::parallel_for(
      "vsb::remap_lane_nodes", over_node_groups,
      kernel::RemapLaneNodes<Dim, Real, Device, 3>{{m.nodes}, options.dt * m.grid.inverse_spacing[0]});
  mirror(m.nodes.remapped_column, 1);
  const Real beta = detail::lane_share<Dim>(material, options);
  if (beta > Real(0)) average_lane_divergence(exec, s, s.grid, s.small_means);
  const bool summed = s.steps_with_migration < 2;
  Kokkos::parallel_for(
      "vsb::move_spline_lanes", detail::over_layers(exec, s),
      kernel::MoveSplineLanes<Field, Material, Volume, Dim, Real, Device>{
          detail::loaded_lanes(s),
          {{m.lanes, m.nodes, m.grid, material, volume, m.migrating, beta, options.position_velocity},
           s.crossed,
           m.walls},
          next_virtual_stress,
          summed});
  return detail::note_step_end(s, detail::finish_migration(exec, s, next_virtual_stress, summed));
}

}  // namespace vsb
