// SPDX-License-Identifier: BSD-3-Clause
#include "scene/read_lattice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/units.hpp"

namespace vsb::app {

namespace {

CellLattice read_cells(TableReader& body_table, const LatticeKeys& keys, size_t d, Setting setting) {
  CellLattice lattice;
  const auto preset = setting == Setting::accurate ? std::optional<int>(2) : std::nullopt;
  const auto n = body_table.read(keys.particles_per_cell, d, preset);
  std::copy(n.begin(), n.end(), lattice.particles_per_cell.begin());
  return lattice;
}

UniformLattice read_uniform(TableReader r, const GridSpec& grid, size_t d) {
  UniformLattice lattice;
  const auto& keys = uniform_lattice_keys;
  const auto spacing = r.read(keys.spacing, d);
  const Point corner = bounding_box(grid, static_cast<int>(d)).lower;
  const std::vector<double> lower(corner.begin(), corner.begin() + static_cast<std::ptrdiff_t>(d));
  const auto origin = r.read(keys.origin.of(d), lower);
  r.finish();
  std::copy(spacing.begin(), spacing.end(), lattice.spacing.begin());
  std::copy(origin.begin(), origin.end(), lattice.origin.begin());
  const auto box = bounding_box(grid, static_cast<int>(d));
  double points = 1;
  for (size_t i = 0; i < d; ++i) {
    points *= (box.upper[i] - box.lower[i]) / spacing[i];
    if (std::abs(box.lower[i] - origin[i]) > 1e9 * spacing[i])
      r.fail(keys.origin, "must lie within 1e9 spacings of the grid's lower corner");
  }
  if (!(points <= 1e10))
    r.fail(keys.spacing, fmt::format("the grid must hold <= 1e10 points of the lattice, not {:.3g}", points));
  return lattice;
}

ConcentricLattice read_concentric(TableReader r, size_t d) {
  const auto& keys = concentric_lattice_keys;
  ConcentricLattice lattice;
  const auto center = r.read(keys.center);
  std::copy(center.begin(), center.end(), lattice.center.begin());
  const auto radii = r.read(keys.radii);
  if (!(radii[1] > radii[0])) r.fail(keys.radii, "the outer radius must be greater than the inner one");
  lattice.inner_radius = radii[0];
  lattice.outer_radius = radii[1];
  lattice.rings = static_cast<int>(r.read(keys.rings));
  lattice.per_ring = static_cast<int>(r.read(keys.per_ring));
  const auto angles = r.read(keys.angles, std::vector<double>{0.0, 360.0});
  if (!(angles[1] > angles[0]) || angles[1] - angles[0] > 360)
    r.fail(keys.angles, "the second must be greater, by at most 360");
  lattice.first_angle = radians(angles[0]);
  lattice.last_angle = radians(angles[1]);
  if (d == 3) {
    if (!r.has(keys.layers)) r.missing(keys.layers, "a table with lower, upper and count, along z");
    TableReader layers = r.table(keys.layers);
    lattice.lower = layers.read(layers_keys.lower);
    lattice.upper = layers.read(layers_keys.upper.within(Range::above(lattice.lower)));
    lattice.layers = static_cast<int>(layers.read(layers_keys.count));
    layers.finish();
  } else if (r.has(keys.layers)) {
    r.fail(keys.layers, "layers are for dimension 3");
  }
  r.finish();
  return lattice;
}

BoundaryBoxes read_boundary(TableReader& body_table, const LatticeKeys& keys, const Scene& scene) {
  const bool mapped = scene.grid.mapped();
  const bool cuts = scene.setting == Setting::accurate && !mapped && !body_table.has(keys.jitter);
  const auto boundary =
      body_table.read<BoundaryBoxes>(keys.boundary, cuts ? BoundaryBoxes::cut2x2 : BoundaryBoxes::keep);
  if (boundary != BoundaryBoxes::keep && mapped)
    body_table.fail(
        keys.boundary,
        "only \"keep\" here: on a rectilinear or polar grid the lattice has no equal boxes to cut");
  return boundary;
}

}  // namespace

void read_lattice(TableReader& body_table, const LatticeKeys& keys, const Scene& scene, BodySpec& body) {
  const int dimension = scene.dimension;
  const auto& grid = scene.grid;
  const auto d = static_cast<size_t>(dimension);
  if (!body_table.has(keys.lattice)) {
    if (!body_table.has(keys.particles_per_cell) && scene.setting == Setting::paper)
      body_table.missing(keys.particles_per_cell,
                         "an integer >= 1, or a table lattice.uniform or lattice.concentric");
    body.lattice = read_cells(body_table, keys, d, scene.setting);
  } else {
    if (body_table.has(keys.particles_per_cell))
      body_table.fail(keys.lattice, "give either particles_per_cell or a lattice, not both");
    TableReader lattice = body_table.table(keys.lattice);
    if (lattice.has(lattice_keys.uniform) == lattice.has(lattice_keys.concentric))
      body_table.fail(keys.lattice, "must have one of uniform and concentric");
    if (lattice.has(lattice_keys.concentric)) {
      if (dimension == 1) body_table.fail(keys.lattice, "a concentric lattice is for dimension 2 or 3");
      for (const Key* key : KeyList{&keys.jitter, &keys.seed, &keys.boundary})
        if (body_table.has(*key))
          body_table.fail(*key, "is for particles_per_cell and lattice.uniform, not for rings");
      body.lattice = read_concentric(lattice.table(lattice_keys.concentric), d);
    } else {
      body.lattice = read_uniform(lattice.table(lattice_keys.uniform), grid, d);
    }
    lattice.finish();
  }
  if (std::holds_alternative<ConcentricLattice>(body.lattice)) return;
  body.boundary = read_boundary(body_table, keys, scene);
  body.jitter.amount = body_table.read(keys.jitter);
  if (body.jitter.amount > 0 && grid.mapped() && std::holds_alternative<CellLattice>(body.lattice))
    body_table.fail(keys.jitter,
                    "is for uniform grids and for lattice.uniform, not for particles_per_cell on this grid");
  if (body.jitter.amount > 0 && body.boundary != BoundaryBoxes::keep)
    body_table.fail(keys.jitter,
                    "would move particles away from the centroids of the boxes; is for boundary = \"keep\"");
  body.jitter.seed = static_cast<std::uint64_t>(body_table.read(keys.seed));
}

}  // namespace vsb::app
