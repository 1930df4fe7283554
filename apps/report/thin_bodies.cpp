// SPDX-License-Identifier: BSD-3-Clause
#include "report/thin_bodies.hpp"

#include <fmt/format.h>

#include <cmath>

#include "setup/region_size.hpp"

namespace vsb::app {

namespace {

constexpr double round_off = 1e-6;  // of a cell
constexpr int enough_rows = 3;

/// Rows of particles between two coordinates in cells; enough where they lie on rings.
int rows_between(const Scene& scene, const BodySpec& body, size_t axis, double low, double high) {
  double spacing = 0, origin = 0;  // in cells
  if (const auto* cells = std::get_if<CellLattice>(&body.lattice)) {
    spacing = 1.0 / cells->particles_per_cell[axis];
  } else if (const auto* uniform = std::get_if<UniformLattice>(&body.lattice)) {
    spacing = uniform->spacing[axis] / scene.grid.spacing[axis];
    origin = (uniform->origin[axis] - scene.grid.lower[axis]) / scene.grid.spacing[axis];
  } else {
    return enough_rows;
  }
  const double first = (low - origin) / spacing + round_off, last = (high - origin) / spacing - round_off;
  if (body.boundary == BoundaryBoxes::keep)  // those whose middle lies in the body
    return static_cast<int>(std::floor(last + 0.5) - std::floor(first + 0.5));
  const int boxes = static_cast<int>(std::floor(last) - std::floor(first)) + 1;
  const bool is_cut = first - std::floor(first) > 2 * round_off || std::ceil(last) - last > 2 * round_off;
  return body.boundary == BoundaryBoxes::cut2x2 && is_cut ? 2 * boxes : boxes;
}

}  // namespace

std::vector<std::string> thin_body_advice(const Scene& scene) {
  std::vector<std::string> advice;
  if (scene.method.basis != BasisKind::quadratic_bspline) return advice;
  const auto grid = bounding_box(scene.grid, scene.dimension);
  for (const auto& body : scene.bodies) {
    const auto box = bounds_of(body.region, grid, scene.dimension);
    for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i) {
      const auto cells = [&](double x) { return (x - scene.grid.lower[i]) / scene.grid.spacing[i]; };
      const double low = cells(box.lower[i]), high = cells(box.upper[i]);
      const double middle = std::floor(low + round_off) + 0.5;
      if (high > middle + 0.5 + round_off || low > middle || high < middle) continue;
      const auto& faces = scene.faces.fixed[i];  // beyond one that holds it a body has its mirror image
      if (((faces[0] >> i & 1) != 0 && low < round_off) ||
          ((faces[1] >> i & 1) != 0 && high > scene.grid.cells[i] - round_off))
        continue;
      const int rows = rows_between(scene, body, i, low, high);
      if (rows >= enough_rows) continue;
      advice.push_back(fmt::format(
          "body '{}' is one cell thick along {}, with {} row{} of particles: with B-splines it bends there "
          "without any strain; give particles_per_cell = 3, two cells across it, or method.basis = "
          "\"linear\"",
          body.name, "xyz"[i], rows, rows == 1 ? "" : "s"));
    }
  }
  return advice;
}

}  // namespace vsb::app
