// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "engine/simulation_instances.hpp"
#include "setup/place_particles.hpp"

namespace vsb::app {

std::unique_ptr<Simulation> make_simulation(const Scene& scene, PlacedParticles* placed) {
#ifdef VSB_LINEAR_ONLY
  if (scene.grid.mapped() || scene.single_precision || scene.method.basis != BasisKind::linear)
    throw SetupError(
        "this vsb was built with VSB_LINEAR_ONLY: for linear functions on uniform grids in double precision "
        "alone");
  return make_instance<InstanceOf::linear>(scene, placed);
#else
  if (scene.grid.mapped()) return make_instance<InstanceOf::mapped>(scene, placed);
  if (scene.single_precision) return make_instance<InstanceOf::linear_float>(scene, placed);
  switch (scene.method.basis) {
    case BasisKind::ugimp:
      return make_instance<InstanceOf::ugimp>(scene, placed);
    case BasisKind::quadratic_bspline:
      return make_instance<InstanceOf::quadratic_bspline>(scene, placed);
    case BasisKind::linear:
      break;
  }
  return make_instance<InstanceOf::linear>(scene, placed);
#endif
}

std::string ByteHash::text() const {
  return fmt::format("{:016x}", hash_);
}

std::string state_hash(Simulation& simulation) {
  ByteHash hash;
  simulation.save_particles(hash);
  return hash.text();
}

int count_particles(const Scene& scene) {
  return static_cast<int>(place_particles(scene).position.size());
}

}  // namespace vsb::app
