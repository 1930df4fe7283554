// SPDX-License-Identifier: BSD-3-Clause
#include "scene/read_method.hpp"

namespace vsb::app {

void read_method(TableReader r, bool as_in_paper, Scene& scene) {
  const auto& keys = method_keys;
  MethodSpec& m = scene.method;
  read_basis(r, keys.basis, scene);
  m.damping = r.read(keys.damping);
  m.volume_update = r.read(keys.volume_update);
  m.scatter = r.read(keys.scatter);
  m.engine = r.read(keys.engine);
  m.cell_gauss_points = static_cast<int>(r.read(keys.cell_gauss_points));
  m.fill_criterion = r.read(keys.fill_criterion);
  m.void_filter = r.read(keys.void_filter);
  read_moment_fit(r, keys.moment_fit, scene);
  read_volumetric(r, keys.volumetric, as_in_paper, scene);
  m.moves_by_grid = r.read<bool>(keys.position_velocity, as_in_paper);
  m.pic = r.read(keys.pic);
  if (m.pic > 0 && m.moves_by_grid)
    r.fail(
        keys.pic,
        "needs position_velocity = \"strain\": with \"grid\" the particles' places drift from their strains");
  m.allow_particles_on_grid_lines = r.read(keys.allow_particles_on_grid_lines);
  r.finish();
}

}  // namespace vsb::app
