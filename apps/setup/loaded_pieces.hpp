// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Which particles carry the surface of a traction with imposition = "material_points".
#pragma once

#include <vector>

#include "setup/body_surface.hpp"
#include "setup/place_particles.hpp"

namespace vsb::app {

/// A piece of surface and the particle of the traction's layer that is nearest to it, whose load it is.
struct LoadedPiece {
  SurfacePiece piece;
  int particle;
};

/// The pieces on which a traction acts. Throws SetupError for one that has no particle near it.
std::vector<LoadedPiece> loaded_pieces(const Scene& scene, size_t traction, const PlacedParticles& placed);

}  // namespace vsb::app
