// SPDX-License-Identifier: BSD-3-Clause
#include "scene/load_in_time.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace vsb::app {

std::vector<LoadInTime> loads_in_time(const Scene& scene) {
  std::vector<LoadInTime> loads;
  for (size_t k = 0; k < scene.tractions.size(); ++k) {
    const auto& traction = scene.tractions[k];
    loads.push_back({fmt::format("traction '{}'", traction.name), fmt::format("traction[{}].time", k),
                     traction.where, traction.time});
  }
  if (has_gravity(scene)) loads.push_back({"gravity", "gravity_time", "", scene.gravity_time});
  return loads;
}

double loads_settled_at(const Scene& scene) {
  double t = 0;
  for (const auto& load : loads_in_time(scene)) t = std::max(t, load.time.settled_at());
  return t;
}

}  // namespace vsb::app
