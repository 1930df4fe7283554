// SPDX-License-Identifier: BSD-3-Clause
#include "setup/lattice_points.hpp"

#include <algorithm>
#include <cmath>

#include "scene/units.hpp"

namespace vsb::app {

namespace {

/// Steele, Lea and Flood, "Fast splittable pseudorandom number generators" (2014): SplitMix64.
std::uint64_t scrambled(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

using Index = LatticeIndex;

/// A number in [-1, 1) for a lattice index and a direction.
double random_number(std::uint64_t seed, const Index& index, size_t direction) {
  std::uint64_t bits = scrambled(seed);
  for (const long long i : index) bits = scrambled(bits ^ static_cast<std::uint64_t>(i));
  bits = scrambled(bits ^ direction);
  return static_cast<double>(bits >> 11) * 0x1p-52 - 1;
}

using Visit = std::function<void(const LatticePoint&)>;

void visit_points(const UniformLattice& lattice, const Scene& scene, const BodySpec& body,
                  const Visit& visit) {
  const auto d = static_cast<size_t>(scene.dimension);
  const Jitter& jitter = body.jitter;
  const auto [first, last] =
      lattice_range(lattice, body, bounding_box(scene.grid, scene.dimension), scene.dimension);
  double volume = 1;
  for (size_t i = 0; i < d; ++i) volume *= lattice.spacing[i];
  for (long long k = first[2]; k < last[2]; ++k)
    for (long long j = first[1]; j < last[1]; ++j)
      for (long long i = first[0]; i < last[0]; ++i) {
        const Index index{i, j, k};
        LatticePoint point{{}, volume, {}, lattice.spacing};
        for (size_t c = 0; c < d; ++c) {
          point.x[c] = lattice.point(index, c);
          if (jitter.amount > 0)
            point.shift[c] = jitter.amount * random_number(jitter.seed, index, c) * lattice.spacing[c];
        }
        visit(point);
      }
}

/// Angles about the centre of a polar grid.
struct Sector {
  double first, last;  ///< radians
};

/// The angles of a box's points; a whole turn where the centre is one of them.
Sector sector_of(const AxisBox& box, const Point& center) {
  const double x[] = {box.lower[0] - center[0], box.upper[0] - center[0]},
               y[] = {box.lower[1] - center[1], box.upper[1] - center[1]};
  if (x[0] <= 0 && x[1] >= 0 && y[0] <= 0 && y[1] >= 0) return {-pi, pi};
  const double mx = 0.5 * (x[0] + x[1]), my = 0.5 * (y[0] + y[1]), middle = std::atan2(my, mx);
  Sector sector{middle, middle};
  for (const double cx : x)
    for (const double cy : y) {  // the box lies on one side of a line through the centre
      const double angle = middle + std::atan2(mx * cy - my * cx, mx * cx + my * cy);
      sector.first = std::min(sector.first, angle);
      sector.last = std::max(sector.last, angle);
    }
  return sector;
}

/// The cells along an axis that an interval of its coordinate may reach, and one more on either side, beside
/// those of the range.
void add_cells(const std::vector<double>& nodes, double low, double high, long long& first, long long& last) {
  if (high < nodes.front() || low > nodes.back()) return;
  const auto node = [&](double x) { return std::lower_bound(nodes.begin(), nodes.end(), x) - nodes.begin(); };
  const auto cells = static_cast<long long>(nodes.size()) - 1;
  const auto from = std::max<long long>(0, node(low) - 2), to = std::min<long long>(cells, node(high) + 1);
  const bool none = first >= last;
  first = none ? from : std::min(first, from);
  last = none ? to : std::max(last, to);
}

/// The cells of a mapped grid that a body may reach, and one more on either side.
LatticeRange cells_around(const GridSpec& grid, int dimension, const AxisBox& bounds) {
  LatticeRange range;
  for (size_t i = 0; i < static_cast<size_t>(dimension); ++i) {
    range.last[i] = 0;
    double low = bounds.lower[i], high = bounds.upper[i];
    if (grid.polar && i == 0) {
      double nearest[2], farthest[2];
      for (size_t c = 0; c < 2; ++c) {
        nearest[c] = std::max({bounds.lower[c] - grid.center[c], 0.0, grid.center[c] - bounds.upper[c]});
        farthest[c] = std::max(grid.center[c] - bounds.lower[c], bounds.upper[c] - grid.center[c]);
      }
      low = std::hypot(nearest[0], nearest[1]);
      high = std::hypot(farthest[0], farthest[1]);
    }
    if (!grid.polar || i != 1) {
      add_cells(grid.coordinates[i], low, high, range.first[i], range.last[i]);
      continue;
    }
    const double radius = grid.coordinates[0].back();
    AxisBox box = bounds;
    for (size_t c = 0; c < 2; ++c) {
      box.lower[c] = std::max(box.lower[c], grid.center[c] - radius);
      box.upper[c] = std::min(box.upper[c], grid.center[c] + radius);
    }
    const Sector sector = sector_of(box, grid.center);
    for (int turn = -3; turn <= 3; ++turn)  // angles of a grid are between -2 pi and 2 pi
      add_cells(grid.coordinates[i], sector.first + turn * 2 * pi, sector.last + turn * 2 * pi,
                range.first[i], range.last[i]);
  }
  return range;
}

void visit_points(const CellLattice& lattice, const Scene& scene, const BodySpec& body, const Visit& visit) {
  if (scene.grid.mapped()) {
    const auto& per_cell = lattice.particles_per_cell;
    auto [first, last] = cells_around(scene.grid, scene.dimension, body.region.bounds());
    for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i) {
      first[i] *= per_cell[i];
      last[i] *= per_cell[i];
    }
    for (long long k = first[2]; k < last[2]; ++k)
      for (long long j = first[1]; j < last[1]; ++j)
        for (long long i = first[0]; i < last[0]; ++i) {
          const auto share = cell_share(scene.grid, scene.dimension, per_cell, {i, j, k});
          visit({share.position, share.volume, {}, share.edges});
        }
    return;
  }
  visit_points(uniform_lattice(scene.grid, lattice), scene, body, visit);
}

void visit_points(const ConcentricLattice& lattice, const Scene& scene, const BodySpec&, const Visit& visit) {
  // The faces of a uniform grid that sectors stand on are rays, as those of constant angle of a polar one.
  const bool polar = scene.grid.polar;
  const double dr = (lattice.outer_radius - lattice.inner_radius) / lattice.rings;
  const double dtheta = (lattice.last_angle - lattice.first_angle) / lattice.per_ring;
  const double dz = scene.dimension == 3 ? (lattice.upper - lattice.lower) / lattice.layers : 1;
  for (int layer = 0; layer < lattice.layers; ++layer)
    for (int ring = 0; ring < lattice.rings; ++ring)
      for (int sector = 0; sector < lattice.per_ring; ++sector) {
        const double r = lattice.inner_radius + (ring + 0.5) * dr;
        const double theta = lattice.first_angle + (sector + 0.5) * dtheta;
        const double z = scene.dimension == 3 ? lattice.lower + (layer + 0.5) * dz : 0;
        visit({{lattice.center[0] + r * std::cos(theta), lattice.center[1] + r * std::sin(theta), z},
               r * dr * dtheta * dz,
               {},
               {polar ? dr : r * dtheta, r * dtheta, dz}});
      }
}

}  // namespace

UniformLattice uniform_lattice(const GridSpec& grid, const Lattice& lattice) {
  if (const auto* uniform = std::get_if<UniformLattice>(&lattice)) return *uniform;
  const auto& per_cell = std::get<CellLattice>(lattice).particles_per_cell;
  UniformLattice uniform;
  uniform.origin = grid.lower;
  for (size_t i = 0; i < 3; ++i) uniform.spacing[i] = grid.spacing[i] / per_cell[i];
  return uniform;
}

LatticeRange lattice_range(const UniformLattice& lattice, const BodySpec& body, const AxisBox& box,
                           int dimension) {
  const AxisBox bounds = body.region.bounds();
  LatticeRange range;
  for (size_t i = 0; i < static_cast<size_t>(dimension); ++i) {
    const auto intervals = [&](double x) { return (x - lattice.origin[i]) / lattice.spacing[i]; };
    const double begin = intervals(box.lower[i]);
    const double first = std::floor(begin);
    const double last = std::ceil(begin + (box.upper[i] - box.lower[i]) / lattice.spacing[i]);
    // Round-off must not leave out the interval that ends at the body's bound: one more on either side.
    const double from = std::max(first, std::floor(intervals(bounds.lower[i])) - 1);
    const double to = std::min(last, std::ceil(intervals(bounds.upper[i])) + 1);
    if (!(from < to)) return {{0, 0, 0}, {0, 0, 0}};
    range.first[i] = static_cast<long long>(from);
    range.last[i] = static_cast<long long>(to);
  }
  return range;
}

void for_each_lattice_point(const Scene& scene, const BodySpec& body, const Visit& visit) {
  std::visit([&](const auto& lattice) { visit_points(lattice, scene, body, visit); }, body.lattice);
}

}  // namespace vsb::app
