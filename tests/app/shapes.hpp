// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What the tests of the program's parts share: scenes made by hand.
#pragma once

#include "scene/scene.hpp"
#include "support.hpp"

namespace vsb::test {

/// An open grid of cubic cells from `lower` on, without a body.
inline app::Scene grid_scene(int dimension, double lower, double spacing, int cells) {
  app::Scene scene;
  scene.dimension = dimension;
  for (size_t i = 0; i < static_cast<size_t>(dimension); ++i) {
    scene.grid.lower[i] = lower;
    scene.grid.spacing[i] = spacing;
    scene.grid.cells[i] = cells;
  }
  return scene;
}

/// Adds a body with a lattice of n points per cell and direction.
inline app::BodySpec& add_body(app::Scene& scene, const app::Region& region, int n,
                               app::BoundaryBoxes boundary) {
  scene.bodies.emplace_back();
  auto& body = scene.bodies.back();
  body.name = "body " + std::to_string(scene.bodies.size());
  body.region = region;
  body.lattice = app::CellLattice{{n, n, n}};
  body.boundary = boundary;
  body.density = 1000;
  body.material = {app::MaterialLaw::linear_elastic, 1e6, 0.2};
  return body;
}

}  // namespace vsb::test
