// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The members of LaneEngine, compiled for each dimension, precision and state on its own.
#pragma once

#include <utility>

#include <vsb/kernels/lanes/balance.hpp>
#include <vsb/kernels/lanes/health.hpp>
#include "engine/lane_engine.hpp"
#include "engine/lane_fields.hpp"
#include "engine/saved_lanes.hpp"
#include "setup/basis_of.hpp"
#include "setup/scene_grid.hpp"

namespace vsb::app {

template <int Dim, class Real, class State>
LaneEngine<Dim, Real, State>::LaneEngine(Model<Dim, Real>& model, const SceneBasis<Dim, Real>& basis)
    : model_(model), basis_(basis) {
  const auto grid = uniform_grid<Dim, Real>(model.scene.grid, model.origin);
  set_grid(state_, grid);
  state_.loads_found = true;  // a resumed load may have left its region
  state_.memory.walls = walls<Dim>(model.scene.faces);
  state_.memory.lanes.state_size = state_size<Dim>(model.bodies.front().material);
  state_.memory.lanes.particle_count = model.particle_count();
  state_.boundary.declared = model.declared;
  state_.boundary.bits.carried = model.carried;
  state_.boundary.at_all_active_nodes = model.loads.at_all_active_nodes();
  state_.original = model.loads.original();
  state_.gauss_points = model.loads.gauss_points();
  if constexpr (!State::splines) state_.surface = pack_surface_points(exec_, model.surface, grid);
}

template <int Dim, class Real, class State>
void LaneEngine<Dim, Real, State>::pack(ParticleBlock<Dim, Real, Device> block) {
  pack_lanes(exec_, std::move(block), state_);
}

template <int Dim, class Real, class State>
StepOutcome LaneEngine<Dim, Real, State>::step(const std::function<void(int)>& set_loads) {
  if (!state_.prepared) {
    set_loads(1);
    if (const int lost = prepare(); lost >= 0) return {false, lost};
  }
  set_loads(2);
  const int lost = advance();
  return {true, lost < 0 ? add_loads() : lost};
}

template <int Dim, class Real, class State>
int LaneEngine<Dim, Real, State>::prepare() {
  model_.loads.template with_lane_field<!State::splines>(
      [&](const auto& field) { prepare_lane_step(exec_, state_, field); });
  return add_loads();
}

template <int Dim, class Real, class State>
int LaneEngine<Dim, Real, State>::add_loads() {
  if (loaded_by_sweeps()) return -1;
  int lost = -1;
  if constexpr (!State::splines)
    lost = model_.loads.with_field_beside_lanes(
        [&](const auto& field) { return add_lane_loads(exec_, state_, field); });
  return lost < 0 ? -1 : model_.particle_count() + lost;
}

template <int Dim, class Real, class State>
int LaneEngine<Dim, Real, State>::advance() {
  int lost = -1;
  model_.loads.template with_lane_field<!State::splines>([&](const auto& field) {
    std::visit(
        [&](const auto& material, const auto& volume) {
          lost = lane_step(exec_, state_, material, volume, field, model_.options);
        },
        model_.bodies.front().material, model_.options.volume_update);
  });
  return lost;
}

template <int Dim, class Real, class State>
std::shared_ptr<ParticleEngine<Dim, Real>> LaneEngine<Dim, Real, State>::particles() {
  auto engine = basis_.make_particle_engine(model_);
  const auto& particles = engine->block().particles;
  unpack_particles(exec_, state_.memory, particles);
  unpack_overflow(exec_, state_.memory, particles);
  unpack_surface_points(exec_, state_.surface, state_.memory.grid, model_.surface);
  exec_.fence();
  return engine;
}

template <int Dim, class Real, class State>
void LaneEngine<Dim, Real, State>::smooth(const Kokkos::View<Real*, Device>& q) {
  if (!basis_.smooth(unpack_mass_points(exec_, state_.memory), model_.options.scatter, q))
    particles()->smooth(q);
}

template <int Dim, class Real, class State>
Invalid LaneEngine<Dim, Real, State>::find_invalid() const {
  return vsb::find_invalid(exec_, state_.memory);
}

template <int Dim, class Real, class State>
Balance<Dim> LaneEngine<Dim, Real, State>::balance() {
  if constexpr (!State::splines)
    if (loaded_by_sweeps()) {
      const double modulus = std::visit([](const auto& m) { return double(m.constrained_modulus()); },
                                        model_.bodies.front().material);
      Balance<Dim> result{};
      model_.loads.with_lane_field([&](const auto& field) {
        result = vsb::balance(exec_, state_, modulus, field, model_.options.gravity, model_.cover);
      });
      return result;
    }
  return particles()->balance();
}

template <int Dim, class Real, class State>
std::vector<TractionAction<Dim>> LaneEngine<Dim, Real, State>::act(
    const std::vector<TractionMask>& tractions) {
  if (!loaded_by_sweeps()) return particles()->act(tractions);
  std::vector<TractionAction<Dim>> actions;
  for (const TractionMask mask : tractions) {
    auto& action = actions.emplace_back();
    model_.loads.template with_lane_field<!State::splines>([&](const auto& field) {
      action.resultant = vsb::resultant(exec_, state_, field, mask, model_.cover);
    });
    action.cells = count_loaded_cells(exec_, state_, mask);
  }
  return actions;
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
void LaneEngine<Dim, Real, State>::for_each_cell(const std::function<void(int, size_t)>& visit) {
  if constexpr (State::splines) return particles()->for_each_cell(visit);
  const auto& lanes = state_.memory.lanes;
  const auto groups = detail::on_host(lanes.groups);
  const auto id = detail::on_host(lanes.id);
  for (size_t g = 0; g < groups.extent(0); ++g) {
    const auto& group = groups(g);
    for (size_t e = lanes.begin(group); e < lanes.end(group); ++e)
      if (id(e) >= 0)
        visit(id(e), scene_cell(model_.scene, LinearBasis<Dim, Real>{},
                                lanes.cell(group, static_cast<int>(e % lanes.width))));
  }
}

template <int Dim, class Real, class State>
std::unique_ptr<FieldSource> LaneEngine<Dim, Real, State>::fields() {
  if constexpr (State::splines)
    return particles()->fields();
  else
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
  return columns * sizeof(Real) + bytes(l.id, l.with_particle, l.mass_matrices, l.groups, l.stencils,
                                        l.layer_first, l.plane_first, l.group_at, l.node_group_at, n.data,
                                        n.fixed, b.bits.occupied, b.bits.exterior, b.bits.boundary, b.marked,
                                        b.active, b.tractions, b.bits.carried.particle, b.bits.carried.cells,
                                        b.bits.carried.nodes, p.cell, p.xi, p.area, p.tractions, p.carrier,
                                        p.order, p.run_cell, p.run_first, p.cell_count);
}

template <int Dim, class Real, class State>
void LaneEngine<Dim, Real, State>::save(ByteSink& to) const {
  save_lanes<Dim>(state_, to);
}

template <int Dim, class Real, class State>
Restored LaneEngine<Dim, Real, State>::restore(ByteSource& saved) {
  return restore_lanes<Dim>(exec_, state_, saved) ? Restored::yes : Restored::other_particles;
}

}  // namespace vsb::app
