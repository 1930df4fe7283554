// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Advice on the energy that the paper's step feeds into a body.
#pragma once

#include <string>

#include "scene/scene.hpp"

namespace vsb::app {

/// Tells of a run whose positions follow another velocity than its strains (PositionVelocity::grid), long
/// enough for that to show, and damped too little to hold it; else empty. With the largest tension S of sigma
/// - sbar, the constrained modulus M and the wave speed c, a disturbance grows at 0.58 kappa (S / M) c / h
/// (1D, quadratic B-splines), unless Cundall's alpha is above 4.3 kappa S / M. S is known when the run is
/// over; here it is the largest virtual stress, which a body without stress of its own has from the start.
std::string energy_advice(const Scene& scene);

}  // namespace vsb::app
