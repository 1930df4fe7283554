// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Steps of a scene on cell lanes (kernels/lane_step.hpp), the fast way; and which scenes can go it.
#pragma once

#include <memory>

#include <vsb/kernels/lane_loads.hpp>
#include <vsb/kernels/spline_lane_step.hpp>
#include "run/execution_space.hpp"
#include "run/loads.hpp"

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
    BoundaryNodes<Device> tractions;  ///< [node of the basis' grid]: declared
    TractionMask conservative, original;
    int gauss_points;
    Material<Real> material;
    int state_size;  ///< of the material
    StepOptions<Dim, Real> options;
  };
  /// Packs the particles, which must lie in the grid, and the surface points, if there are any.
  LaneEngine(const Setup& setup, const Particles<Dim, Real, Device>& particles,
             const SurfacePoints<Dim, Real, Device>& surface);

  /// Makes ready for a first step under these loads. Returns -1, or what step() returns of a surface point.
  int prepare(const Loads<Dim, Real>& loads);
  bool prepared() const { return prepared_; }
  /// Advances, and makes ready for another step, under the loads of that one. Returns -1, or the number of a
  /// particle that left the grid, or the number of particles plus that of a surface point that did.
  int step(const Loads<Dim, Real>& next);
  /// Writes the particles and the surface points back.
  void unpack(const Particles<Dim, Real, Device>& particles,
              const SurfacePoints<Dim, Real, Device>& surface) const;
  int boundary_nodes() const;
  size_t bytes() const;

  /// The state bit by bit, and back; false where it is not one of this scene's.
  std::vector<unsigned char> save() const;
  bool restore(const std::vector<unsigned char>& saved);

 private:
  int add_loads(const Loads<Dim, Real>& loads);

  Setup setup_;
  ExecutionSpace exec_;
  State state_;
  bool prepared_ = false;
};

}  // namespace vsb::app
