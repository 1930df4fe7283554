// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// SceneBasis for each basis. This is where cell lanes are assigned to bases.
#pragma once

#include "engine/lane_engine.hpp"
#include "engine/particle_engine_on.hpp"
#include "engine/scene_basis.hpp"
#include "setup/check_tractions.hpp"
#include "setup/field_advice.hpp"
#include "setup/set_up_surface.hpp"

namespace vsb::app {

/// The state of the lanes of a basis; void where it has none.
template <class Basis>
struct LanesOf {
  using State = void;
};
template <int Dim, class Real>
struct LanesOf<LinearBasis<Dim, Real>> {
  using State = LaneState<Dim, Real, ExecutionSpace::device_type>;
};
template <int Dim, class Real>
struct LanesOf<QuadraticBSplineBasis<Dim, Real>> {
  using State = SplineLaneState<Dim, Real, ExecutionSpace::device_type>;
};

template <int Dim, class Real, class Basis>
class SceneBasisOf final : public SceneBasis<Dim, Real> {
 public:
  using typename SceneBasis<Dim, Real>::Device;
  using Particle = ParticleEngineOn<Dim, Real, Basis>;

  explicit SceneBasisOf(const Scene& scene) : bases_(scene, local_origin(scene)) {}

  TractionMask place_loads(Model<Dim, Real>& model, const PlacedParticles& placed) const override {
    model.declared = declared_tractions<Device>(model.scene, bases_.owned.basis,
                                                model.loads.on_nodes() & ~carried_tractions(model.scene));
    const auto surface = place_surface_points<Real, Device>(model.scene, bases_.host.basis, placed);
    model.surface = surface.points;
    return surface.tractions;
  }

  std::shared_ptr<ParticleEngine<Dim, Real>> make_particle_engine(Model<Dim, Real>& model) const override {
    return std::make_shared<Particle>(model, bases_);
  }

  std::shared_ptr<Engine<Dim, Real>> make_lane_engine(
      Model<Dim, Real>& model, std::shared_ptr<ParticleEngine<Dim, Real>> from) const override {
    using State = typename LanesOf<Basis>::State;
    if constexpr (runs_on_host && !std::is_void_v<State>) {
      auto lanes = std::make_shared<LaneEngine<Dim, Real, State>>(model, *this);
      if (!from) return lanes;
      auto block = from->release();
      from.reset();
      lanes->pack(std::move(block));
      return lanes;
    } else {
      return from;  // nobody asks for lanes (choose_engine.hpp)
    }
  }

  std::vector<std::string> check_start(const Model<Dim, Real>& model, const ParticleEngine<Dim, Real>& engine,
                                       TractionMask on_surface,
                                       const PlacedParticles& placed) const override {
    const auto& scene = model.scene;
    const auto& basis = bases_.host.basis;
    const auto& occupancy = static_cast<const Particle&>(engine).occupancy();
    check_tractions(scene, basis, occupancy, model.loads, on_surface, model.carried_at_start, placed);
    auto inside = occupied_cells(scene, basis, placed);
    if (scene.method.void_filter) add_voids<Device>(scene, basis, occupancy.cells.outside, inside);
    return field_advice(scene, placed, inside);
  }

  bool smooth(const Particles<Dim, Real, Device>& points, Scatter scatter,
              const Kokkos::View<Real*, Device>& q) const override {
    const ExecutionSpace exec;
    const auto& basis = bases_.owned.basis;
    auto bins = allocate_bins<Device>(points.count(), basis.bin_count());
    if (locate_particles(exec, points, bins, basis).lost >= 0) return false;
    sort_by_bin(exec, bins);
    smooth_particles(exec, points, bins, basis, q, scatter);
    return true;
  }

 private:
  BasisCopies<Basis> bases_;
};

}  // namespace vsb::app
