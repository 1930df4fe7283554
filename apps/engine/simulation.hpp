// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A scene in motion: particles, grid and loads, advanced step by step. The interface hides dimension,
/// precision and device; what goes in and out is host memory in double precision.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/byte_stream.hpp"
#include "engine/leaving.hpp"
#include "engine/particle_reader.hpp"
#include "scene/scene.hpp"
#include "setup/body_volumes.hpp"
#include "setup/setup_error.hpp"

namespace vsb::app {

/// A run that has become meaningless; the text names step, time, particle and field.
struct Diverged : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A healthy body that went out of the grid, where nothing says that it may; the text names step, time,
/// particle, position and face. Or all particles that there were went where they may. The state can be read,
/// not advanced.
struct LeftGrid : std::runtime_error {
  LeftGrid(const std::string& text, bool all_let_go) : std::runtime_error(text), all(all_let_go) {}
  bool all;  ///< they were let go
};

/// A static state that was not found; the text says how far it got.
struct NotStatic : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The nodes at one moment, under the loads of that moment, and their velocity after another step; nodes
/// along x first.
struct GridSnapshot {
  std::vector<double> mass, velocity, force;
  std::vector<unsigned char> boundary;  ///< 1 where a traction acts
};

/// How far from equilibrium; see kernels/readout/balance.hpp.
struct BalanceReport {
  double force_ratio = 1, energy_ratio = 0;
  Point net_force{}, net_torque{};      ///< of the tractions as imposed
  Point exact_force{}, exact_torque{};  ///< of the tractions on the initial surface of the bodies
  Point torque_about{};  ///< the bodies' centre of mass at the start, m: the torques are about it
};

/// What a traction that acts on boundary nodes does at the moment, at full load.
struct TractionState {
  size_t traction = 0;                  ///< number in the scene
  Point force{};                        ///< its resultant, N
  double load = 0;                      ///< integral of |sbar n| over its surface at the start, N
  Point exact_force{};                  ///< the resultant of that surface, N
  int whole_cells = 0, part_cells = 0;  ///< that it loads; see kernels/readout/loaded_cells.hpp
};

/// What the void filter keeps from the boundary; see kernels/boundary/filter_voids.hpp.
struct VoidFilterReport {
  int false_voids = 0, dropped_nodes = 0;
};

/// What solve_static found.
struct StaticSolution {
  int iterations = 0;
  double residual = 1;  ///< relative; see kernels/statics/static_solution.hpp
  bool converged = false;
  double largest_strain = 0;  ///< of a component
  BalanceReport balance;      ///< at the initial positions
};

/// What a run that removes particles has beside the particles that are left.
struct StagedState {
  std::vector<unsigned char> present;  ///< [particle at the start]: not 0 where it is left
  long long loads_begin = 0;           ///< the step of the last reset
  std::string stages;                  ///< of run/stages.hpp, where there are stages
  std::vector<std::int64_t> outflow;   ///< OutflowReport::numbers
};

/// How a run goes on after a removal of particles.
struct Restart {
  bool reset = false;             ///< from the state of the start, loads included; else from the present one
  std::optional<double> damping;  ///< Cundall's alpha from now on, where it changes
};

/// What the state of a run is beside the bits of its particles.
struct SavedState {
  long long step = 0;
  size_t bytes_per_number = 0;
  StagedState staged;
};

enum class CellContent : unsigned char { nothing, particles, marked };

class Simulation {
 public:
  virtual ~Simulation() = default;

