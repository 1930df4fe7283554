// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// One explicit MUSL step on cell lanes: the same step as in kernels/step.hpp, in the paper's order, with the
/// particles read and written in two sweeps. The end of a step computes the nodal sums of the next one:
///   m_I = sum_p m_p N_Ip,   p_I = sum_p m_p v_p N_Ip,   f_I = -sum_p V_p sigma_p . grad N_Ip,
/// with the virtual stress. A step therefore takes the virtual stress of the next step.
#pragma once

#include <vsb/kernels/lanes/mark_nodes.hpp>
#include <vsb/kernels/lanes/migrate.hpp>
#include <vsb/kernels/lanes/repack.hpp>
#include <vsb/kernels/lanes/surface_traction.hpp>
#include <vsb/kernels/lanes/sweeps.hpp>
#include <vsb/kernels/lanes/update_nodes.hpp>
#include <vsb/kernels/step.hpp>

namespace vsb {

/// What a step on cell lanes works on.
template <int Dim, class Real, class Device>
struct LaneState {
  static constexpr bool splines = false;         ///< whether cells are node-centred
  using device = Device;                         ///< where the memory is
  LaneMemory<Dim, Real, Device> memory;          ///< packed particles, nodes and grid
  LaneBoundary<Dim, Device> boundary;            ///< declared tractions, and the nodes at which they act
  LaneSurfacePoints<Dim, Real, Device> surface;  ///< none, unless a traction is imposed on points
  TractionMask original = 0;        ///< tractions of the original method, which the sweeps leave out
  int gauss_points = 2;             ///< of these, per direction, 1 to 4
  long long repacked = 0;           ///< times
  int steps_since_repacked = 1000;  ///< since all particles were packed anew, or 1000 at first
  int steps_with_migration = 0;     ///< the last ones in a row in which many particles left their cells
  bool unmarked = false;            ///< cells turned void or filled since the boundary was marked
  bool prepared = false;            ///< whether the nodes have the sums of the step to come
  bool loads_due = false;           ///< of the step to come, by add_lane_loads
  bool loads_found = false;         ///< whether the load has been found to act at some node

