// SPDX-License-Identifier: BSD-3-Clause
#include "report/resultant_share.hpp"

#include <algorithm>
#include <cmath>

#include "setup/loads.hpp"

namespace vsb::app {

namespace {

AxisBox box_around(const ParticleReader& particles) {
  AxisBox box;
  box.lower.fill(std::numeric_limits<double>::infinity());
  box.upper.fill(-std::numeric_limits<double>::infinity());
  particles.for_each_range(field::position, [&](const Snapshot& s) {
    for (size_t n = 0; n < s.position.size(); ++n) {
      box.lower[n % 3] = std::min(box.lower[n % 3], s.position[n]);
      box.upper[n % 3] = std::max(box.upper[n % 3], s.position[n]);
    }
  });
  return box;
}

double length(const Point& v) {
  return std::hypot(v[0], v[1], v[2]);
}

}  // namespace

ResultantShare resultant_share(const Scene& scene, const BalanceReport& balance,
                               const ParticleReader& initial, double time) {
  ResultantShare share;
  const auto resultants = exact_resultants(scene, balance.torque_about);
  for (size_t k = 0; k < resultants.size(); ++k)
    share.load += std::abs(scene.tractions[k].time(time)) * resultants[k].load;

  const auto box = box_around(initial);
  const Point& force = balance.net_force;
  Point torque = balance.net_torque, middle{};
  double half_width = 0;
  for (size_t i = 0; i < 3; ++i) {
    middle[i] = 0.5 * (box.lower[i] + box.upper[i]);
    half_width = std::max(half_width, 0.5 * (box.upper[i] - box.lower[i]));
  }
  for (size_t i = 0; i < 3; ++i) {
    const size_t j = (i + 1) % 3, k = (i + 2) % 3;
    torque[i] -=
        (middle[j] - balance.torque_about[j]) * force[k] - (middle[k] - balance.torque_about[k]) * force[j];
  }
  share.net_force = length(force) / share.load;
  share.net_torque = length(torque) / (share.load * half_width);
  return share;
}

}  // namespace vsb::app
