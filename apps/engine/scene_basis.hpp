// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The basis of a scene as a simulation uses it, which need not know the basis' type: it enters the loads,
/// checks the start, and makes the engines.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/particle_engine.hpp"

namespace vsb::app {

template <int Dim, class Real>
class SceneBasis {
 public:
  using Device = ExecutionSpace::device_type;

  virtual ~SceneBasis() = default;

  /// Enters the declared tractions and the surface points. Returns the tractions of the points.
  virtual TractionMask place_loads(Model<Dim, Real>& model, const PlacedParticles& placed) const = 0;
  /// With the particles of the model, all at zero.
  virtual std::shared_ptr<ParticleEngine<Dim, Real>> make_particle_engine(Model<Dim, Real>& model) const = 0;
  /// With the particles of an engine, which it gives up; without one, with those to be restored.
  virtual std::shared_ptr<Engine<Dim, Real>> make_lane_engine(
      Model<Dim, Real>& model, std::shared_ptr<ParticleEngine<Dim, Real>> from) const = 0;
  /// Throws SetupError where a traction would not act as declared. Returns what looks wrong about the virtual
  /// stress fields, a sentence each. on_surface: the tractions of surface points.
  virtual std::vector<std::string> check_start(const Model<Dim, Real>& model,
                                               const ParticleEngine<Dim, Real>& engine,
                                               TractionMask on_surface,
                                               const PlacedParticles& placed) const = 0;
  /// Smooths q of some points over the nodes. False, and nothing is done, where one is outside the grid.
  virtual bool smooth(const Particles<Dim, Real, Device>& points, Scatter scatter,
                      const Kokkos::View<Real*, Device>& q) const = 0;
};

}  // namespace vsb::app