  /// Whether the cells of the grid are cubes (squares in 2D).
  bool equal_spacing() const {
    for (int i = 1; i < Dim; ++i)
      if (memory.grid.spacing[i] != memory.grid.spacing[0]) return false;
    return true;
  }
};

namespace kernel {

/// The union of two sets of layers.
template <class Device>
struct JoinLayers {
  Kokkos::View<int*, Device> layers, others;
  KOKKOS_FUNCTION void operator()(int layer) const { layers(layer) |= others(layer); }
};

}  // namespace kernel

namespace detail {

/// Calls work(true or false as a type): whether the spacing is equal in all directions.
template <int Dim, class Real, class Device, class Work>
void with_equal_spacing(const LaneState<Dim, Real, Device>& s, const Work& work) {
  if (s.equal_spacing())
    work(std::true_type{});
  else
    work(std::false_type{});
}

template <int Dim, class Real, class Device>
LoadedLanes<Dim, Real, Device> loaded_lanes(const LaneState<Dim, Real, Device>& s) {
  return {s.memory.lanes, s.memory.grid, s.boundary.tractions};
}

/// beta of a step, 0 where particles strain by their own divergence.
template <int Dim, class Material, class Real>
Real lane_share(const Material& material, const StepOptions<Dim, Real>& options) {
  return options.volumetric == Volumetric::averaged ? averaged_share<Dim>(material) : Real(0);
}

template <class Exec>
using OverLayers = Kokkos::RangePolicy<Exec, Kokkos::Schedule<Kokkos::Dynamic>>;

template <class Exec, int Dim, class Real, class Device>
OverLayers<Exec> over_layers(const Exec& exec, const LaneState<Dim, Real, Device>& s) {
  return OverLayers<Exec>(exec, 0, s.memory.lanes.layers(), Kokkos::ChunkSize(1));
}

/// Sweep A alone, of all layers or of some.
template <class Exec, class Field, int Dim, class Real, class Device>
void sum_lanes(const Exec& exec, const LaneState<Dim, Real, Device>& s, const Field& field,
               const Kokkos::View<int*, Device>& only = {}) {
  with_equal_spacing(s, [&](auto equal_spacing) {
    Kokkos::parallel_for("vsb::sum_lanes", over_layers(exec, s),
                         kernel::SumLanes<decltype(equal_spacing)::value, Field, Dim, Real, Device>{
                             loaded_lanes(s), s.memory.nodes, field, only});
  });
}

}  // namespace detail

/// The grid of the scene; before packing.
template <int Dim, class Real, class Device>
void set_grid(LaneState<Dim, Real, Device>& s, const UniformGrid<Dim, Real>& grid) {
  s.memory.grid = grid;
}

/// Nodes at which a traction acts. Waits for the device.
template <class Exec, int Dim, class Real, class Device>
int count_loaded_nodes(const Exec& exec, const LaneState<Dim, Real, Device>& s) {
  return count_loaded_nodes(exec, s.memory.lanes, s.boundary);
}

namespace detail {

/// Refuses lanes without particles that were packed.
template <class Exec, int Dim, class Real, class Device>
void check_packed(const LaneState<Dim, Real, Device>& s) {
  require_accessible<Exec, Device>();
  if (s.memory.lanes.layer_first.extent(0) == 0)
    refuse("the cell lanes hold no particles: call pack_lanes before prepare_lane_step");
}

/// Refuses a load that finds no node when it is prepared for the first time. Waits for the device.
template <class Field, class Exec, class State>
void check_loaded(const Exec& exec, State& s) {
  if constexpr (Field::loaded) {
    if (!s.loads_found && s.surface.count() == 0) vsb::check_loaded(count_loaded_nodes(exec, s));
    s.loads_found = true;
  }
}

/// Notes that the nodal sums are computed, and whether add_lane_loads must follow.
template <int Dim, class Real, class Device>
void note_prepared(LaneState<Dim, Real, Device>& s) {
  s.prepared = true;
  s.loads_due = s.original != 0 || s.surface.count() > 0;
}

/// note_prepared after a step that lost particle `lost`, or none (-1). Returns `lost`.
template <int Dim, class Real, class Device>
int note_step_end(LaneState<Dim, Real, Device>& s, int lost) {
  note_prepared(s);
  s.prepared = lost < 0;
  return lost;
}

/// Refuses input that would make a step wrong without any sign of it.
template <class State, class Material, class Field, int Dim, class Real>
void check_lane_step(const State& s, const Material& material, const Field& next_virtual_stress,
                     const StepOptions<Dim, Real>& options) {
  check_options(options);
  check_material(material);
  const int remembered = Material::template state_size<Dim>();
  if (remembered > s.memory.lanes.state_size)
    refuse("the lanes hold ", s.memory.lanes.state_size,
           " numbers of material state per particle and the material remembers ", remembered,
           ": set LaneState::memory.lanes.state_size, and Particles::material_state, before pack_lanes");
  bool as_packed = true;
  for (int i = 0; i < Dim; ++i) {
    const auto &grid = s.memory.grid, &packed = s.memory.packed_grid;
    as_packed = as_packed && grid.lower[i] == packed.lower[i] && grid.spacing[i] == packed.spacing[i] &&
                grid.cells[i] == packed.cells[i];
    for (const int side : {0, 1})
      as_packed = as_packed && s.memory.walls.fixed[i][side] == s.memory.packed_walls.fixed[i][side];
  }
  if (!as_packed)
    refuse(
        "the grid or the walls of the lanes have changed: call unpack_particles before, and pack_lanes and "
        "prepare_lane_step after such a change");
  if (!s.prepared)
    refuse("no step is prepared: call prepare_lane_step after pack_lanes, with the load of the step to come");
  if (!declared_as_marked(s.boundary))
    refuse(
        "what LaneState::boundary declares has changed: call prepare_lane_step again, with the load of the "
        "step to come");
  if (State::splines && (s.original != 0 || s.surface.count() > 0))
    refuse(
        "cell lanes with B-splines take virtual stresses alone: use the particle kernels (vsb::step) for "
        "surface points and for the original method");
  if (s.loads_due)
    refuse(
        "the loads on surface points and those of the original method are missing: call add_lane_loads after "
        "prepare_lane_step and after every lane_step, with the load that these took");
  check_load(next_virtual_stress, declared_tractions(s.boundary), s.original != 0 || s.surface.count() > 0);
}

/// The field of the sweeps: without the tractions of the original method.
template <class Field>
Field of_sweeps(const Field& field, TractionMask original) {
  if constexpr (Field::loaded)
    return field.without(original);
  else
    return field;
}

}  // namespace detail

/// Marks the boundary of lanes that were packed anew.
template <class Exec, int Dim, class Real, class Device>
void mark_packed_lanes(const Exec& exec, LaneState<Dim, Real, Device>& s) {
  detail::take_declarations(exec, s.boundary, s.memory.grid.node_count());
  fit_boundary(exec, s.memory.lanes, s.boundary);
  update_occupied(exec, s.memory.lanes, s.boundary);
  mark_lanes(exec, s.memory.lanes, s.memory.grid.cells, s.boundary, true);
  s.unmarked = false;
}

namespace detail {

/// Whether cells turned void or filled in a step; migrating: the particles that left their cells in it.
template <class Exec, int Dim, class Real, class Device>
bool cells_changed(const Exec& exec, const LaneState<Dim, Real, Device>& s, int migrating) {
  return migrating > 0 && update_occupied(exec, s.memory.lanes, s.boundary);
}

/// Marks the boundary anew where a field acts and cells turned void or filled. Returns whether it did.
template <class Field, class Exec, int Dim, class Real, class Device>
bool bring_marks_up_to_date(const Exec& exec, LaneState<Dim, Real, Device>& s) {
  if (!s.unmarked || !(Field::loaded || s.original != 0)) return false;
  mark_lanes(exec, s.memory.lanes, s.memory.grid.cells, s.boundary, false);
  s.unmarked = false;
  return true;
}

}  // namespace detail

/// Packs the particles; s.memory.grid and walls and what s.boundary declares must be set. Returns -1, or the
/// lowest number of a particle outside the grid.
template <class Exec, int Dim, class Real, class Device>
int pack_lanes(const Exec& exec, const Particles<Dim, Real, Device>& particles,
               LaneState<Dim, Real, Device>& s) {
  s.prepared = false;
  const int lost = pack_particles(exec, particles, s.memory);
  if (lost < 0) mark_packed_lanes(exec, s);
  return lost;
}

/// The same for particles that are not needed any more (see pack_particles).
template <class Exec, int Dim, class Real, class Device>
int pack_lanes(const Exec& exec, ParticleBlock<Dim, Real, Device>&& block, LaneState<Dim, Real, Device>& s) {
  s.prepared = false;
  const int lost = pack_particles(exec, std::move(block), s.memory);
  if (lost < 0) mark_packed_lanes(exec, s);
  return lost;
}

/// Gives groups spare slots where they overflowed soon after the last packing.
template <int Dim, class Real, class Device>
void adapt_slack(LaneState<Dim, Real, Device>& s, const OverflowCount& overflow) {
  auto& m = s.memory;
  if (s.steps_since_repacked < 100) {
    if (overflow.without_slot > 0) m.slack = math::min(m.slack + 1, 4);
  } else if (s.steps_since_repacked >= 1000) {
    m.slack = 1;
    m.group_margin = {};
  }
  ++s.repacked;
}

namespace detail {

/// The end of a step after its sweeps: brings the migrating particles to their cells, marks the boundary, and
/// computes the nodal sums that the last sweep did not (`summed`: whether it did any). Returns what lane_step
/// returns. States other than LaneState have their own mark_packed_lanes, cells_changed,
/// bring_marks_up_to_date and sum_lanes.
template <class Exec, class Field, class State>
int finish_migration(const Exec& exec, State& s, const Field& next_virtual_stress, bool summed) {
  auto& m = s.memory;
  ++s.steps_since_repacked;
  const int migrating = count_migrating(exec, m);
  s.steps_with_migration =
      migrating > m.lanes.particle_count / 50 ? math::min(s.steps_with_migration + 1, 2) : 0;
  int unsummed = 0;  // layers, of migrating.unsummed
  if (migrating > 0) {
    // An empty entry costs as much as a particle in every sweep. To fill it costs as much as one migration.
    const bool compacting = s.steps_since_repacked % 8 == 0;
    const auto overflow = insert_migrating(exec, m, next_virtual_stress, s.boundary.tractions, compacting);
    if (overflow.any()) {
      adapt_slack(s, overflow);
      // A moving body gets groups of cells ahead of it.
      const int lost = repack_lanes(exec, m, overflow.without_group > 0 && s.steps_since_repacked < 100);
      s.steps_since_repacked = 0;
      if (lost >= 0) return lost;
      mark_packed_lanes(exec, s);
      sum_lanes(exec, s, next_virtual_stress);
      return -1;
    }
    unsummed = overflow.unsummed_layers;
  }
  if (cells_changed(exec, s, migrating)) s.unmarked = true;
  const bool reloaded = bring_marks_up_to_date<Field>(exec, s) && Field::loaded;
  if (unsummed > 0 && reloaded)
    Kokkos::parallel_for("vsb::join_layers", Kokkos::RangePolicy<Exec>(exec, 0, m.lanes.layers()),
                         kernel::JoinLayers<typename State::device>{m.migrating.unsummed, s.boundary.stale});
  if (migrating == 0 && !summed)
    sum_lanes(exec, s, next_virtual_stress);
  else if (unsummed > 0)
    sum_lanes(exec, s, next_virtual_stress, m.migrating.unsummed);
  else if (reloaded)
    sum_lanes(exec, s, next_virtual_stress, s.boundary.stale);
  return -1;
}

}  // namespace detail

/// Marks the boundary by what is declared and computes the nodal sums. Required before the first step, and
/// after a change of loads or declarations. `virtual_stress` is the field at the end of the step to come.
/// Where loads act on s.surface or by s.original, add_lane_loads must follow.
template <class Exec, class Field, int Dim, class Real, class Device>
void prepare_lane_step(const Exec& exec, LaneState<Dim, Real, Device>& s, const Field& virtual_stress) {
  detail::check_packed<Exec>(s);
  detail::forget_declarations(s.boundary);
  mark_packed_lanes(exec, s);
  check_load(virtual_stress, declared_tractions(s.boundary), s.original != 0 || s.surface.count() > 0);
  detail::check_loaded<Field>(exec, s);
  detail::sum_lanes(exec, s, detail::of_sweeps(virtual_stress, s.original));
  detail::note_prepared(s);
}

/// Advances by one step, and prepares the next one with its virtual stress. Returns -1, or the lowest number
/// of a particle that left the grid. Throws std::invalid_argument, before anything is changed, where
/// something is missing that a step needs (kernels/preconditions.hpp).
template <class Exec, class Field, class Material, class Volume, int Dim, class Real, class Device>
int lane_step(const Exec& exec, LaneState<Dim, Real, Device>& s, const Material& material,
              const Volume& volume, const Field& next_virtual_stress, const StepOptions<Dim, Real>& options) {
  const ProfilingRegion region("vsb::lane_step");
  auto& m = s.memory;
  detail::check_lane_step(s, material, next_virtual_stress, options);
  const auto swept = detail::of_sweeps(next_virtual_stress, s.original);
  detail::bring_marks_up_to_date<Field>(exec, s);
  const Kokkos::RangePolicy<Exec> over_node_groups(exec, 0, m.lanes.node_count / m.lanes.width);

  Kokkos::parallel_for("vsb::update_lane_nodes", over_node_groups,
                       kernel::UpdateLaneNodes<Dim, Real, Device>{{m.nodes},
                                                                  options.gravity,
                                                                  m.grid.inverse_spacing,
                                                                  options.damping,
                                                                  options.pic,
                                                                  options.dt,
                                                                  m.lanes.remaps_by_mass_matrix(),
                                                                  options.position_velocity});
  if (m.lanes.remaps_by_mass_matrix())
    Kokkos::parallel_for("vsb::remap_lanes", detail::over_layers(exec, s),
                         kernel::RemapLanes<Dim, Real, Device>{m.lanes, m.nodes});
  else
    Kokkos::parallel_for("vsb::accelerate_lanes", detail::over_layers(exec, s),
                         kernel::AccelerateLanes<Dim, Real, Device>{m.lanes, m.nodes, options.pic});
  Kokkos::parallel_for(
      "vsb::remap_lane_nodes", over_node_groups,
      kernel::RemapLaneNodes<Dim, Real, Device>{{m.nodes}, options.dt * m.grid.inverse_spacing[0]});
  const bool and_sum = s.steps_with_migration < 2;
  detail::with_equal_spacing(s, [&](auto equal_spacing) {
    Kokkos::parallel_for(
        "vsb::move_lanes", detail::over_layers(exec, s),
        kernel::MoveLanes<decltype(equal_spacing)::value, Field, Material, Volume, Dim, Real, Device>{
            detail::loaded_lanes(s),
            {m.lanes, m.nodes, m.grid, material, volume, m.migrating,
             detail::lane_share<Dim>(material, options), options.position_velocity, options.pic},
            swept,
            and_sum});
  });
  move_surface_points(exec, m, s.surface, options.position_velocity);
  return detail::note_step_end(s, detail::finish_migration(exec, s, swept, and_sum));
}

}  // namespace vsb
