// SPDX-License-Identifier: BSD-3-Clause
#include "scene/read_lattice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/units.hpp"

namespace vsb::app {

namespace {

CellLattice read_cells(TableReader& body_table, size_t d, Setting setting) {
  CellLattice lattice;
  const auto preset = setting == Setting::accurate ? std::optional<int>(2) : std::nullopt;
  const auto n = body_table.integer_or_integers("particles_per_cell", d, 1, 64, preset, "in each direction");
  std::copy(n.begin(), n.end(), lattice.particles_per_cell.begin());
  return lattice;
}

UniformLattice read_uniform(TableReader r, const GridSpec& grid, size_t d) {
  UniformLattice lattice;
  r.allow_only({"spacing", "origin"});
  const auto spacing = r.number_or_numbers("spacing", d, Range::positive(), {}, "m");
  const Point corner = bounding_box(grid, static_cast<int>(d)).lower;
  const std::vector<double> lower(corner.begin(), corner.begin() + static_cast<std::ptrdiff_t>(d));
  const auto origin =
      r.numbers("origin", d, Range::any(), lower, "m; particles at origin + (k + 1/2) spacing");
  r.finish();
  std::copy(spacing.begin(), spacing.end(), lattice.spacing.begin());
  std::copy(origin.begin(), origin.end(), lattice.origin.begin());
  const auto box = bounding_box(grid, static_cast<int>(d));
  double points = 1;
  for (size_t i = 0; i < d; ++i) {
    points *= (box.upper[i] - box.lower[i]) / spacing[i];
    if (std::abs(box.lower[i] - origin[i]) > 1e9 * spacing[i])
      r.fail(*r.source().get("origin"), "origin", "must lie within 1e9 spacings of the grid's lower corner");
  }
  if (!(points <= 1e10))
    r.fail(*r.source().get("spacing"), "spacing",
           fmt::format("the grid must hold <= 1e10 points of the lattice, not {:.3g}", points));
  return lattice;
}

ConcentricLattice read_concentric(TableReader r, size_t d) {
  ConcentricLattice lattice;
  r.allow_only({"center", "radii", "rings", "per_ring", "angles", "layers"});
  const auto center = r.numbers("center", 2, Range::any(), {}, "m, x and y");
  std::copy(center.begin(), center.end(), lattice.center.begin());
  const auto radii = r.numbers("radii", 2, Range::at_least(0), {}, "m, inner and outer");
  if (!(radii[1] > radii[0]))
    r.fail(*r.source().get("radii"), "radii", "the outer radius must be greater than the inner one");
  lattice.inner_radius = radii[0];
  lattice.outer_radius = radii[1];
  lattice.rings = static_cast<int>(r.integer("rings", 1, 1'000'000));
  lattice.per_ring =
      static_cast<int>(r.integer("per_ring", 1, 10'000'000, {}, "particles between the angles"));
  const auto angles =
      r.numbers("angles", 2, Range::any(), std::vector<double>{0.0, 360.0}, "degrees from the x axis");
  if (!(angles[1] > angles[0]) || angles[1] - angles[0] > 360)
    r.fail(*r.source().get("angles"), "angles", "the second must be greater, by at most 360");
  lattice.first_angle = radians(angles[0]);
  lattice.last_angle = radians(angles[1]);
  if (d == 3) {
    if (!r.has("layers")) r.missing("layers", "a table with lower, upper and count, along z");
    TableReader layers = r.table("layers");
    layers.allow_only({"lower", "upper", "count"});
    lattice.lower = layers.number("lower", Range::any(), {}, "m along z");
    lattice.upper = layers.number("upper", {lattice.lower, Range::any().max, true, false}, {}, "m along z");
    lattice.layers = static_cast<int>(layers.integer("count", 1, 1'000'000));
    layers.finish();
  } else if (r.has("layers")) {
    r.fail(*r.source().get("layers"), "layers", "layers are for dimension 3");
  }
  r.finish();
  return lattice;
}

BoundaryBoxes read_boundary(TableReader& body_table, const GridSpec& grid, Setting setting) {
  static const std::vector<std::string> names = {"keep", "cut", "cut2x2"};
  const bool cuts = setting == Setting::accurate && !grid.mapped() && !body_table.has("jitter");
  const std::string name = body_table.choice("boundary", names, names[cuts ? 2 : 0]);
  const auto boundary =
      static_cast<BoundaryBoxes>(std::find(names.begin(), names.end(), name) - names.begin());
  if (boundary != BoundaryBoxes::keep && grid.mapped())
    body_table.fail(
        *body_table.source().get("boundary"), "boundary",
        "only \"keep\" here: on a rectilinear or polar grid the lattice has no equal boxes to cut");
  return boundary;
}

}  // namespace

void read_lattice(TableReader& body_table, const Scene& scene, BodySpec& body) {
  const int dimension = scene.dimension;
  const auto& grid = scene.grid;
  const auto d = static_cast<size_t>(dimension);
  const toml::node* written = body_table.source().get("lattice");
  if (!written) {
    if (!body_table.has("particles_per_cell") && scene.setting == Setting::paper)
      body_table.missing("particles_per_cell",
                         "an integer >= 1, or a table lattice.uniform or lattice.concentric");
    body.lattice = read_cells(body_table, d, scene.setting);
  } else {
    if (body_table.has("particles_per_cell"))
      body_table.fail(*written, "lattice", "give either particles_per_cell or a lattice, not both");
    TableReader lattice = body_table.table("lattice");
    if (lattice.has("uniform") == lattice.has("concentric"))
      body_table.fail(*written, "lattice", "must have one of uniform and concentric");
    if (lattice.has("concentric")) {
      if (dimension == 1)
        body_table.fail(*written, "lattice", "a concentric lattice is for dimension 2 or 3");
      for (const char* key : {"jitter", "seed", "boundary"})
        if (const auto* node = body_table.source().get(key))
          body_table.fail(*node, key, "is for particles_per_cell and lattice.uniform, not for rings");
      body.lattice = read_concentric(lattice.table("concentric"), d);
    } else {
      body.lattice = read_uniform(lattice.table("uniform"), grid, d);
    }
    lattice.finish();
  }
  if (std::holds_alternative<ConcentricLattice>(body.lattice)) return;
  body.boundary = read_boundary(body_table, grid, scene.setting);
  body.jitter.amount =
      body_table.number("jitter", {0, 0.5, false, true}, 0.0,
                        "random shift of every particle, in spacings: at most this either way");
  if (body.jitter.amount > 0 && grid.mapped() && std::holds_alternative<CellLattice>(body.lattice))
    body_table.fail(*body_table.source().get("jitter"), "jitter",
                    "is for uniform grids and for lattice.uniform, not for particles_per_cell on this grid");
  if (body.jitter.amount > 0 && body.boundary != BoundaryBoxes::keep)
    body_table.fail(*body_table.source().get("jitter"), "jitter",
                    "would move particles away from the centroids of the boxes; is for boundary = \"keep\"");
  body.jitter.seed = static_cast<std::uint64_t>(
      body_table.integer("seed", 0, std::numeric_limits<long long>::max(), 1, "of the random shifts"));
}

}  // namespace vsb::app
