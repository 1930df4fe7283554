// SPDX-License-Identifier: BSD-3-Clause
#include "report/neighbour_advice.hpp"

#include <fmt/format.h>

#include <algorithm>

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

/// The largest distance of two boxes along an axis, in cells; negative where they overlap along all.
double gap_between(const Scene& scene, const AxisBox& a, const AxisBox& b) {
  double gap = -1e300;
  for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i)
    gap = std::max({gap, (b.lower[i] - a.upper[i]) / scene.grid.spacing[i],
                    (a.lower[i] - b.upper[i]) / scene.grid.spacing[i]});
  return gap;
}

/// Calls visit(first, second, gap in cells) for every two bodies.
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
  for_each_pair(scene, [&](const BodySpec& a, const BodySpec& b, double gap) {
    if (gap < least_gap || gap > 2 * half_support(scene) - least_gap) return;
    advice.push_back(fmt::format(
        "bodies '{}' and '{}' are {:.3g} cells apart: nearer than {:g} cells they share nodes, which holds "
        "them together, in tension and shear too; leave as much where they are to move apart, or none "
        "where they are one",
        a.name, b.name, gap, 2 * half_support(scene)));
  });
  return advice;
}

std::vector<std::string> interface_advice(const Scene& scene) {
  std::vector<std::string> advice;
  if (scene.method.basis != BasisKind::quadratic_bspline) return advice;
  for_each_pair(scene, [&](const BodySpec& a, const BodySpec& b, double gap) {
    const double stiffer = std::max(a.material.youngs_modulus, b.material.youngs_modulus);
    const double softer = std::min(a.material.youngs_modulus, b.material.youngs_modulus);
    if (gap > least_gap || !(stiffer > 1.5 * softer)) return;
    advice.push_back(fmt::format(
        "bodies '{}' and '{}' differ {:.3g} times in stiffness, and the strain of B-splines does not jump "
        "between them: stresses beside the interface are wrong by as much as they are themselves, on finer "
        "grids too; with method.basis = \"linear\" and the interface on a line of the grid they are right",
        a.name, b.name, stiffer / softer));
  });
  return advice;
}

}  // namespace vsb::app
