// SPDX-License-Identifier: BSD-3-Clause
#include "report/energy_advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "scene/limits.hpp"

namespace vsb::app {

namespace {

/// By how many powers of e a disturbance may grow: from round-off to something one would see it takes thirty.
constexpr double growth_that_shows = 10;

/// S / M.
double tension_over_modulus(const Scene& scene) {
  const auto box = bounding_box(scene.grid, scene.dimension);
  double tension = 0, modulus = std::numeric_limits<double>::infinity();
  for (const auto& traction : scene.tractions)
    if (traction.imposition == Imposition::virtual_stress)
      tension = std::max(tension, largest_stress(traction.field, box.lower, box.upper));
  for (const auto& body : scene.bodies) modulus = std::min(modulus, constrained_modulus(body.material));
  return tension / modulus;
}

}  // namespace

std::string energy_advice(const Scene& scene) {
  if (!scene.method.moves_by_grid) return {};
  const double ratio = tension_over_modulus(scene), kappa = scene.time.kappa;
  const double rate = 0.58 * kappa * ratio * kappa / scene.time.dt, held_by = 4.3 * kappa * ratio;
  if (scene.method.damping >= held_by ||
      rate * scene.time.dt * static_cast<double>(scene.time.steps) < growth_that_shows)
    return {};
  return fmt::format(
      "method.position_velocity = \"grid\", the paper's step, feeds energy into a body in tension or under a "
      "virtual "
      "pressure: disturbances grow by up to some {:.2g} 1/s, unless method.damping is above some {:.2g} (it "
      "is {:g}); "
      "\"strain\" feeds none",
      rate, held_by, scene.method.damping);
}

}  // namespace vsb::app
