// SPDX-License-Identifier: BSD-3-Clause
#include "scene/read_body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace vsb::app {

namespace {

/// Whether a stress has shear components that a scene of this dimension does not know.
bool has_shear_beyond(const Affine<std::array<double, 6>>& stress, int dimension) {
  const auto beyond = [&](const std::array<double, 6>& row) {
    const int known = dimension == 1 ? 3 : dimension == 2 ? 4 : 6;
    return std::any_of(row.begin() + known, row.end(), [](double x) { return x != 0; });
  };
  return beyond(stress.value) || std::any_of(std::begin(stress.gradient), std::end(stress.gradient), beyond);
}

}  // namespace

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
  if (has_shear_beyond(body.stress, dimension))
    r.fail(keys.stress, fmt::format("xx yy zz xy yz xz: in dimension {} {} must be 0", dimension,
                                    dimension == 1 ? "xy, yz and xz" : "yz and xz"));
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
