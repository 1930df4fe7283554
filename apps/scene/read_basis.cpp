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

void read_basis(TableReader& r, const BasisKeys& keys, Scene& scene) {
  const auto basis = r.read<BasisKind>(
      keys.basis, scene.setting == Setting::accurate ? BasisKind::quadratic_bspline : BasisKind::linear);
  scene.method.basis = basis;
  if (basis != BasisKind::linear)
    if (const auto reason = refusal(scene); !reason.empty()) {
      const auto& name = keys.basis.word(basis);
      if (r.has(keys.basis)) r.fail(keys.basis, fmt::format("\"{}\" {}", name, reason));
      r.missing(keys.basis,
                fmt::format("\"linear\": \"{}\", which setting = \"accurate\" takes, {}", name, reason));
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
