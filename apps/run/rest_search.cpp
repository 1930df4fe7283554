// SPDX-License-Identifier: BSD-3-Clause
#include "run/rest_search.hpp"

#include <fmt/format.h>

#include "run/run_parts.hpp"
#include "setup/cut_lattice.hpp"

namespace vsb::app {

RestSearch::RestSearch(const Scene& scene) : scene_(scene), settled_(loads_settled_at(scene)) {}

bool RestSearch::due(long long step) const {
  const auto& criterion = scene_.time.until_static;
  return criterion && step % criterion->check_every == 0;
}

bool RestSearch::loads_are_constant(const Simulation& simulation) const {
  return simulation.load_time() >= settled_;
}

bool RestSearch::is_static(Simulation& simulation) {
  const auto& criterion = *scene_.time.until_static;
  const auto balance = simulation.balance();
  decay_.observe(simulation.step(), balance.force_ratio);
  return balance.force_ratio <= criterion.force_ratio && balance.energy_ratio <= criterion.energy_ratio;
}

ExpectedEnd RestSearch::expected_end(long long last) const {
  if (!scene_.time.until_static) return {scene_.time.steps, ExpectedEnd::known};
  const auto end = decay_.reaches(scene_.time.until_static->force_ratio);
  if (end && *end <= last) return {*end, ExpectedEnd::foreseen};
  return {last, decay_.stands() ? ExpectedEnd::not_foreseen : ExpectedEnd::at_most};
}

std::string RestSearch::standing_text() const {
  const auto level = decay_.stands();
  if (!level) return "";
  bool may_yield = false, may_cut = false;
  for (const auto& body : scene_.bodies) {
    may_yield = may_yield || is_plastic(body.material.law);
    may_cut = may_cut || (body.boundary == BoundaryBoxes::keep && !is_irregular(body) &&
                          !scene_.grid.mapped() && cuts_boxes(scene_, body));
  }
  return fmt::format(
      ": the force ratio stands at {:.2e} since about step {}, so that more steps will hardly help; what "
      "may: "
      "{}{}a larger time.until_static.force_ratio",
      level->ratio, level->since,
      may_yield || scene_.single_precision ? "" : "the static solver (--static), which takes no steps; ",
      may_cut ? "body.boundary = \"cut\"; " : "");
}

}  // namespace vsb::app
