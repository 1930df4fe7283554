// SPDX-License-Identifier: BSD-3-Clause
#include "scene/read_volumetric.hpp"

#include <algorithm>

namespace vsb::app {

namespace {

/// Where nothing can be averaged.
std::string refusal(const Scene& scene) {
  if (scene.dimension == 1) return "\"averaged\" is for dimension 2 and 3: in 1D nothing locks";
  if (scene.method.basis == BasisKind::ugimp)
    return "\"averaged\" is for basis = \"linear\" and \"quadratic_bspline\"";
  return "";
}

}  // namespace

bool may_lock(const BodySpec& body) {
  return body.material.poisson_ratio >= locking_poisson_ratio;
}

void read_volumetric(TableReader& method, const ChoiceKeyOf<bool>& key, bool as_in_paper, Scene& scene) {
  const auto reason = refusal(scene);
  const auto locks = [&](const BodySpec& body) {
    return may_lock(body) || (!as_in_paper && is_plastic(body.material.law));
  };
  const bool preset = reason.empty() && std::any_of(scene.bodies.begin(), scene.bodies.end(), locks);
  scene.method.averaged = method.read<bool>(key, preset);
  if (scene.method.averaged && !reason.empty()) method.fail(key, reason);
}

}  // namespace vsb::app
