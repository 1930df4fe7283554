// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The net force and torque of a uniform pressure on 200 random closed bodies, at the boundary nodes and at
/// all of them. Some bodies have none at the boundary nodes either: there the cells on either side of the
/// inner nodes happen to hold equally many columns of particles. `vsb study resultant` is the same by the
/// program, drawn.
#include <algorithm>
#include <cstdio>

#include "random_body.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

/// Shares of pressure times area, and of that times the half width of the body's box.
struct Share {
  double force, torque;
};

template <int Dim>
Share share(RandomBody<Dim>& body, bool conservative) {
  UniformVirtualStress<Dim, double> pressure;
  pressure.count = 1;
  pressure.stress[0] = pressure_stress<Dim>(1e5);
  const auto b = body.resultant(pressure, conservative);
  const double scale = 1e5 * body.area;
  // About the middle of the body, not about the origin.
  auto torque = b.net_torque;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const auto at = [](const Vector<Dim, double>& v, int c) { return c < Dim ? v[c] : 0.0; };
    torque[i] -= at(body.center, j) * at(b.net_force, k) - at(body.center, k) * at(b.net_force, j);
  }
  return {length(b.net_force) / scale, length(torque) / (scale * body.half_width)};
}

template <int Dim>
void measure() {
  std::vector<double> boundary, all;
  for (unsigned seed = 1000; seed < 1100; ++seed) {
    RandomBody<Dim> body(seed);
    const auto mod = share(body, false), conservative = share(body, true);
    boundary.push_back(mod.force);
    all.push_back(std::max(conservative.force, conservative.torque));
  }
  std::sort(boundary.begin(), boundary.end());
  std::printf(
      "%dD: |net force| / (pressure area) at the boundary nodes: median %.1e, largest %.1e; at all nodes: "
      "largest %.1e\n",
      Dim, boundary[50], boundary.back(), *std::max_element(all.begin(), all.end()));
  CHECK(*std::max_element(all.begin(), all.end()) < 1e-12);
  CHECK(boundary[50] > 1e-3);  // the bodies tell the two apart
}

}  // namespace

TEST_CASE(
    "a uniform pressure on closed bodies has no resultant at all nodes, and one at the boundary nodes") {
  measure<2>();
  measure<3>();
}
