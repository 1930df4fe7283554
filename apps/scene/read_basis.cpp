// SPDX-License-Identifier: BSD-3-Clause
#include "scene/read_basis.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace vsb::app {

namespace {

/// Half the distance between the particles of a lattice along an axis, in cells; 0 where they lie on rings.
double half_spacing(const Scene& scene, const Lattice& lattice, size_t axis) {
  if (const auto* cells = std::get_if<CellLattice>(&lattice))
    return 0.5 / static_cast<double>(cells->particles_per_cell[axis]);
  if (const auto* uniform = std::get_if<UniformLattice>(&lattice))
    return 0.5 * uniform->spacing[axis] / scene.grid.spacing[axis];
  return 0;
}

/// Of the finest lattice; none where a body's particles lie on rings.
std::optional<double> default_half_width(const Scene& scene) {
  double least = 0.5;
  for (const auto& body : scene.bodies)
    for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i)
      least = std::min(least, half_spacing(scene, body.lattice, i));
  if (least > 0) return least;
  return {};
}

/// What only the linear basis can do, by the key that wants it.
std::string refusal(const Scene& scene) {
  if (scene.grid.mapped())
    return fmt::format("is for uniform grids, and grid.{} gives none: there the basis is linear",
                       scene.grid.polar ? "polar" : "x");
  if (scene.single_precision) return "is for precision = \"double\", and the scene has \"float\"";
  for (size_t k = 0; k < scene.tractions.size(); ++k) {
    const auto& traction = scene.tractions[k];
    if (traction.imposition == Imposition::nodal)
      return fmt::format(
          "cannot have traction[{}].imposition = \"nodal\" ('{}'): with this basis a value at a node is not "
          "the field's value there",
          k, traction.name);
    if (traction.imposition == Imposition::virtual_stress_original)
      return fmt::format(
          "cannot have traction[{}].imposition = \"virtual_stress_original\" ('{}'), whose sums over whole "
          "cells are for the linear basis",
          k, traction.name);
  }
  return "";
}

}  // namespace

std::string unfit_setting(const Scene& scene) {
  const auto reason = scene.setting == Setting::accurate ? refusal(scene) : "";
  if (reason.empty()) return "";
  return fmt::format(
      "stands for method.basis = \"quadratic_bspline\", which {}; change that, or give method.basis = "
      "\"linear\" beside the setting",
      reason);
}

std::string linear_beside_setting(const Scene& scene) {
  if (scene.setting != Setting::accurate || scene.method.basis != BasisKind::quadratic_bspline) return "";
  return "; setting = \"accurate\" takes \"quadratic_bspline\" unless method.basis = \"linear\" is given "
         "beside it";
}

void read_basis(TableReader& r, const BasisKeys& keys, Scene& scene) {
  const auto basis = r.read<BasisKind>(
      keys.basis, scene.setting == Setting::accurate ? BasisKind::quadratic_bspline : BasisKind::linear);
  scene.method.basis = basis;
  if (basis != BasisKind::linear)
    if (const auto reason = refusal(scene); !reason.empty()) {
      const auto& name = keys.basis.word(basis);
      r.fail(keys.basis, fmt::format("\"{}\" {}", name, reason));
    }
  const auto& half_width = keys.gimp_half_width;
  if (basis != BasisKind::ugimp) {
    if (r.has(half_width)) r.fail(half_width, "is for basis = \"ugimp\"");
    return;
  }
  const auto preset = default_half_width(scene);
  if (!preset && !r.has(half_width))
    r.missing(
        half_width,
        "a number > 0 and <= 0.5, half the size of a particle in cells: no lattice of cells to take it from");
  const auto width = r.read(half_width, static_cast<size_t>(scene.dimension), preset);
  std::copy(width.begin(), width.end(), scene.method.gimp_half_width.begin());
}

}  // namespace vsb::app
