// SPDX-License-Identifier: BSD-3-Clause
#include "scene/read_time.hpp"

#include <fmt/format.h>

#include "scene/limits.hpp"

namespace vsb::app {

TimeSpec read_time(TableReader r, const Scene& scene) {
  const auto& keys = time_keys;
  TimeSpec t;
  const double critical = critical_time(scene);
  if (r.has(keys.dt) && r.has(keys.kappa)) r.fail(keys.kappa, "give either dt or kappa, not both");
  if (r.has(keys.dt)) {
    const auto key = keys.dt.within({0, 2 * critical, true, false});
    t.dt = r.read(remarked(key, fmt::format("a compression wave crosses a cell in {:.6g} s", critical)));
    t.kappa = t.dt / critical;
  } else {
    t.kappa = r.read(keys.kappa);
    t.dt = t.kappa * critical;
  }
  if (r.has(keys.until_static)) {
    if (r.has(keys.steps)) r.fail(keys.steps, "give either steps or until_static (with max_steps), not both");
    TableReader s = r.table(keys.until_static);
    StaticCriterion c{};
    const bool splines = scene.method.basis == BasisKind::quadratic_bspline;
    c.force_ratio = s.read(until_static_keys.force_ratio, splines ? static_spline_ratio : 1e-6);
    c.energy_ratio = s.read(until_static_keys.energy_ratio, splines ? 1e-6 : 1e-9);
    c.check_every = s.read(until_static_keys.check_every);
    t.steps = s.read(until_static_keys.max_steps);
    s.finish();
    t.until_static = c;
  } else {
    if (!r.has(keys.steps)) r.missing(keys.steps, "an integer >= 1, or a table until_static = {}");
    t.steps = r.read(keys.steps);
  }
  r.finish();
  return t;
}

StaticSpec read_static(TableReader r) {
  StaticSpec s;
  s.residual = r.read(static_keys.residual);
  s.max_iterations = static_cast<int>(r.read(static_keys.max_iterations));
  r.finish();
  return s;
}

}  // namespace vsb::app
