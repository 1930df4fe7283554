// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The members of LaneEngine, compiled for each dimension, precision and state on its own.
#pragma once

#include <utility>

#include <vsb/kernels/lanes/balance.hpp>
#include <vsb/kernels/lanes/health.hpp>
#include "engine/lane_engine.hpp"
#include "engine/lane_fields.hpp"

namespace vsb::app {

namespace detail {

template <class View>
auto on_host(const View& view) {
  return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), view);
}

/// The slots in use, as runs of consecutive ones: first slot, slots.
struct SlotRuns {
  std::vector<std::pair<size_t, size_t>> runs;
  size_t slots = 0;
};
inline SlotRuns runs_of_slots(const std::vector<GroupShape>& groups) {
  SlotRuns used;
  size_t first = 0;
  for (const auto& group : groups) {
    const auto slots = static_cast<size_t>(group.slots);
    if (slots > 0) used.runs.emplace_back(first, slots);
    used.slots += slots;
    first += static_cast<size_t>(group.capacity);
  }
  return used;
}

/// The columns of the nodes' sums.
template <int Dim, class Real, class Device>
std::vector<int> columns_of_sums(const LaneMemory<Dim, Real, Device>& m) {
  std::vector<int> columns;
  for (int plane = 0; plane < (m.lanes.dual ? 3 : 2); ++plane)
    for (int c = 0; c < m.nodes.sum_columns; ++c)
      columns.push_back((plane == 0   ? m.nodes.lower_sums
                         : plane == 1 ? m.nodes.upper_sums
                                      : m.nodes.middle_sums) +
                        c);
  return columns;
}

/// An array as long as the view.
template <class View>
bool read_view(ByteReader& r, const View& view) {
  const auto host = Kokkos::create_mirror_view(view);
  if (!r.array(host.data(), host.span())) return false;
  Kokkos::deep_copy(view, host);
  return true;
}

}  // namespace detail

template <int Dim, class Real, class State>
LaneEngine<Dim, Real, State>::LaneEngine(const Setup& setup, const SurfacePoints<Dim, Real, Device>& surface)
    : setup_(setup) {
  set_grid(state_, setup.grid);
  state_.loads_found = true;  // a resumed load may have left its region
  state_.memory.walls = setup.walls;
  state_.memory.lanes.state_size = setup.state_size;
  state_.memory.lanes.particle_count = setup.particles;
  state_.boundary.declared = setup.tractions;
  state_.boundary.bits.carried = setup.carried;
  state_.boundary.conservative = setup.conservative;
  state_.original = setup.original;
  state_.gauss_points = setup.gauss_points;
  if constexpr (!State::splines) state_.surface = pack_surface_points(exec_, surface, setup.grid);
}

template <int Dim, class Real, class State>
void LaneEngine<Dim, Real, State>::pack(ParticleBlock<Dim, Real, Device> block) {
  pack_lanes(exec_, std::move(block), state_);
}

template <int Dim, class Real, class State>
int LaneEngine<Dim, Real, State>::prepare(const Loads<Dim, Real>& loads) {
  loads.template with_lane_field<!State::splines>(
      [&](const auto& field) { prepare_lane_step(exec_, state_, field); });
  return add_loads(loads);
}

template <int Dim, class Real, class State>
int LaneEngine<Dim, Real, State>::add_loads(const Loads<Dim, Real>& loads) {
  if (loaded_by_sweeps()) return -1;
  int lost = -1;
  if constexpr (!State::splines)
    lost = loads.with_field_beside_lanes(
        [&](const auto& field) { return add_lane_loads(exec_, state_, field); });
  return lost < 0 ? -1 : state_.memory.lanes.particle_count + lost;
}

template <int Dim, class Real, class State>
int LaneEngine<Dim, Real, State>::step(const Loads<Dim, Real>& next) {
  int lost = -1;
  next.template with_lane_field<!State::splines>([&](const auto& field) {
    std::visit(
        [&](const auto& material, const auto& volume) {
          lost = lane_step(exec_, state_, material, volume, field, setup_.options);
        },
        setup_.material, setup_.options.volume_update);
  });
  return lost < 0 ? add_loads(next) : lost;
}

template <int Dim, class Real, class State>
void LaneEngine<Dim, Real, State>::unpack(const Particles<Dim, Real, Device>& particles,
                                          const SurfacePoints<Dim, Real, Device>& surface) const {
  unpack_particles(exec_, state_.memory, particles);
  unpack_homeless(exec_, state_.memory, particles);
  unpack_surface_points(exec_, state_.surface, state_.memory.grid, surface);
  exec_.fence();
}

template <int Dim, class Real, class State>
Particles<Dim, Real, typename LaneEngine<Dim, Real, State>::Device>
LaneEngine<Dim, Real, State>::mass_points() const {
  return unpack_mass_points(exec_, state_.memory);
}

