// SPDX-License-Identifier: BSD-3-Clause
#include "scene/read_moment_fit.hpp"

#include <algorithm>

#include "scene/read_basis.hpp"

namespace vsb::app {

namespace {

std::string refusal(const Scene& scene) {
  if (scene.method.basis != BasisKind::linear)
    return "is for basis = \"linear\": sums with wider functions run over several cells, and fitting them "
           "cell by cell makes them worse" +
           linear_beside_setting(scene);
  if (scene.grid.mapped()) return "is for uniform grids, whose cells are boxes";
  if (std::none_of(scene.bodies.begin(), scene.bodies.end(), is_irregular))
    return "is for particles on rings (lattice.concentric) or with jitter: on a lattice of equal boxes the "
           "plain "
           "sums are exact in full cells";
  return "";
}

}  // namespace

void read_moment_fit(TableReader& method, const BooleanKey& key, Scene& scene) {
  scene.method.moment_fit = method.read(key);
  if (!scene.method.moment_fit) return;
  if (const auto reason = refusal(scene); !reason.empty()) method.fail(key, reason);
}

}  // namespace vsb::app
