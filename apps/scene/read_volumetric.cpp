// SPDX-License-Identifier: BSD-3-Clause
#include "scene/read_volumetric.hpp"

#include <algorithm>

namespace vsb::app {

bool may_lock(const Scene& scene) {
  return scene.dimension > 1 &&
         std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const BodySpec& body) {
           return body.material.poisson_ratio >= locking_poisson_ratio;
         });
}

void read_volumetric(TableReader& method, Scene& scene) {
  const std::string preset = "full";
  scene.method.averaged = method.choice("volumetric", {"full", "averaged"}, preset) == "averaged";
  if (scene.method.averaged && scene.dimension == 1)
    method.fail(*method.source().get("volumetric"), "volumetric",
                "\"averaged\" is for dimension 2 and 3: in 1D nothing locks, volume being all there is to "
                "strain");
}

}  // namespace vsb::app
