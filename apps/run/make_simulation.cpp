// SPDX-License-Identifier: BSD-3-Clause
#include "run/simulation_of.hpp"

namespace vsb::app {

std::unique_ptr<Simulation> make_simulation(const Scene& scene) {
  switch (scene.dimension) {
    case 1:
      return make_simulation_1d(scene);
    case 2:
      return make_simulation_2d(scene);
    default:
      return make_simulation_3d(scene);
  }
}

std::string state_hash(const SavedState& saved) {
  std::uint64_t hash = 14695981039346656037u;
  for (const unsigned char byte : saved.particles) hash = (hash ^ byte) * 1099511628211u;
  return fmt::format("{:016x}", hash);
}

int count_particles(const Scene& scene) {
  return static_cast<int>(place_particles(scene).position.size());
}

}  // namespace vsb::app