template <int Dim, class Real, class State>
Invalid LaneEngine<Dim, Real, State>::find_invalid() const {
  return vsb::find_invalid(exec_, state_.memory);
}

template <int Dim, class Real, class State>
Balance<Dim> LaneEngine<Dim, Real, State>::balance(const Loads<Dim, Real>& loads) const {
  const double modulus =
      std::visit([](const auto& m) { return double(m.constrained_modulus()); }, setup_.material);
  Balance<Dim> result{};
  if constexpr (!State::splines)
    loads.with_lane_field([&](const auto& field) {
      result = vsb::balance(exec_, state_, modulus, field, setup_.options.gravity, setup_.cover);
    });
  return result;
}

template <int Dim, class Real, class State>
TractionResultant<Dim> LaneEngine<Dim, Real, State>::resultant(const Loads<Dim, Real>& loads,
                                                               TractionMask among) const {
  TractionResultant<Dim> result{};
  loads.template with_lane_field<!State::splines>(
      [&](const auto& field) { result = vsb::resultant(exec_, state_, field, among, setup_.cover); });
  return result;
}

template <int Dim, class Real, class State>
LoadedCells LaneEngine<Dim, Real, State>::loaded_cells(TractionMask traction) const {
  return count_loaded_cells(exec_, state_, traction);
}

template <int Dim, class Real, class State>
void LaneEngine<Dim, Real, State>::equivalent_plastic_strain(
    const Kokkos::View<Real*, Device>& strain) const {
  const auto& lanes = state_.memory.lanes;
  Kokkos::parallel_for("vsb::lane_plastic_strain",
                       Kokkos::RangePolicy<ExecutionSpace>(exec_, 0, lanes.group_count),
                       kernel::LanePlasticStrain<Dim, Real, Device>{lanes, strain});
}

template <int Dim, class Real, class State>
void LaneEngine<Dim, Real, State>::for_each_cell(
    const std::function<void(int, const Vector<Dim, int>&)>& visit) const {
  const auto& lanes = state_.memory.lanes;
  const auto groups = detail::on_host(lanes.groups);
  const auto id = detail::on_host(lanes.id);
  for (size_t g = 0; g < groups.extent(0); ++g) {
    const auto& group = groups(g);
    for (size_t e = lanes.begin(group); e < lanes.end(group); ++e)
      if (id(e) >= 0) visit(id(e), lanes.cell(group, static_cast<int>(e % lanes.width)));
  }
}

template <int Dim, class Real, class State>
std::unique_ptr<FieldSource> LaneEngine<Dim, Real, State>::fields() const {
  if constexpr (State::splines) return nullptr;
  return std::make_unique<LaneFields<Dim, Real>>(exec_, state_);
}

template <int Dim, class Real, class State>
int LaneEngine<Dim, Real, State>::boundary_nodes() const {
  return count_loaded_nodes(exec_, state_);
}

template <int Dim, class Real, class State>
size_t LaneEngine<Dim, Real, State>::bytes() const {
  const auto bytes = [](const auto&... views) { return (... + (views.span() * sizeof(*views.data()))); };
  const auto& l = state_.memory.lanes;
  const auto& n = state_.memory.nodes;
  const auto& b = state_.boundary;
  const auto& p = state_.surface;
  const size_t columns = static_cast<size_t>(l.slot_count) * l.width * static_cast<size_t>(l.columns());
  return columns * sizeof(Real) +
         bytes(l.id, l.held, l.mass_matrices, l.groups, l.stencils, l.layer_first, l.plane_first, l.group_at,
               l.chunk_at, n.data, n.fixed, b.bits.occupied, b.bits.exterior, b.bits.boundary, b.marked,
               b.active, b.tractions, b.bits.carried.particle, b.bits.carried.cells, b.bits.carried.nodes,
               p.cell, p.xi, p.area, p.tractions, p.carrier, p.order, p.run_cell, p.run_first, p.cell_count);
}

