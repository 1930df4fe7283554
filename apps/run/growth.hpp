// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The rate at which the step lets a small disturbance of a state grow: that of the linearised step, without
/// its matrix.
#pragma once

#include "engine/simulation.hpp"

namespace vsb::app {

/// 1/s: two copies of the present state go on under the loads of the scene, with the damping of scene.growth.
/// The particles of one get small random velocities. What the velocities differ by grows as exp(rate t); the
/// rate is that of its mean square over the second half of the time. A state that keeps vibrating has 0, one
/// that comes to rest less. What grows by a factor of a million is not followed further. Particles must not
/// cross cells by themselves meanwhile: the state should be at rest. Not a number where they leave the grid
/// before the rate can be told.
double growth_rate(const Scene& scene, Simulation& at);

}  // namespace vsb::app
