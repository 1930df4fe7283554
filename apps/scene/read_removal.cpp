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
  const auto d = static_cast<size_t>(scene.dimension);
  HoleSpec hole;
  std::vector<std::string> keys = {"center", "radius", "row"};
  if (d == 3) keys.emplace_back("axis");
  r.allow_only(keys);
  const auto center = r.numbers("center", d, Range::any(), {}, "m");
  std::copy(center.begin(), center.end(), hole.center.begin());
  if (d == 3) hole.axis = r.choice("axis", {"x", "y", "z"}, "z")[0] - 'x';
  hole.radius = r.number("radius", Range::positive(), {}, "m, at the start");
  hole.row = r.number("row", Range::positive(), particle_spacing(scene), "m, between rows of particles");
  r.finish();
  return hole;
}

}  // namespace

std::optional<RemovalSpec> read_removal(TableReader& document, const Scene& scene) {
  if (!document.has("removal")) return {};
  TableReader r = document.table("removal");
  r.allow_only(
      {"measure", "threshold", "remap", "next", "damping", "max_stages", "settled", "collapse", "hole"});
  if (const auto reason = obstacle(scene); !reason.empty())
    document.fail(*document.source().get("removal"), "removal", reason);
  RemovalSpec removal;
  r.choice("measure", {"equivalent_plastic_strain"}, "equivalent_plastic_strain");
  removal.threshold = r.number("threshold", Range::positive(), {}, "particles beyond it are removed");
  removal.remap = r.boolean("remap", true);
  removal.reset = r.choice("next", {"reset", "continue"}, "reset") == "reset";
  if (!removal.reset)
    removal.damping = r.number("damping", {0, 1, false, true}, 0.5, "of the stages after the first");
  else if (r.has("damping"))
    r.fail(*r.source().get("damping"), "damping",
           "is for next = \"continue\"; with \"reset\" all stages have method.damping");
  removal.max_stages = static_cast<int>(r.integer("max_stages", 1, 1000, 10));
  removal.settled =
      r.integer("settled", 0, 1'000'000'000'000LL, 0,
                "steps under constant loads without another particle beyond the threshold after "
                "which a stage is at its end, too; 0: when it is static alone");
  removal.collapse = r.number("collapse", {0, 1, true, false}, 0.9,
                              "share of the particles beyond the threshold that ends the run");
  if (r.has("hole")) {
    if (scene.dimension == 1) r.fail(*r.source().get("hole"), "hole", "is for dimension 2 and 3");
    removal.hole = read_hole(r.table("hole"), scene);
  }
  r.finish();
  return removal;
}

}  // namespace vsb::app