template <int Dim, class Real, class State>
void LaneEngine<Dim, Real, State>::save(ByteSink& to) const {
  const auto& m = state_.memory;
  const auto& l = m.lanes;
  const size_t entries = static_cast<size_t>(l.slot_count) * l.width,
               nodes = static_cast<size_t>(l.node_count);
  ByteWriter w(to);
  w.number(l.width);
  w.number(l.box);
  w.number(l.group_count);
  w.number(l.slot_count);
  w.number(l.node_count);
  w.number(m.slack);
  w.number(m.reach);
  w.number(state_.steps_since_repacked);
  w.number(state_.steps_of_flow);
  w.number(state_.prepared);
  w.number(l.one_sweep());
  const auto groups = detail::on_host(l.groups);
  std::vector<GroupShape> shape;
  for (int g = 0; g < l.group_count; ++g) {
    const auto& group = groups(static_cast<size_t>(g));
    shape.push_back({group.x, group.row, group.slots, group.capacity});
  }
  w.array(shape.data(), shape.size());
  w.array(detail::on_host(l.id).data(), entries);
  // The slots in use, column by column.
  const auto used = detail::runs_of_slots(shape);
  for (int c = 0; c < l.columns(); ++c) {
    const auto column = detail::on_host(Kokkos::subview(l.data, Kokkos::ALL(), static_cast<size_t>(c)));
    w.number(used.slots * static_cast<size_t>(l.width));
    for (const auto& [first, slots] : used.runs) w.values(&column(first * l.width), slots * l.width);
  }
  const auto sums = detail::on_host(m.nodes.data);
  for (const int c : detail::columns_of_sums(m)) w.array(&sums(0, static_cast<size_t>(c)), nodes);
  w.array(detail::on_host(l.mass_matrices).data(), l.mass_matrices.size());
  const auto& p = state_.surface;
  if (p.count() > 0) {
    w.array(detail::on_host(p.cell).data(), p.cell.span());
    w.array(detail::on_host(p.xi).data(), p.xi.span());
    w.array(detail::on_host(p.area).data(), p.area.span());
  }
}

template <int Dim, class Real, class State>
bool LaneEngine<Dim, Real, State>::restore(ByteSource& saved) {
  ByteReader r(saved);
  auto& m = state_.memory;
  int width = 0, groups = 0, slots = 0, nodes = 0, slack = 0, since = 0, flow = 0;
  CellBox<Dim> box;
  Reach<Dim> reach;
  bool prepared = false, one_sweep = false;
  if (!r.number(width) || width != m.lanes.width || !r.number(box) || !r.number(groups) || !r.number(slots) ||
      !r.number(nodes) || !r.number(slack) || !r.number(reach) || !r.number(since) || !r.number(flow) ||
      !r.number(prepared) || !r.number(one_sweep) || groups < 0 || slots < 0 || nodes < 0)
    return false;
  if (static_cast<size_t>(groups) > saved.size()) return false;
  std::vector<GroupShape> shape(static_cast<size_t>(groups));
  if (!r.array(shape.data(), shape.size())) return false;
  if (!lay_out_lanes(exec_, m, box, shape)) return false;
  if (m.lanes.slot_count != slots || m.lanes.node_count != nodes) return false;
  set_sweeps(m.lanes, one_sweep);
  m.slack = slack;
  m.reach = reach;
  state_.steps_since_repacked = since;
  state_.steps_of_flow = flow;
  auto& l = m.lanes;
  const size_t entries = static_cast<size_t>(slots) * l.width;
  const auto id = Kokkos::create_mirror_view(l.id);
  if (!r.array(id.data(), entries)) return false;
  std::vector<bool> seen(static_cast<size_t>(l.particle_count));
  for (size_t e = 0; e < entries; ++e) {
    if (id(e) < 0) continue;
    if (id(e) >= l.particle_count || seen[static_cast<size_t>(id(e))]) return false;
    seen[static_cast<size_t>(id(e))] = true;
  }
  for (const bool found : seen)
    if (!found) return false;
  Kokkos::deep_copy(l.id, id);
  const auto held = Kokkos::create_mirror_view(l.held);
  for (size_t slot = 0; slot < static_cast<size_t>(slots); ++slot) {
    held(slot) = 0;
    for (int lane = 0; lane < l.width; ++lane)
      if (id(slot * l.width + static_cast<size_t>(lane)) >= 0) held(slot) |= LaneMask(1) << lane;
  }
  Kokkos::deep_copy(l.held, held);
  const auto used = detail::runs_of_slots(shape);
  for (int c = 0; c < l.columns(); ++c) {
    const auto on_device = Kokkos::subview(l.data, Kokkos::ALL(), static_cast<size_t>(c));
    const auto column = Kokkos::create_mirror_view(on_device);
    if (!r.length(used.slots * static_cast<size_t>(l.width))) return false;
    for (const auto& [first, in_run] : used.runs)
      if (!r.values(&column(first * l.width), in_run * l.width)) return false;
    Kokkos::deep_copy(on_device, column);
  }
  const auto sums = Kokkos::create_mirror_view(m.nodes.data);
  for (const int c : detail::columns_of_sums(m))
    if (!r.array(&sums(0, static_cast<size_t>(c)), static_cast<size_t>(nodes))) return false;
  Kokkos::deep_copy(m.nodes.data, sums);
  if (!detail::read_view(r, l.mass_matrices)) return false;
  auto& p = state_.surface;
  if (p.count() > 0 &&
      (!detail::read_view(r, p.cell) || !detail::read_view(r, p.xi) || !detail::read_view(r, p.area)))
    return false;
  p.sorted = false;
  if (!r.at_end()) return false;
  mark_packed_lanes(exec_, state_);
  state_.prepared = prepared;
  return true;
}

}  // namespace vsb::app
