// SPDX-License-Identifier: BSD-3-Clause
#include "scene/read_traction.hpp"

#include <fmt/format.h>

namespace vsb::app {

namespace {

/// At which nodes a traction acts, and whether it is in balance with itself.
void read_nodes(TableReader& r, const Scene& scene, TractionSpec& traction) {
  const auto& keys = traction_keys;
  traction.all_nodes = r.read<bool>(keys.nodes);
  traction.self_balanced = r.read(keys.self_balanced);
  if (traction.all_nodes && traction.imposition != Imposition::virtual_stress)
    r.fail(keys.nodes, "'all' is for imposition = \"virtual_stress\"");
  if (traction.all_nodes && r.has(keys.surface))
    r.fail(keys.surface,
           "with nodes = \"all\" the traction loads all surfaces at once, by the values of its field there; "
           "leave 'surface' out");
  if (!traction.self_balanced) return;
  if (!traction.all_nodes) r.fail(keys.self_balanced, "needs nodes = \"all\"");
  for (const auto& sides : scene.faces.fixed)
    if (sides[0] != 0 || sides[1] != 0)
      r.fail(keys.self_balanced,
             "is for free bodies: a part that ends at a symmetry plane or a support has a resultant");
}

/// Whether a surface is fixed in space, or one of the material that was there at the start; points and loaded
/// faces of cells belong to the surface of the start.
void read_configuration(TableReader& r, TractionSpec& traction) {
  const auto& key = traction_keys.configuration;
  if (traction.all_nodes) {
    if (r.has(key))
      r.fail(
          key,
          "is for a traction with a 'surface'; with nodes = \"all\" leave it out, the traction follows the "
          "material all the same");
    return;
  }
  const bool on_nodes = traction.imposition == Imposition::virtual_stress ||
                        traction.imposition == Imposition::virtual_stress_original;
  if (on_nodes)
    traction.carried = r.read<bool>(key);
  else if (r.has(key))
    r.read(key.only({"initial"}));
}

}  // namespace

TractionSpec read_traction(TableReader r, const Scene& scene, size_t number, TimeShape& time) {
  const auto& keys = traction_keys;
  const int dimension = scene.dimension;
  TractionSpec traction;
  traction.where = location(r.source());
  traction.name = r.read(keys.name, fmt::format("traction {}", number + 1));
  traction.imposition = r.read<Imposition>(keys.imposition);
  traction.field = read_stress_field(r, keys.field, scene);
  read_nodes(r, scene, traction);
  traction.has_surface = r.has(keys.surface);
  traction.surface = read_region(r, keys.surface, dimension, true);
  read_configuration(r, traction);
  traction.layer = everywhere();
  if (traction.imposition == Imposition::material_points)
    traction.layer = read_region(r, keys.layer, dimension, true);
  traction.points_per_cell = static_cast<int>(r.read(keys.points_per_cell, dimension == 3 ? 4 : 8));
  time = read_time_function(r.table(keys.time), traction_time_keys);
  r.finish();
  return traction;
}

}  // namespace vsb::app
