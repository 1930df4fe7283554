// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Bodies at open faces of the grid.
#pragma once

#include <string>
#include <vector>

#include "setup/place_particles.hpp"

namespace vsb::app {

/// A sentence for each body that has particles in the outermost cells at an open face, from where a small
/// motion takes them out of the grid. None where nodal tractions act: their bodies follow the grid.
std::vector<std::string> open_face_advice(const Scene& scene, const PlacedParticles& placed);

}  // namespace vsb::app
