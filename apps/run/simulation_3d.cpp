// SPDX-License-Identifier: BSD-3-Clause
#include "run/simulation_of.hpp"

namespace vsb::app {
std::unique_ptr<Simulation> make_simulation_3d(const Scene& scene) {
  return make_simulation_of<3>(scene);
}
}  // namespace vsb::app
