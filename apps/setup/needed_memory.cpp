// SPDX-License-Identifier: BSD-3-Clause
#include "setup/needed_memory.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

#include "setup/lattice_points.hpp"
#include "setup/region_size.hpp"
#include "setup/setup_error.hpp"

namespace vsb::app {

namespace {

constexpr double most_numbers = std::numeric_limits<int>::max();

double bytes_per_number(const Scene& scene) {
  return scene.single_precision ? sizeof(float) : sizeof(double);
}

double nodes_of(const Scene& scene) {
  double nodes = 1;
  for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i) nodes *= scene.grid.cells[i] + 1.0;
  return nodes;
}

/// Mass, momentum, force, acceleration and two velocities (views/nodes.hpp).
double bytes_per_node(const Scene& scene) {
  return (1 + 5 * scene.dimension) * bytes_per_number(scene);
}

/// Position, velocity, mass, volume and stress (views/particles.hpp), and the position in the order of the
/// scene.
double bytes_per_particle(const Scene& scene) {
  const int numbers = 2 * scene.dimension + 2 + (scene.dimension == 3 ? 6 : scene.dimension + 2);
  return numbers * bytes_per_number(scene) + double(sizeof(Point) + sizeof(double));
}

/// Of points that are all visited: rings, and the cells of a mapped grid.
double points_to_visit(const Scene& scene, const BodySpec& body) {
  if (const auto* rings = std::get_if<ConcentricLattice>(&body.lattice))
    return static_cast<double>(rings->rings) * rings->per_ring * rings->layers;
  const auto* cells = std::get_if<CellLattice>(&body.lattice);
  if (!cells || !scene.grid.mapped()) return 0;
  double points = 1;
  for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i)
    points *= static_cast<double>(scene.grid.cells[i]) * cells->particles_per_cell[i];
  return points;
}

/// A number of particles that a body has at least, where they lie on a lattice of equal boxes.
double fewest_particles(const Scene& scene, const BodySpec& body) {
  const bool rings = std::holds_alternative<ConcentricLattice>(body.lattice);
  if (rings || (scene.grid.mapped() && std::holds_alternative<CellLattice>(body.lattice))) return 0;
  const auto lattice = uniform_lattice(scene.grid, body.lattice);
  double particles = least_volume(body.region, bounding_box(scene.grid, scene.dimension), scene.dimension);
  for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i) particles /= lattice.spacing[i];
  return particles;
}

std::string size_text(double bytes) {
  const double gigabyte = 1e9;
  return fmt::format("{:.3g} GB", bytes / gigabyte);
}

}  // namespace

double memory_at_hand() {
  double bytes = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  // A container's limit; "max", which is no number, where there is none.
  for (const char* file : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"})
    if (double limit = 0; std::ifstream(file) >> limit) bytes = std::min(bytes, limit);
  rlimit address_space{};
  if (getrlimit(RLIMIT_AS, &address_space) == 0 && address_space.rlim_cur != RLIM_INFINITY)
    bytes = std::min(bytes, static_cast<double>(address_space.rlim_cur));
  return bytes;
}

void refuse_what_does_not_fit(const Scene& scene) {
  const double nodes = nodes_of(scene);
  double particles = 0;
  for (const auto& body : scene.bodies) {
    if (const double points = points_to_visit(scene, body); points > most_numbers)
      throw SetupError(fmt::format(
          "the lattice of body '{}' has {:.3g} points, more than particles can be numbered ({:.0f})",
          body.name, points, most_numbers));
    const double fewest = fewest_particles(scene, body);
    if (fewest > most_numbers)
      throw SetupError(
          fmt::format("body '{}' has {:.3g} particles or more, and at most {:.0f} can be numbered", body.name,
                      fewest, most_numbers));
    particles += fewest;
  }
  const double needed = nodes * bytes_per_node(scene) + particles * bytes_per_particle(scene);
  if (const double there = memory_at_hand(); needed > there)
    throw SetupError(fmt::format(
        "{:.3g} nodes of the grid and {:.3g} particles or more need at least {}, and there are {}: take a "
        "smaller grid, larger cells (grid.spacing) or fewer particles",
        nodes, particles, size_text(needed), size_text(there)));
}

}  // namespace vsb::app
