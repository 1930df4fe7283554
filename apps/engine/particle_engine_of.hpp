// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The members of ParticleEngine, compiled for each dimension and precision once for all bases.
#pragma once

#include <vsb/kernels/readout/plastic_strain.hpp>
#include "engine/block_fields.hpp"
#include "engine/particle_engine.hpp"
#include "engine/saved_block.hpp"

namespace vsb::app {

template <int Dim, class Real>
ParticleEngine<Dim, Real>::ParticleEngine(Model<Dim, Real>& model)
    : model_(model), block_(allocate_bodies<Dim, Real, Device>(model.bodies, model.for_lanes)) {}

template <int Dim, class Real>
void ParticleEngine<Dim, Real>::fill(const PlacedParticles& placed) {
  fill_particles(model_.scene, placed, model_.ids, model_.bodies, block_);
  if (block_.state_block.size() > 0) Kokkos::deep_copy(block_.state_block, Real(0));
}

template <int Dim, class Real>
void ParticleEngine<Dim, Real>::keep(const Kept& kept) {
  block_ = keep_in_block(exec_, block_, kept);
  state_.particles = block_.particles;
  state_.occupancy.bins = make_bins();
  state_.occupancy.cells.carried.particle = model_.carried.particle;
}

template <int Dim, class Real>
ParticleBlock<Dim, Real, typename ParticleEngine<Dim, Real>::Device> ParticleEngine<Dim, Real>::release() {
  state_ = {};
  return std::move(block_);
}

template <int Dim, class Real>
void ParticleEngine<Dim, Real>::settle() {
  for (int lost = 0; lost >= 0;) {
    lost = locate();
    if (lost >= 0) let_go(lost);
  }
}

template <int Dim, class Real>
void ParticleEngine<Dim, Real>::balance_loads() {
  model_.loads.balance(exec_, state_.particles, model_.near);
}

template <int Dim, class Real>
size_t ParticleEngine<Dim, Real>::bytes() const {
  const auto bytes = [](const auto&... views) { return (... + (views.span() * sizeof(*views.data()))); };
  const auto& o = state_.occupancy;
  const auto& n = state_.nodes;
  return static_cast<size_t>(block_.particles.count() * block_.columns()) * sizeof(Real) +
         bytes(block_.state_block, n.sums, n.acceleration, n.velocity, n.remapped_velocity,
               n.fixed_components, o.bins.bin, o.bins.order, o.bins.offset, o.bins.cursor, o.bins.slot,
               o.bins.occupied, o.cells.occupied, o.cells.exterior, o.cells.boundary, o.cells.underfilled,
               o.cells.outside, o.cells.carried.particle, o.cells.carried.cells, o.cells.carried.nodes,
               o.boundary, state_.sums_workspace.particles.bin_sums, state_.remap_workspace.bin_sums,
               state_.mean_divergence.of_particle, state_.mean_divergence.of_function,
               state_.mean_divergence.sums, state_.mean_divergence.workspace.bin_sums);
}

template <int Dim, class Real>
Invalid ParticleEngine<Dim, Real>::find_invalid() const {
  return vsb::find_invalid(exec_, state_.particles);
}

template <int Dim, class Real>
std::unique_ptr<FieldSource> ParticleEngine<Dim, Real>::fields() {
  const auto flags = [engine = this->shared_from_this()] {  // which lives as long as the fields do
    engine->settle();
    const Flags found("vsb::boundary_particles", static_cast<size_t>(engine->model_.particle_count()));
    engine->flag_boundary(found);
    engine->exec_.fence();
    return found;
  };
  return std::make_unique<BlockFields<Dim, Real>>(exec_, state_.particles, model_.bodies, flags);
}

template <int Dim, class Real>
void ParticleEngine<Dim, Real>::equivalent_plastic_strain(const Kokkos::View<Real*, Device>& strain) const {
  for (const auto& body : model_.bodies)
    if (is_plastic(body.material))
      vsb::equivalent_plastic_strain(exec_, state_.particles, body.first, body.last, body.state_offset,
                                     strain);
}

template <int Dim, class Real>
void ParticleEngine<Dim, Real>::save(ByteSink& to) const {
  save_block(block_, state_, to);
}

template <int Dim, class Real>
Restored ParticleEngine<Dim, Real>::restore(ByteSource& saved) {
  if (!restore_block(saved, block_, state_)) return Restored::other_particles;
  return locate() < 0 ? Restored::yes : Restored::outside_grid;
}

}  // namespace vsb::app
