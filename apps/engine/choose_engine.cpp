// SPDX-License-Identifier: BSD-3-Clause
#include "engine/choose_engine.hpp"

#include <fmt/format.h>

#include "setup/execution_space.hpp"
#include "setup/setup_error.hpp"

namespace vsb::app {

namespace {

std::string obstacle(const Scene& scene) {
  if (!runs_on_host) return "cell lanes do not run on devices yet";
  if (scene.grid.mapped()) return "its grid is mapped";
  if (scene.method.basis == BasisKind::ugimp) return "its basis is ugimp";
  if (scene.method.scatter != "gathered")
    return fmt::format("method.scatter = \"{}\" is a way of the particle kernels", scene.method.scatter);
  if (scene.method.fill_criterion > 0) return "method.fill_criterion is on";
  if (scene.method.void_filter) return "method.void_filter is on";
  for (const auto& traction : scene.tractions)
    if (traction.self_balanced) return fmt::format("traction '{}' is self-balanced", traction.name);
  if (scene.method.basis == BasisKind::quadratic_bspline)
    for (const auto& traction : scene.tractions)
      if (traction.imposition != Imposition::virtual_stress)
        return fmt::format("its basis is quadratic_bspline, and traction '{}' no virtual stress",
                           traction.name);
  for (const auto& body : scene.bodies) {
    if (!(body.material == scene.bodies.front().material)) return "its bodies differ in their material";
  }
  return {};
}

}  // namespace

std::string reason_for_particle_kernels(const Scene& scene) {
  if (scene.method.engine == "particles") return "method.engine asks for them";
  const auto reason = obstacle(scene);
  if (scene.method.engine == "cell_lanes" && !reason.empty())
    throw SetupError(fmt::format("method.engine = \"cell_lanes\" is not for this scene: {}", reason));
  return reason;
}

}  // namespace vsb::app
