// SPDX-License-Identifier: BSD-3-Clause
#include "run/scene_advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vsb::app {

namespace {

double largest(const Stress6& stress) {
  double most = 0;
  for (const double s : stress) most = std::max(most, std::abs(s));
  return most;
}

/// Of the tractions, and of each body's weight if it were as high as the grid.
double largest_load(const Scene& scene) {
  double load = 0;
  for (const auto& traction : scene.tractions) {
    load = std::max(load, largest(traction.virtual_stress));
    if (const auto& e = traction.exact)
      load = std::max({load, e->pressure, std::abs(e->far_stress), std::abs(e->far_ratio * e->far_stress)});
  }
  const auto box = bounding_box(scene.grid, scene.dimension);
  for (const auto& body : scene.bodies)
    for (size_t i = 0; i < 3; ++i)
      load = std::max(load, body.density * std::abs(scene.gravity[i]) * (box.upper[i] - box.lower[i]));
  return load;
}

}  // namespace

std::string units_hint(const Scene& scene) {
  double modulus = scene.bodies.front().material.youngs_modulus;
  for (const auto& body : scene.bodies) modulus = std::min(modulus, body.material.youngs_modulus);
  const double load = largest_load(scene), ratio = load / modulus;
  if (!(ratio > 0.1)) return "";
  return fmt::format(
      "largest load / smallest Young's modulus = {:.3g} Pa / {:.3g} Pa = {:.2g}: check the units", load,
      modulus, ratio);
}

std::vector<std::string> scene_advice(const Scene& scene) {
  std::vector<std::string> advice;
  if (const auto hint = units_hint(scene); !hint.empty()) advice.push_back(hint);
  if (scene.time.until_static && scene.method.damping == 0)
    advice.emplace_back(
        "method.damping = 0: nothing takes the oscillation away, so the run may never become static; 0.05 to "
        "0.3 is usual");
  return advice;
}

}  // namespace vsb::app
