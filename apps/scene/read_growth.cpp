// SPDX-License-Identifier: BSD-3-Clause
#include "scene/read_growth.hpp"

#include <fmt/format.h>

namespace vsb::app {

namespace {

/// From which growth can be told apart from vibrations; and after which nobody waits.
constexpr double fewest_steps = 192, most_steps_of_growth = 1e7;

}  // namespace

std::optional<GrowthSpec> read_growth(TableReader& document, const SubtableKey& key, const Scene& scene) {
  if (!document.has(key)) return {};
  if (may_lose_particles(scene))
    document.fail(key, "is not for scenes that lose particles (removal, \"outflow\")");
  if (scene.single_precision)
    document.fail(key, "is for precision = \"double\": a disturbance must be small beside the state");
  TableReader r = document.table(key);
  GrowthSpec growth;
  growth.time = r.read(growth_keys.time.within(
      Range::between(fewest_steps * scene.time.dt, most_steps_of_growth * scene.time.dt)));
  growth.damping = r.read(growth_keys.damping);
  r.finish();
  return growth;
}

}  // namespace vsb::app
