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

/// What only the linear basis can do.
std::string refusal(const Scene& scene) {
  if (scene.grid.mapped()) return "is for uniform grids; on rectilinear and polar ones the basis is linear";
  if (scene.single_precision) return "is for precision = \"double\"";
  for (const auto& traction : scene.tractions) {
    if (traction.imposition == Imposition::nodal)
      return fmt::format(
          "cannot have traction '{}' imposed at nodes: with this basis a value at a node is not the field's "
          "value there",
          traction.name);
    if (traction.imposition == Imposition::virtual_stress_original)
      return fmt::format(
          "cannot have traction '{}' imposed by the original virtual stress method, whose sums over whole "
          "cells are for the linear basis",
          traction.name);
  }
  return "";
}

}  // namespace

void read_basis(TableReader& r, Scene& scene) {
  static const std::vector<std::string> names = {"linear", "ugimp", "quadratic_bspline"};
  const std::string name = r.choice("basis", names, names[scene.setting == Setting::accurate ? 2 : 0]);
  scene.method.basis = static_cast<BasisKind>(std::find(names.begin(), names.end(), name) - names.begin());
  if (scene.method.basis != BasisKind::linear)
    if (const auto reason = refusal(scene); !reason.empty()) {
      if (const auto* node = r.source().get("basis"))
        r.fail(*node, "basis", fmt::format("\"{}\" {}", name, reason));
      r.missing("basis",
                fmt::format("\"linear\": \"{}\", which setting = \"accurate\" takes, {}", name, reason));
    }
  if (scene.method.basis != BasisKind::ugimp) {
    if (const auto* node = r.source().get("gimp_half_width"))
      r.fail(*node, "gimp_half_width", "is for basis = \"ugimp\"");
    return;
  }
  const auto preset = default_half_width(scene);
  if (!preset && !r.has("gimp_half_width"))
    r.missing(
        "gimp_half_width",
        "a number > 0 and <= 0.5, half the size of a particle in cells: no lattice of cells to take it from");
  const auto width =
      r.number_or_numbers("gimp_half_width", static_cast<size_t>(scene.dimension), {0, 0.5, true, false},
                          preset, "half the size of a particle, in cells");
  std::copy(width.begin(), width.end(), scene.method.gimp_half_width.begin());
}

}  // namespace vsb::app
