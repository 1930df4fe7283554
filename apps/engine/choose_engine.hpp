// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Which of the two engines makes the steps of a scene: cell lanes where they can, else particle kernels.
#pragma once

#include <string>

#include "scene/scene.hpp"

namespace vsb::app {

/// Why a scene takes the particle kernels; empty where it takes the cell lanes. Throws SetupError where it
/// asks for the cell lanes and cannot have them.
std::string reason_for_particle_kernels(const Scene& scene);

}  // namespace vsb::app
