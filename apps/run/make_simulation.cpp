// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "run/place_particles.hpp"
#include "run/simulation_instances.hpp"

namespace vsb::app {

namespace {

template <int Dim>
std::unique_ptr<Simulation> make_in_dimension(const Scene& scene) {
  if (scene.grid.mapped()) return make_instance<Dim, InstanceOf::mapped>(scene);
  if (scene.single_precision) return make_instance<Dim, InstanceOf::linear_float>(scene);
  switch (scene.method.basis) {
    case BasisKind::ugimp:
      return make_instance<Dim, InstanceOf::ugimp>(scene);
    case BasisKind::quadratic_bspline:
      return make_instance<Dim, InstanceOf::quadratic_bspline>(scene);
    default:
      return make_instance<Dim, InstanceOf::linear>(scene);
  }
}

}  // namespace

std::unique_ptr<Simulation> make_simulation(const Scene& scene) {
  switch (scene.dimension) {
    case 1:
      return make_in_dimension<1>(scene);
    case 2:
      return make_in_dimension<2>(scene);
    default:
      return make_in_dimension<3>(scene);
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
