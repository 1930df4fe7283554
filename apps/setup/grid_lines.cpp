// SPDX-License-Identifier: BSD-3-Clause
#include "setup/grid_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "setup/setup_error.hpp"

namespace vsb::app {

ParticlesOnGridLines find_on_grid_lines(const Scene& scene, const PlacedParticles& placed) {
  const auto& grid = scene.grid;
  // In cells: above the round-off of a position, below any distance meant.
  std::array<double, 3> tolerance{};
  const auto box = bounding_box(grid, scene.dimension);
  for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i)
    tolerance[i] = 1e-9 + 4 * std::numeric_limits<double>::epsilon() *
                              std::max(std::abs(box.lower[i]), std::abs(box.upper[i])) / grid.spacing[i];
  ParticlesOnGridLines found{0, {}};
  for (const Point& x : placed.position) {
    bool on_line = false;
    for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i) {
      const double in_cells = (x[i] - grid.lower[i]) / grid.spacing[i], line = std::round(in_cells);
      if (line > 0 && line < grid.cells[i] && std::abs(in_cells - line) <= tolerance[i]) on_line = true;
    }
    if (on_line && found.count++ == 0) found.first = x;
  }
  return found;
}

void refuse_on_grid_lines(const Scene& scene, const PlacedParticles& placed) {
  const auto found = find_on_grid_lines(scene, placed);
  if (found.count == 0) return;
  const std::string what = fmt::format(
      "{} of {} particles lie on a grid line, the first at ({}, {}, {}), where the linear basis does not see "
      "the cell on one side",
      found.count, placed.position.size(), found.first[0], found.first[1], found.first[2]);
  if (!scene.method.allow_particles_on_grid_lines)
    throw SetupError(
        what +
        ": shift the grid, or choose another lattice (particles_per_cell, its origin or spacing), "
        "or set method.allow_particles_on_grid_lines = true");
  fmt::print(stderr, "vsb: warning: {}\n", what);
}

}  // namespace vsb::app
