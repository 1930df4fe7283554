// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Particles that are outside the grid: at which face they went, whether that lets them go, and whether the
/// body that they belong to is in health, or the run has diverged. Positions are those of the scene.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace vsb::app {

/// A face of the grid; side 0: lower, 1: upper.
struct GridFace {
  size_t axis, side;
};

/// "x_min".
std::string face_name(const Scene& scene, const GridFace& face);

/// The faces that a position outside the grid lies beyond, in order of the axes; at least one.
std::vector<GridFace> faces_passed(const Scene& scene, const Point& x);

/// A position in the grid near one outside it.
Point nearest_inside(const Scene& scene, const Point& x);

/// A speed beside the wave speed, and a stress beside the modulus: a body may move faster than its waves, and
/// one may be squeezed beyond its modulus, but a particle with both has them from a step that was unstable.
bool looks_unstable(double speed, double wave_speed, double stress, double modulus);

/// What went out of the grid at faces with "outflow".
struct OutflowReport {
  long long particles = 0, first_step = -1, last_step = -1;
  std::array<std::array<long long, 2>, 3> by_face{};  ///< particles; [axis][side]
  double mass_at_start = 0, mass_gone = 0;            ///< kg

  void add(long long step, const GridFace& face);
  /// The numbers but for the masses, and back.
  std::vector<std::int64_t> numbers() const;
  static OutflowReport from_numbers(const std::vector<std::int64_t>& numbers);
};

/// "12 particles, 3 kg, steps 10 to 20: 8 at x_min, 4 at y_max".
std::string outflow_text(const Scene& scene, const OutflowReport& outflow);

}  // namespace vsb::app
