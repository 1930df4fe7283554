// SPDX-License-Identifier: BSD-3-Clause
#include "run/lattice_points.hpp"

#include <cmath>

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

void visit_points(const UniformLattice& lattice, const Scene& scene, const Jitter& jitter,
                  const Visit& visit) {
  const auto d = static_cast<size_t>(scene.dimension);
  const auto [first, last] =
      lattice_range(lattice, bounding_box(scene.grid, scene.dimension), scene.dimension);
  double volume = 1;
  for (size_t i = 0; i < d; ++i) volume *= lattice.spacing[i];
  for (long long k = first[2]; k < last[2]; ++k)
    for (long long j = first[1]; j < last[1]; ++j)
      for (long long i = first[0]; i < last[0]; ++i) {
        const Index index{i, j, k};
        LatticePoint point{{}, volume, {}};
        for (size_t c = 0; c < d; ++c) {
          point.x[c] = lattice.point(index, c);
          if (jitter.amount > 0)
            point.shift[c] = jitter.amount * random_number(jitter.seed, index, c) * lattice.spacing[c];
        }
        visit(point);
      }
}

void visit_points(const CellLattice& lattice, const Scene& scene, const Jitter& jitter, const Visit& visit) {
  if (scene.grid.mapped()) {
    Index last{1, 1, 1};
    for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i)
      last[i] = static_cast<long long>(scene.grid.cells[i]) * lattice.particles_per_cell[i];
    for (long long k = 0; k < last[2]; ++k)
      for (long long j = 0; j < last[1]; ++j)
        for (long long i = 0; i < last[0]; ++i) {
          const auto share = cell_share(scene.grid, scene.dimension, lattice.particles_per_cell, {i, j, k});
          visit({share.position, share.volume, {}});
        }
    return;
  }
  visit_points(uniform_lattice(scene.grid, lattice), scene, jitter, visit);
}

void visit_points(const ConcentricLattice& lattice, const Scene& scene, const Jitter&, const Visit& visit) {
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
               {}});
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

LatticeRange lattice_range(const UniformLattice& lattice, const AxisBox& box, int dimension) {
  LatticeRange range;
  for (size_t i = 0; i < static_cast<size_t>(dimension); ++i) {
    const double begin = (box.lower[i] - lattice.origin[i]) / lattice.spacing[i];
    range.first[i] = static_cast<long long>(std::floor(begin));
    range.last[i] =
        static_cast<long long>(std::ceil(begin + (box.upper[i] - box.lower[i]) / lattice.spacing[i]));
  }
  return range;
}

void for_each_lattice_point(const Scene& scene, const BodySpec& body, const Visit& visit) {
  std::visit([&](const auto& lattice) { visit_points(lattice, scene, body.jitter, visit); }, body.lattice);
}

}  // namespace vsb::app
