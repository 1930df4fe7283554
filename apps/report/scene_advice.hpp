// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What looks like a mistake in a scene that can be run all the same.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace vsb::app {

/// A sentence on the units where the loads strain the softest body by more than a tenth: most often a modulus
/// in MPa or GPa where Pa is meant. Empty where they do not.
std::string units_hint(const Scene& scene);

/// All of a scene's oddities, a sentence each.
std::vector<std::string> scene_advice(const Scene& scene);

/// On a state at rest whose particles crossed cells on linear functions; largest_displacement: m.
std::vector<std::string> crossing_advice(const Scene& scene, double largest_displacement);

/// On each load that is still short of its final value at the last possible step of an explicit run.
std::vector<std::string> short_run_advice(const Scene& scene);

}  // namespace vsb::app
