// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The engine of the particle kernels, whatever its basis: the memory of the particles, and what can be told
/// of them without basis functions. particle_engine_on.hpp adds what needs some.
#pragma once

#include <memory>
#include <vector>

#include <vsb/kernels/statics/static_solution.hpp>
#include <vsb/kernels/statics/unsupported_load.hpp>
#include "engine/engine.hpp"
#include "engine/read_rows.hpp"
#include "engine/simulation.hpp"
#include "engine/solve_static.hpp"

namespace vsb::app {

template <int Dim, class Real>
class ParticleEngine : public Engine<Dim, Real>,
                       public std::enable_shared_from_this<ParticleEngine<Dim, Real>> {
 public:
  using Device = ExecutionSpace::device_type;

  /// Places the particles of the model in their state at the start.
  void fill(const PlacedParticles& placed);
  /// Keeps these particles alone, after the model has (Model::keep).
  void keep(const Kept& kept);
  ParticleBlock<Dim, Real, Device>& block() { return block_; }
  /// Gives the particles up, and all memory with them.
  ParticleBlock<Dim, Real, Device> release();
  const SurfacePoints<Dim, Real, Device>& surface() const { return state_.surface; }

  /// Whether a position is inside the grid.
  virtual bool contains(const Vector<Dim, Real>& x) const = 0;
  /// The static state under the loads of the model; the particles get its stress, if it is found.
  virtual StaticState<Dim, Real, Device> solve_static(const std::function<bool(int, double)>& go_on) = 0;
  /// Moves the particles with a displacement of the nodes.
  virtual void displace(const typename Nodes<Dim, Real, Device>::Fields& displacement) = 0;
  /// What no support takes up of the loads of the model.
  virtual UnsupportedLoad<Dim> unsupported_load(double tolerance) = 0;
  /// The nodes under the loads of the model.
  virtual GridSnapshot grid_snapshot() = 0;
  virtual VoidFilterReport void_filter() const = 0;

  std::shared_ptr<ParticleEngine<Dim, Real>> particles() override { return this->shared_from_this(); }
  void settle() override;
  void balance_loads() override;
  int boundary_nodes() const override { return state_.occupancy.boundary_node_count; }
  size_t bytes() const override;
  Invalid find_invalid() const override;
  std::unique_ptr<FieldSource> fields() override;
  void equivalent_plastic_strain(const Kokkos::View<Real*, Device>& strain) const override;
  void save(ByteSink& to) const override;
  Restored restore(ByteSource& saved) override;

 protected:
  /// The particles of the model, all at zero.
  explicit ParticleEngine(Model<Dim, Real>& model);

  /// Finds the cells of the particles. Returns -1, or the lowest number of one outside the grid.
  virtual int locate() = 0;
  virtual ParticleBins<Device> make_bins() const = 0;
  /// 1 in `flags` for the particles near a node with a traction.
  virtual void flag_boundary(const Flags& flags) const = 0;
  /// Hands a particle or a surface point outside the grid to whoever decides; see Model::let_go.
  void let_go(int lost) { model_.let_go(*this, lost); }

  Model<Dim, Real>& model_;
  ExecutionSpace exec_;
  ParticleBlock<Dim, Real, Device> block_;
  State<Dim, Real, Device> state_;
};

}  // namespace vsb::app
