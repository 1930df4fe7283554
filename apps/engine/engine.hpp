// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The interface of the two engines. An engine holds the particles of a scene, makes their steps, and tells
/// what a simulation asks about them.
///   ParticleEngine  particle kernels (kernels/step.hpp): any grid, any basis, all that a scene can ask for;
///   LaneEngine      cell lanes (kernels/lane_step.hpp), faster, for the scenes that they can take.
/// What cell lanes cannot tell by themselves they ask a ParticleEngine to which they copy their particles.
/// Whoever uses an engine need not know which of the two it is.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include <vsb/kernels/readout/balance.hpp>
#include <vsb/kernels/readout/health.hpp>
#include <vsb/kernels/readout/loaded_cells.hpp>
#include "engine/byte_stream.hpp"
#include "engine/model.hpp"
#include "engine/particle_reader.hpp"

namespace vsb::app {

/// What a step came to.
struct StepOutcome {
  bool made;  ///< whether the state is that of the next step
  int lost;   ///< a particle outside the grid, or the number of particles plus that of a surface point; or -1
};

/// What some tractions on boundary nodes do.
template <int Dim>
struct TractionAction {
  TractionResultant<Dim> resultant;
  LoadedCells cells;
};

enum class Restored { yes, other_particles, outside_grid };

template <int Dim, class Real>
class Engine {
 public:
  using Device = ExecutionSpace::device_type;

  virtual ~Engine() = default;

  /// Makes a step, under the gravity of the model. set_loads(n) sets the tractions of the model to those at
  /// the end of the n-th step from here.
  virtual StepOutcome step(const std::function<void(int)>& set_loads) = 0;
  /// Lets the particles outside the grid go (Model::let_go), and finds the cells of the others.
  virtual void settle() = 0;
  /// Takes the resultant out of the self-balanced loads of the model, for the particles where they are now.
  virtual void balance_loads() = 0;
  /// The particles for the particle kernels: this engine, or one to which cell lanes copy theirs.
  virtual std::shared_ptr<ParticleEngine<Dim, Real>> particles() = 0;

  virtual int boundary_nodes() const = 0;
  /// Memory of particles, nodes and occupancy.
  virtual size_t bytes() const = 0;
  virtual Invalid find_invalid() const = 0;
  /// Under the loads of the model.
  virtual Balance<Dim> balance() = 0;
  /// Of each of some sets of tractions, under the loads of the model.
  virtual std::vector<TractionAction<Dim>> act(const std::vector<TractionMask>& tractions) = 0;
  /// The fields of the particles; until the next step.
  virtual std::unique_ptr<FieldSource> fields() = 0;
  /// strain [particle]; particles of bodies that are not plastic keep what is there.
  virtual void equivalent_plastic_strain(const Kokkos::View<Real*, Device>& strain) const = 0;
  /// Smooths q [particle] over the nodes.
  virtual void smooth(const Kokkos::View<Real*, Device>& q) = 0;
  /// Calls visit(particle, cell of the scene's grid along x first) for all of them, in any order.
  virtual void for_each_cell(const std::function<void(int, size_t)>& visit) = 0;

  /// The state bit by bit, and back.
  virtual void save(ByteSink& to) const = 0;
  virtual Restored restore(ByteSource& saved) = 0;
};

}  // namespace vsb::app
