// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Steps of a scene on cell lanes (kernels/lane_step.hpp), the fast way; and which scenes can go it.
#pragma once

#include <functional>
#include <memory>

#include <vsb/kernels/lane_step.hpp>
#include <vsb/kernels/lanes/loaded_cells.hpp>
#include <vsb/kernels/lanes/loads.hpp>
#include <vsb/kernels/readout/balance.hpp>
#include <vsb/kernels/readout/health.hpp>
#include "engine/byte_stream.hpp"
#include "engine/particle_reader.hpp"
#include "setup/execution_space.hpp"
#include "setup/loads.hpp"

namespace vsb::app {

/// Why a scene takes the particle kernels; empty where it takes the cell lanes. Throws SetupError where it
/// asks for the cell lanes and cannot have them.
std::string reason_for_particle_kernels(const Scene& scene);

/// State: LaneState for linear functions, SplineLaneState for quadratic B-splines.
template <int Dim, class Real, class State = LaneState<Dim, Real, ExecutionSpace::device_type>>
class LaneEngine {
 public:
  using Device = ExecutionSpace::device_type;

  struct Setup {
    UniformGrid<Dim, Real> grid;  ///< of the scene
    Walls<Dim> walls;
    BoundaryNodes<Device> tractions;   ///< [node of the basis' grid]: declared
    CarriedTractions<Device> carried;  ///< those that particles carry
    FaceCover<Device> cover;           ///< of the particles
    TractionMask conservative, original;
    int gauss_points;
    Material<Real> material;
    int state_size;  ///< of the material
    int particles;
    StepOptions<Dim, Real> options;
  };
  /// Takes the surface points, if there are any; the particles come with pack or restore.
  LaneEngine(const Setup& setup, const SurfacePoints<Dim, Real, Device>& surface);

  /// Packs the particles, which must lie in the grid. They are handed over: nobody needs them any more.
  void pack(ParticleBlock<Dim, Real, Device> block);

  /// Makes ready for a first step under these loads. Returns -1, or what step() returns of a surface point.
  int prepare(const Loads<Dim, Real>& loads);
  bool prepared() const { return state_.prepared; }
  /// Advances, and makes ready for another step, under the loads of that one. Returns -1, or the number of a
  /// particle that left the grid, or the number of particles plus that of a surface point that did.
  int step(const Loads<Dim, Real>& next);
  /// Writes the particles and the surface points back.
  void unpack(const Particles<Dim, Real, Device>& particles,
              const SurfacePoints<Dim, Real, Device>& surface) const;
  /// The same of places and masses alone.
  Particles<Dim, Real, Device> mass_points() const;
  int boundary_nodes() const;
  size_t bytes() const;

  /// Of the particles between steps.
  Invalid find_invalid() const;
  /// Whether lanes hold cells of the scene's grid, as `balance`, `for_each_cell` and `fields` need it.
  static constexpr bool on_cells = !State::splines;
  /// Whether all loads are virtual stresses as the sweeps take them, which is what `balance` knows.
  bool loaded_by_sweeps() const { return state_.surface.count() == 0 && state_.original == 0; }
  Balance<Dim> balance(const Loads<Dim, Real>& loads) const;
  /// Of some tractions of the sweeps.
  TractionResultant<Dim> resultant(const Loads<Dim, Real>& loads, TractionMask among) const;
  LoadedCells loaded_cells(TractionMask traction) const;
  /// strain [particle], of a plastic material.
  void equivalent_plastic_strain(const Kokkos::View<Real*, Device>& strain) const;
  /// Calls visit(particle, cell of the grid) for all of them, in any order.
  void for_each_cell(const std::function<void(int, const Vector<Dim, int>&)>& visit) const;
  /// Their fields, until the next step.
  std::unique_ptr<FieldSource> fields() const;

  /// The state bit by bit, and back; false where it is not one of this scene's.
  void save(ByteSink& to) const;
  bool restore(ByteSource& saved);

 private:
  int add_loads(const Loads<Dim, Real>& loads);

  Setup setup_;
  ExecutionSpace exec_;
  State state_;
};

}  // namespace vsb::app
