// SPDX-License-Identifier: BSD-3-Clause
#include "setup/open_faces.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace vsb::app {

namespace {

/// The inner node coordinates of the outermost cells along a logical axis.
std::pair<double, double> inner_lines(const GridSpec& grid, size_t axis) {
  if (grid.mapped()) {
    const auto& nodes = grid.coordinates[axis];
    return {nodes[1], nodes[nodes.size() - 2]};
  }
  const auto [low, high] = extent(grid, axis);
  return {low + grid.spacing[axis], high - grid.spacing[axis]};
}

}  // namespace

std::vector<std::string> open_face_advice(const Scene& scene, const PlacedParticles& placed) {
  if (std::any_of(scene.tractions.begin(), scene.tractions.end(),
                  [](const TractionSpec& t) { return t.imposition == Imposition::nodal; }))
    return {};
  std::vector<std::string> advice;
  for (size_t b = 0; b < scene.bodies.size(); ++b)
    for (size_t axis = 0; axis < static_cast<size_t>(scene.dimension); ++axis)
      for (size_t side = 0; side < 2; ++side) {
        if (scene.faces.fixed[axis][side] != 0 || scene.faces.outflow[axis][side]) continue;
        const auto [low, high] = inner_lines(scene.grid, axis);
        const auto is_outermost = [&, low = low, high = high](const Point& x) {
          const double q = logical_coordinates(scene.grid, x)[axis];
          return side == 0 ? q < low : q > high;
        };
        const auto first = placed.position.begin() + placed.bodies[b].first;
        const auto last = placed.position.begin() + placed.bodies[b].last;
        const auto found = std::find_if(first, last, is_outermost);
        if (found == last) continue;
        advice.push_back(fmt::format(
            "body '{}' has particles in the last cells before the open face {}_{}, the first at ({:.6g}, "
            "{:.6g}, {:.6g}): one that moves beyond the face ends the run; leave at least one empty cell "
            "there, or give the face a condition",
            scene.bodies[b].name, scene.grid.axis_name(axis), side == 0 ? "min" : "max", (*found)[0],
            (*found)[1], (*found)[2]));
      }
  return advice;
}

}  // namespace vsb::app
