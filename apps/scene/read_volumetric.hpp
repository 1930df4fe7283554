// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Reads method.volumetric of a scene whose bodies and basis are known.
#pragma once

#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

/// The Poisson ratio from which on bodies lock that strain by their own divergence: errors of the stress
/// there are several times those at 0.2.
constexpr double locking_poisson_ratio = 0.4;

/// Whether one of the bodies has such a Poisson ratio.
bool may_lock(const Scene& scene);

void read_volumetric(TableReader& method, Scene& scene);

}  // namespace vsb::app
