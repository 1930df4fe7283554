// SPDX-License-Identifier: BSD-3-Clause
#include "setup/local_origin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "setup/setup_error.hpp"

namespace vsb::app {

namespace {

/// Round-off of a position in single precision, in cells, up to which steps are of use. Measured on a column
/// of 16 cells that settles by 0.023 cells under its own weight, at the far end of longer and longer grids,
/// beside double precision. Particle kernels add what a particle moves in a step to its position: the
/// settlement is off by 0.6, 1.9, 1.7, 31 and 40 % with 240, 840 (the limit), 1680, 3360 and 6720 cells, and
/// with 16800 nothing settles. Lanes add it to the position in the cell: the stress is off by 3e-6 at any
/// length, and the settlement by what a frame can tell, 0.1, 0.4 and 0.6 % with 840, 3360 and 16800 (the
/// limit) cells.
constexpr double coarsest_position = 5e-5, coarsest_position_on_lanes = 1e-3;

}  // namespace

Point local_origin(const Scene& scene) {
  for (const auto& traction : scene.tractions)
    if (std::holds_alternative<EllipseSpec>(traction.field)) return {};
  Point origin{};
  const auto box = bounding_box(scene.grid, scene.dimension);
  for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i)
    if (std::max(box.lower[i], -box.upper[i]) > box.upper[i] - box.lower[i]) origin[i] = box.lower[i];
  return origin;
}

StressFieldSpec seen_from(const Point& origin, const StressFieldSpec& field) {
  if (origin == Point{}) return field;
  const auto local = [&](Point x) {
    for (size_t i = 0; i < 3; ++i) x[i] -= origin[i];
    return x;
  };
  return std::visit(
      Overloaded{[](const Stress6& stress) -> StressFieldSpec { return stress; },
                 [&](Affine<Stress6> affine) -> StressFieldSpec {
                   affine.value = affine.at(origin);
                   return affine;
                 },
                 [&](HydrostaticSpec h) -> StressFieldSpec {
                   for (size_t i = 0; i < 3; ++i) h.level -= origin[i] * h.up[i];
                   return h;
                 },
                 [&](RadialBlendSpec b) -> StressFieldSpec {
                   b.center = local(b.center);
                   return b;
                 },
                 [&](PlanarBlendSpec b) -> StressFieldSpec {
                   b.start = local(b.start);
                   b.end = local(b.end);
                   return b;
                 },
                 [](const EllipseSpec& e) -> StressFieldSpec { return e; }},  // local_origin is 0 with it
      field);
}

std::string position_text(const Scene& scene, const Point& x, int digits) {
  const auto box = bounding_box(scene.grid, scene.dimension);
  const double h = shortest_edge(scene.grid, scene.dimension);
  std::string text;
  for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i) {
    const double cells = std::max(std::abs(box.lower[i]), std::abs(box.upper[i])) / h;
    const int enough = 2 + static_cast<int>(std::ceil(std::log10(std::max(cells, 1.0))));
    text += fmt::format("{}{:.{}g}", i == 0 ? "" : ", ", x[i], std::clamp(enough, digits, 17));
  }
  return "(" + text + ") m";
}

void refuse_unresolved_positions(const Scene& scene, bool on_cell_lanes) {
  if (!scene.single_precision) return;
  const Point origin = local_origin(scene);
  const auto box = bounding_box(scene.grid, scene.dimension);
  const double limit = on_cell_lanes ? coarsest_position_on_lanes : coarsest_position;
  for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i) {
    const double farthest = std::max(std::abs(box.lower[i] - origin[i]), std::abs(box.upper[i] - origin[i]));
    const double h = scene.grid.spacing[i];
    const double coarseness = 0.5 * std::numeric_limits<float>::epsilon() * farthest / h;
    if (coarseness <= limit) continue;
    throw SetupError(fmt::format(
        "precision = \"float\" does not resolve this grid: along {} it goes up to {:.6g} m, {:.6g} cells of "
        "{:.6g} m, where the round-off of a position is {:.2g} cells, and {:g} is what steps on {} bear; use "
        "precision = \"double\", larger cells (grid.spacing) or a shorter grid (grid.upper)",
        scene.grid.axis_name(i), farthest, farthest / h, h, coarseness, limit,
        on_cell_lanes ? "cell lanes" : "particle kernels"));
  }
}

}  // namespace vsb::app
