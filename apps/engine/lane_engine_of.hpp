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

namespace vsb::app {

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
  save_lanes<Dim>(state_, to);
}

template <int Dim, class Real, class State>
bool LaneEngine<Dim, Real, State>::restore(ByteSource& saved) {
  return restore_lanes<Dim>(exec_, state_, saved);
}

}  // namespace vsb::app
