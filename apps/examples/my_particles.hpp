// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The particle code that embeds vsb: its particles, an array of structures with a member that vsb knows
/// nothing about.
#pragma once

#include <cmath>
#include <vector>
#include <vsb/views/particles.hpp>

using Exec = Kokkos::DefaultHostExecutionSpace;
using Device = Exec::device_type;

struct MyParticle {
  double x[2], v[2], stress[4];  // xx yy zz xy
  double mass, volume;
  int colour;
};

/// A block of 2 m by 1 m, 0.25 m apart, of 1000 kg/m^3; its lower left corner is at (1, 0).
inline std::vector<MyParticle> make_block() {
  std::vector<MyParticle> mine;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 8; ++i)
      mine.push_back({{1.125 + 0.25 * i, 0.125 + 0.25 * j}, {0, 0}, {0, 0, 0, 0}, 62.5, 0.0625, i});
  return mine;
}

/// Wrapped, not copied: where the first value is, how many particles and columns, and the distance from one
/// particle to the next in doubles.
inline vsb::Particles<2, double, Device> wrap(std::vector<MyParticle>& mine) {
  const int n = static_cast<int>(mine.size()), stride = sizeof(MyParticle) / sizeof(double);
  vsb::Particles<2, double, Device> particles;
  particles.position = particles.wrap(mine[0].x, n, 2, stride);
  particles.velocity = particles.wrap(mine[0].v, n, 2, stride);
  particles.cauchy_stress = particles.wrap(mine[0].stress, n, 4, stride);
  particles.mass = particles.wrap(&mine[0].mass, n, stride);
  particles.volume = particles.wrap(&mine[0].volume, n, stride);
  return particles;
}

/// Of the axial stress, relative to a pressure of 10 kPa.
inline double largest_error(const std::vector<MyParticle>& mine) {
  double worst = 0;
  for (const auto& p : mine) worst = std::fmax(worst, std::fabs(p.stress[0] / -1e4 - 1));
  return worst;
}
