// SPDX-License-Identifier: BSD-3-Clause
#include "report/yielding_cylinder.hpp"

#include <algorithm>
#include <cmath>

namespace vsb::app {

namespace {

bool has_yielded(const Snapshot& s, size_t p) {
  return std::any_of(&s.plastic_strain[6 * p], &s.plastic_strain[6 * p] + 6, [](double e) { return e != 0; });
}

}  // namespace

ExactMohrCoulombCylinder<double> solution_of(const YieldingCylinderComparison& c, const Scene& scene) {
  const auto& m = scene.bodies.front().material;
  return {c.inner_radius, c.outer_radius, c.pressure, m.cohesion, m.friction_angle, m.poisson_ratio};
}

void PlasticZone::add(const Snapshot& s) {
  for (size_t p = 0; p < s.count(); ++p) {
    all_ += s.volume[p];
    if (!has_yielded(s, p)) continue;
    yielded_ += s.volume[p];
    furthest_ = std::max(furthest_, std::hypot(s.position[3 * p], s.position[3 * p + 1]));
  }
}

double PlasticZone::radius(const YieldingCylinderComparison& c) const {
  const double a2 = c.inner_radius * c.inner_radius, b2 = c.outer_radius * c.outer_radius;
  return std::sqrt(a2 + yielded_ / all_ * (b2 - a2));
}

double PlasticZone::largest_radius(const YieldingCylinderComparison& c) const {
  return std::max(c.inner_radius, furthest_);
}

}  // namespace vsb::app
