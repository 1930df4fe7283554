// SPDX-License-Identifier: BSD-3-Clause
#include "scene/read_output.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "scene/read_basis.hpp"

namespace vsb::app {

namespace {

constexpr std::array every_body = {"id",     "displacement", "velocity",   "cauchy_stress",
                                   "volume", "mass",         "in_boundary"};
constexpr std::array plastic_bodies = {"plastic_strain", "equivalent_plastic_strain"};
constexpr const char* recovered = "recovered_stress";

}  // namespace

std::string OutputKeys::field_names() {
  return fmt::format("`\"{}\"`; of plastic bodies also `\"{}\"`; with linear functions also `\"{}\"`",
                     fmt::join(every_body, "\"`, `\""), fmt::join(plastic_bodies, "\"`, `\""), recovered);
}

const char* const recovery_is_linear =
    "is for method.basis = \"linear\": it projects on the linear functions of the grid, and would take away "
    "what a smoother basis gains";

OutputSpec read_output(TableReader r, const Scene& scene) {
  const auto& keys = output_keys;
  std::vector<std::string> fields(every_body.begin(), every_body.end());
  const bool plastic = std::any_of(scene.bodies.begin(), scene.bodies.end(),
                                   [](const BodySpec& b) { return is_plastic(b.material.law); });
  if (plastic) fields.insert(fields.end(), plastic_bodies.begin(), plastic_bodies.end());
  auto allowed = fields;
  allowed.emplace_back(recovered);
  OutputSpec o;
  o.every = r.read(keys.every);
  o.fields = r.words(keys.fields, allowed, fields);
  if (scene.method.basis != BasisKind::linear &&
      std::find(o.fields.begin(), o.fields.end(), recovered) != o.fields.end())
    r.fail(keys.fields,
           fmt::format("'{}' {}{}", recovered, recovery_is_linear, linear_beside_setting(scene)));
  o.grid = r.read(keys.grid);
  o.checkpoint_minutes = r.read(keys.checkpoint_minutes);
  r.finish();
  return o;
}

}  // namespace vsb::app
