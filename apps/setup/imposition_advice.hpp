// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Where the surface of a body is not where an imposition takes it to be.
///
/// imposition = "nodal" loads the nodes of the faces between cells with particles and the others. These faces
/// must be the surface. Where the body ends before them, by a share g of a cell, a plane face has
/// 1 / (1 - g) times the stress of its load in the last cells: the same nodal forces meet less material.
///
/// imposition = "material_points" loads the particles nearest to the surface as if they lay on it. With
/// linear functions, a plane face in whose last cells the body reaches a share f deep, and whose particles
/// lie d cells below the surface, has (1 - d / f) times the stress of its load in those cells.
#pragma once

#include <string>
#include <vector>

#include "setup/field_advice.hpp"

namespace vsb::app {

/// Warnings, a sentence for each traction that misses its surface.
std::vector<std::string> imposition_advice(const Scene& scene, const PlacedParticles& placed,
                                           const OccupiedCells& grid);

}  // namespace vsb::app
