// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The engine of the cell lanes (kernels/lane_step.hpp), the fast one; choose_engine.hpp says which scenes
/// can take it.
#pragma once

#include <vsb/kernels/lane_step.hpp>
#include <vsb/kernels/lanes/loaded_cells.hpp>
#include "engine/scene_basis.hpp"

namespace vsb::app {

/// State: LaneState for linear functions, SplineLaneState for quadratic B-splines.
template <int Dim, class Real, class State>
class LaneEngine final : public Engine<Dim, Real> {
 public:
  using typename Engine<Dim, Real>::Device;

  /// Takes the surface points, if there are any; the particles come with pack or restore. The basis is that
  /// of the engines to which particles are lent.
  LaneEngine(Model<Dim, Real>& model, const SceneBasis<Dim, Real>& basis);

  /// Packs the particles, which must lie in the grid. They are handed over: nobody needs them any more.
  void pack(ParticleBlock<Dim, Real, Device> block);

  /// Makes ready for a first step, if need be; advances; and makes ready for another step.
  StepOutcome step(const std::function<void(int)>& set_loads) override;
  void settle() override {}         // a step tells which particles left, and lanes hold the others
  void balance_loads() override {}  // lanes take no self-balanced loads
  std::shared_ptr<ParticleEngine<Dim, Real>> particles() override;

  int boundary_nodes() const override;
  size_t bytes() const override;
  Invalid find_invalid() const override;
  Balance<Dim> balance() override;
  std::vector<TractionAction<Dim>> act(const std::vector<TractionMask>& tractions) override;
  std::unique_ptr<FieldSource> fields() override;
  /// Of all bodies: they have one material, which must be plastic.
  void equivalent_plastic_strain(const Kokkos::View<Real*, Device>& strain) const override;
  void smooth(const Kokkos::View<Real*, Device>& q) override;
  void for_each_cell(const std::function<void(int, size_t)>& visit) override;

  void save(ByteSink& to) const override;
  Restored restore(ByteSource& saved) override;

 private:
  /// Makes ready for a step under the loads of the model. Returns -1, or what add_loads() does.
  int prepare();
  /// Adds the loads that the sweeps do not take. Returns -1, or the number of particles plus that of a
  /// surface point outside the grid.
  int add_loads();
  int advance();
  /// Whether all loads are virtual stresses as the sweeps take them, which is what lanes can sum.
  bool loaded_by_sweeps() const { return state_.surface.count() == 0 && state_.original == 0; }

  Model<Dim, Real>& model_;
  const SceneBasis<Dim, Real>& basis_;
  ExecutionSpace exec_;
  State state_;
};

}  // namespace vsb::app
