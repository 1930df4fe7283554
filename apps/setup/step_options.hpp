// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What of a scene a step takes as it is, and gravity, which varies in time.
#pragma once

#include <vsb/kernels/step.hpp>
#include "scene/scene.hpp"

namespace vsb::app {

/// Gravity at time t of the loads, s.
template <int Dim, class Real>
Vector<Dim, Real> gravity_at(const Scene& scene, double t) {
  const double factor = scene.gravity_time(t);
  Vector<Dim, Real> gravity;
  for (int i = 0; i < Dim; ++i)
    gravity[i] = static_cast<Real>(factor * scene.gravity[static_cast<size_t>(i)]);
  return gravity;
}

/// Gravity apart, which is that of no time yet.
template <int Dim, class Real>
StepOptions<Dim, Real> step_options(const Scene& scene) {
  StepOptions<Dim, Real> options{};
  options.dt = static_cast<Real>(scene.time.dt);
  options.damping = static_cast<Real>(scene.method.damping);
  options.pic = static_cast<Real>(scene.method.pic);
  if (scene.method.volume_update == "exponential") options.volume_update = ExponentialVolume{};
  options.scatter = scene.method.scatter == "atomic"       ? Scatter::atomic
                    : scene.method.scatter == "duplicated" ? Scatter::duplicated
                                                           : Scatter::gathered;
  options.position_velocity = scene.method.moves_by_grid ? PositionVelocity::grid : PositionVelocity::strain;
  if (scene.method.averaged) options.volumetric = Volumetric::averaged;
  return options;
}

}  // namespace vsb::app