  virtual int particle_count() const = 0;
  virtual long long step() const = 0;
  /// Of the step, s.
  virtual double time() const = 0;
  /// The time that the loads have acted, s: since the start, or since the last reset.
  virtual double load_time() const = 0;
  virtual int boundary_nodes() const = 0;
  /// Of the bodies with cut lattices, at the start.
  virtual CutVolume cut_volume() const = 0;
  /// Of the bodies at the start.
  virtual const std::vector<BodyVolume>& body_volumes() const = 0;
  virtual MomentFit moment_fit() const = 0;
  /// Of the boundary nodes of the moment; zeros without the filter.
  virtual VoidFilterReport void_filter() const = 0;
  /// What looks wrong about the virtual stress fields, a sentence each; see setup/field_advice.hpp.
  virtual std::vector<std::string> advice() const = 0;
  /// Why the scene is not run on cell lanes; empty where it is (engine/choose_engine.hpp).
  virtual std::string why_not_lanes() const = 0;
  /// Memory of particles, nodes and occupancy at present.
  virtual size_t state_bytes() const = 0;

  /// What left the grid at faces with "outflow" so far.
  virtual OutflowReport outflow() const = 0;

  /// Makes `steps` steps; particles that leave the grid at faces with "outflow" are removed. Throws LeftGrid
  /// when others leave it, or Diverged where the state looks as if the steps were unstable.
  virtual void advance(long long steps) = 0;
  /// Gives the particles of step 0 the stress and the displacement of the static state under the loads of
  /// time t, s, where it is found. go_on(iteration, residual) may end the search. Throws SetupError where a
  /// load has no support.
  virtual StaticSolution solve_static(double t, const std::function<bool(int, double)>& go_on) = 0;
  /// What no support takes up of the particles' stress, weight and the loads of time t, s, in words; empty
  /// where the supports take up all but a thousandth of the nodal forces.
  virtual std::string unsupported_load(double t) = 0;
  /// Adds random velocities to those of the particles, from -speed to speed, m/s, in every direction; for the
  /// same particles always the same ones.
  virtual void disturb(double speed) = 0;
  /// Throws Diverged when a field of a particle is not finite or a volume is not positive.
  virtual void check_health() = 0;
  /// The balance of the present state under the loads of the present or of a given time, s.
  virtual BalanceReport balance() = 0;
  virtual BalanceReport balance_under_loads_at(double t) = 0;
  /// Of the tractions that act on boundary nodes, in the present state.
  virtual std::vector<TractionState> traction_states() = 0;
  virtual std::unique_ptr<ParticleReader> read_particles() = 0;
  virtual GridSnapshot grid_snapshot() = 0;
  /// The equivalent plastic deviatoric strain (Eq. (34)) of every particle, smoothed over the nodes or as it
  /// is. Zero in bodies that are not plastic.
  virtual std::vector<double> equivalent_plastic_strain(bool smoothed) = 0;
  /// Volume of the particles with a plastic strain, m^3 (m^2 in 2D).
  virtual double yielded_volume() = 0;
  /// What is in the cells of the scene's grid, along x first: nothing, particles, or in the main those with a
  /// 1 in `marked`.
  virtual std::vector<CellContent> cell_contents(const std::vector<unsigned char>& marked) = 0;
  /// Removes the particles with a 1; those that stay keep order and ids. Steps are counted on.
  virtual void remove(const std::vector<unsigned char>& removed, const Restart& restart) = 0;
  virtual SavedState saved_state() const = 0;
  /// The particles bit by bit: raw columns without padding, surface points, void filter.
  virtual void save_particles(ByteSink& to) = 0;
  /// Throws SetupError where the saved state does not fit this scene.
  virtual void restore(const SavedState& saved, ByteSource& particles) = 0;
};

/// Of the saved particles; equal for equal bits.
std::string state_hash(Simulation& simulation);

/// Particles the scene will have; needs no Kokkos. Throws SetupError.
int count_particles(const Scene& scene);

/// Places the particles, finds the boundary nodes and checks that every traction acts somewhere. `placed`:
/// the particles, where they have been placed already, which the simulation takes. Throws SetupError.
std::unique_ptr<Simulation> make_simulation(const Scene& scene, PlacedParticles* placed = nullptr);

}  // namespace vsb::app
