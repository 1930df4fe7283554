// SPDX-License-Identifier: BSD-3-Clause
#include "run/rest_forecast.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vsb::app {

std::optional<RestForecast> forecast_rest(const Scene& scene, double extent, double loaded) {
  const double damping = scene.method.damping;
  if (!scene.time.until_static || !(damping > 0)) return {};
  double fastest = 0, slowest = std::numeric_limits<double>::infinity();  // waves, m/s
  for (const auto& body : scene.bodies) {
    const double shear = body.material.youngs_modulus / (2 * (1 + body.material.poisson_ratio)),
                 nu = body.material.poisson_ratio, constrained = shear * (2 - 2 * nu) / (1 - 2 * nu);
    fastest = std::max(fastest, std::sqrt(constrained / body.density));
    slowest = std::min(slowest, std::sqrt(shear / body.density));
  }
  const auto& rest = *scene.time.until_static;
  const double falls = std::max(-std::log(rest.force_ratio), -std::log(rest.energy_ratio) / 2),
               periods = falls / (2 * damping);
  return RestForecast{loaded + periods / 8 * 2 * extent / fastest / scene.time.dt,
                      loaded + periods * 4 * extent / slowest / scene.time.dt};
}

}  // namespace vsb::app
