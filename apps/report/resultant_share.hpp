// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The resultant of a scene's tractions as a share of what they load. On a closed body a uniform pressure has
/// none, so there the shares are errors.
#pragma once

#include "engine/simulation.hpp"

namespace vsb::app {

struct ResultantShare {
  double load = 0;       ///< sum over the tractions of the integral of |sbar n| over their surface, N
  double net_force = 0;  ///< |net force| / load
  double net_torque =
      0;  ///< |net torque about the middle| / (load, half width) of the smallest box around the particles
};

/// Of the balance of the initial state under the loads at a time, s.
ResultantShare resultant_share(const Scene& scene, const BalanceReport& balance,
                               const ParticleReader& initial, double time);

}  // namespace vsb::app
