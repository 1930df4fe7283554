// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// How particles that failed are removed in stages (Algorithm 2), as a scene gives it. Plain data.
#pragma once

#include <optional>

#include "scene/region.hpp"

namespace vsb::app {

/// The hole from which failure spreads: its surface at the start, and what counts as a row of particles.
struct HoleSpec {
  Point center{};
  int axis = -1;      ///< 0, 1, 2 of a round hole in 3D; -1 in 2D
  double radius = 0;  ///< m
  double row = 0;     ///< m, distance between rows of particles
};

struct RemovalSpec {
  double threshold = 0;   ///< of the equivalent plastic strain, Eq. (34)
  bool remap = true;      ///< whether particles are judged by the strain smoothed over the nodes
  bool reset = true;      ///< whether a stage begins with the body as it was at the start
  double damping = 0;     ///< Cundall's alpha, of stages that go on from the one before
  int max_stages = 0;     ///< equilibrium states
  long long settled = 0;  ///< steps without another failure after which a stage counts as at rest; 0: off
  double collapse = 0;    ///< share of the particles beyond the threshold that counts as collapse
  std::optional<HoleSpec> hole;  ///< none: failed particles are counted, and that is all
};

}  // namespace vsb::app
