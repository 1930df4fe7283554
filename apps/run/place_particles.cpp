// SPDX-License-Identifier: BSD-3-Clause
#include "run/place_particles.hpp"

#include <fmt/format.h>

#include <limits>

#include "run/simulation.hpp"

namespace vsb::app {

PlacedParticles place_particles(const Scene& scene) {
  PlacedParticles placed;
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    const auto& body = scene.bodies[b];
    std::array<long long, 3> points{1, 1, 1};
    for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i)
      points[i] = static_cast<long long>(scene.grid.cells[i]) * body.particles_per_cell[i];
    const auto first = placed.position.size();
    for (long long k = 0; k < points[2]; ++k)
      for (long long j = 0; j < points[1]; ++j)
        for (long long i = 0; i < points[0]; ++i) {
          const auto [x, volume] =
              lattice_point(scene.grid, scene.dimension, body.particles_per_cell, {i, j, k});
          if (!body.region(x)) continue;
          for (size_t other = 0; other < b; ++other)
            if (scene.bodies[other].region(x))
              throw SetupError(fmt::format(
                  "body '{}' overlaps body '{}' at ({}, {}, {}): cut one out of the other with a difference",
                  body.name, scene.bodies[other].name, x[0], x[1], x[2]));
          placed.position.push_back(x);
          placed.volume.push_back(volume);
        }
    if (placed.position.size() == first)
      throw SetupError(fmt::format(
          "body '{}' has no particle: its shape contains no lattice point of the grid", body.name));
    if (placed.position.size() > static_cast<size_t>(std::numeric_limits<int>::max()))
      throw SetupError("more than 2^31 particles");
    placed.bodies.push_back({static_cast<int>(first), static_cast<int>(placed.position.size())});
  }
  return placed;
}

}  // namespace vsb::app
