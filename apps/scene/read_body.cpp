// SPDX-License-Identifier: BSD-3-Clause
#include "scene/read_body.hpp"

#include <fmt/format.h>

namespace vsb::app {

BodySpec read_body(TableReader r, const Scene& scene, size_t number) {
  const auto& keys = body_keys;
  const int dimension = scene.dimension;
  BodySpec body;
  body.where = location(r.source());
  body.name = r.read(keys.name, fmt::format("body {}", number + 1));
  body.region = read_region(r, keys.shape, dimension, false);
  read_lattice(r, keys.lattice, scene, body);
  body.density = r.read(keys.density);
  body.stress = read_affine<6>(r, keys.stress, 6, dimension);
  if (const auto* stress = r.written(keys.stress)) body.stress_where = location(*stress);
  body.velocity = read_affine<3>(r, keys.velocity, static_cast<size_t>(dimension), dimension);
  body.material = read_material(r.table(keys.material));
  if (body.material.law == MaterialLaw::hencky && r.has(keys.stress) && !is_zero(body.stress))
    r.fail(keys.stress,
           "a body with law = \"hencky\" starts without stress: its stress follows from its deformation, and "
           "it starts undeformed");
  r.finish();
  return body;
}

}  // namespace vsb::app
