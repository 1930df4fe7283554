// SPDX-License-Identifier: BSD-3-Clause
#include "scene/read_removal.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace vsb::app {

namespace {

/// What in a scene makes it impossible to take particles away; empty where nothing does.
std::string obstacle(const Scene& scene) {
  if (!scene.time.until_static)
    return "needs time.until_static: a stage ends when the body is static (max_steps holds for each stage)";
  if (std::none_of(scene.bodies.begin(), scene.bodies.end(),
                   [](const BodySpec& b) { return is_plastic(b.material.law); }))
    return "needs a body of a plastic material: no other one has a plastic strain";
  if (scene.method.void_filter) return "is not for method.void_filter: what is removed leaves a void inside";
  for (const auto& traction : scene.tractions)
    if (traction.imposition != Imposition::virtual_stress &&
        traction.imposition != Imposition::virtual_stress_original)
      return fmt::format(
          "is for tractions imposed by a virtual stress, which follows the particles that are left; traction "
          "'{}' acts on the surface that the bodies have at the start",
          traction.name);
  return {};
}

/// The distance between the first body's particles; none where they lie on no square lattice.
std::optional<double> particle_spacing(const Scene& scene) {
  const auto& lattice = scene.bodies.front().lattice;
  if (const auto* uniform = std::get_if<UniformLattice>(&lattice)) return uniform->spacing[0];
  if (std::holds_alternative<ConcentricLattice>(lattice) || scene.grid.mapped()) return {};
  return scene.grid.spacing[0] / std::get<CellLattice>(lattice).particles_per_cell[0];
}

HoleSpec read_hole(TableReader r, const Scene& scene) {
  const auto& keys = hole_keys;
  HoleSpec hole;
  const auto center = r.read(keys.center.of(static_cast<size_t>(scene.dimension)));
  std::copy(center.begin(), center.end(), hole.center.begin());
  if (scene.dimension == 3) hole.axis = r.read(keys.axis)[0] - 'x';
  hole.radius = r.read(keys.radius);
  hole.row = r.read(keys.row, particle_spacing(scene));
  r.finish();
  return hole;
}

}  // namespace

std::optional<RemovalSpec> read_removal(TableReader& document, const SubtableKey& key, const Scene& scene) {
  const auto& keys = removal_keys;
  if (!document.has(key)) return {};
  TableReader r = document.table(key);
  if (const auto reason = obstacle(scene); !reason.empty()) document.fail(key, reason);
  RemovalSpec removal;
  r.read(keys.measure);
  removal.threshold = r.read(keys.threshold);
  removal.remap = r.read(keys.remap);
  removal.reset = r.read<bool>(keys.next);
  if (!removal.reset)
    removal.damping = r.read(keys.damping, 0.5);
  else if (r.has(keys.damping))
    r.fail(keys.damping, "is for next = \"continue\"; with \"reset\" all stages have method.damping");
  removal.max_stages = static_cast<int>(r.read(keys.max_stages));
  removal.settled = r.read(keys.settled);
  removal.collapse = r.read(keys.collapse);
  if (r.has(keys.hole)) {
    if (scene.dimension == 1) r.fail(keys.hole, "is for dimension 2 and 3");
    const KeyList axis = {&hole_keys.axis};
    removal.hole = read_hole(r.table(keys.hole, scene.dimension == 3 ? KeyList() : axis), scene);
  }
  r.finish();
  return removal;
}

}  // namespace vsb::app
