// SPDX-License-Identifier: BSD-3-Clause
#include "report/neighbour_advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "setup/region_size.hpp"

namespace vsb::app {

namespace {

/// In cells: what is less is round-off of bodies that touch.
constexpr double least_gap = 1e-6;

/// How far from a particle the functions of a node end, in cells.
double half_support(const Scene& scene) {
  return scene.method.basis == BasisKind::quadratic_bspline ? 1.5 : 1;
}

std::vector<AxisBox> bounds_of_bodies(const Scene& scene) {
  std::vector<AxisBox> bounds;
  const auto grid = bounding_box(scene.grid, scene.dimension);
  for (const auto& body : scene.bodies) bounds.push_back(bounds_of(body.region, grid, scene.dimension));
  return bounds;
}

/// Where two boxes are next to each other.
struct Gap {
  double cells;    ///< their largest distance along an axis; negative where they overlap along all
  bool on_a_line;  ///< whether one begins there on a line of the grid
};
Gap gap_between(const Scene& scene, const AxisBox& a, const AxisBox& b) {
  Gap gap{-std::numeric_limits<double>::infinity(), false};
  for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i)
    for (const auto& [end, begin] : {std::pair{a.upper[i], b.lower[i]}, {b.upper[i], a.lower[i]}}) {
      const double h = scene.grid.spacing[i], cells = (begin - end) / h;
      if (cells <= gap.cells) continue;
      const double line = (begin - scene.grid.lower[i]) / h;
      gap = {cells, std::abs(line - std::round(line)) < least_gap};
    }
  return gap;
}

/// Calls visit(first, second, gap) for every two bodies.
template <class Visit>
void for_each_pair(const Scene& scene, const Visit& visit) {
  if (scene.grid.mapped()) return;
  const auto bounds = bounds_of_bodies(scene);
  for (size_t a = 0; a < bounds.size(); ++a)
    for (size_t b = a + 1; b < bounds.size(); ++b)
      visit(scene.bodies[a], scene.bodies[b], gap_between(scene, bounds[a], bounds[b]));
}

}  // namespace

std::vector<std::string> gap_advice(const Scene& scene) {
  std::vector<std::string> advice;
  if (scene.grid.mapped()) return advice;
  const auto grid = bounding_box(scene.grid, scene.dimension);
  const auto bounds = bounds_of_bodies(scene);
  for (size_t b = 0; b < bounds.size(); ++b)
    for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i)
      for (const size_t side : {0, 1}) {
        if (!(scene.faces.fixed[i][side] >> i & 1)) continue;
        const double gap =
            (side == 0 ? bounds[b].lower[i] - grid.lower[i] : grid.upper[i] - bounds[b].upper[i]) /
            scene.grid.spacing[i];
        if (gap < least_gap || gap > half_support(scene) - least_gap) continue;
        advice.push_back(fmt::format(
            "body '{}' begins {:.3g} cells from the face {}_{} of the grid, which holds it: the face acts "
            "across that gap, as if they touched, and stresses beside it are several times too large; let "
            "the body reach the face, or leave {:g} cells or more",
            scene.bodies[b].name, gap, "xyz"[i], side == 0 ? "min" : "max", half_support(scene)));
      }
  for_each_pair(scene, [&](const BodySpec& a, const BodySpec& b, const Gap& gap) {
    if (gap.cells < least_gap || gap.cells > 2 * half_support(scene) - least_gap) return;
    advice.push_back(fmt::format(
        "bodies '{}' and '{}' are {:.3g} cells apart: nearer than {:g} cells they share nodes, which holds "
        "them together, in tension and shear too; leave as much where they are to move apart, or none "
        "where they are one",
        a.name, b.name, gap.cells, 2 * half_support(scene)));
  });
  return advice;
}

std::vector<std::string> interface_advice(const Scene& scene) {
  std::vector<std::string> advice;
  const bool splines = scene.method.basis == BasisKind::quadratic_bspline;
  for_each_pair(scene, [&](const BodySpec& a, const BodySpec& b, const Gap& gap) {
    const double stiffer = std::max(a.material.youngs_modulus, b.material.youngs_modulus);
    const double softer = std::min(a.material.youngs_modulus, b.material.youngs_modulus);
    if (gap.cells > least_gap || !(stiffer > 1.5 * softer)) return;
    // Of boxes that overlap the interface is not known.
    if (!splines && (gap.cells < -least_gap || gap.on_a_line)) return;
    advice.push_back(fmt::format(
        "bodies '{}' and '{}' differ {:.3g} times in stiffness, and the strain does not jump between them{}: "
        "stresses beside the interface are wrong by as much as they are themselves, on finer grids too; with "
        "method.basis = \"linear\" and the interface on a line of the grid they are right",
        a.name, b.name, stiffer / softer,
        splines ? ", as B-splines are smooth" : ", as their interface is not a line of the grid"));
  });
  return advice;
}

}  // namespace vsb::app
