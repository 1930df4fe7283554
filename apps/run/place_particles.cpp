// SPDX-License-Identifier: BSD-3-Clause
#include "run/place_particles.hpp"

#include <fmt/format.h>

#include <limits>

#include "run/box_share.hpp"
#include "run/cut_bodies.hpp"
#include "run/cut_lattice.hpp"
#include "run/lattice_points.hpp"
#include "run/moment_fit.hpp"
#include "run/needed_memory.hpp"
#include "run/simulation.hpp"

namespace vsb::app {

namespace {

bool in_grid(const Scene& scene, const Point& x) {
  return contains(scene.grid, scene.dimension, x);
}

[[noreturn]] void throw_overlap(const BodySpec& body, const BodySpec& other, const Point& x) {
  throw SetupError(
      fmt::format("body '{}' overlaps body '{}' at ({}, {}, {}): cut one out of the other with a difference",
                  body.name, other.name, x[0], x[1], x[2]));
}

/// Calls place(position, volume).
template <class Place>
void place_lattice_points(const Scene& scene, size_t b, const Place& place) {
  const auto& body = scene.bodies[b];
  for_each_lattice_point(scene, body, [&](const LatticePoint& point) {
    Point x = point.x;
    if (!in_grid(scene, x) || !body.region(x)) return;
    for (size_t other = 0; other < b; ++other)
      if (scene.bodies[other].region(x)) throw_overlap(body, scene.bodies[other], x);
    for (size_t i = 0; i < 3; ++i) x[i] += point.shift[i];
    if (!in_grid(scene, x))
      throw SetupError(fmt::format(
          "body '{}': its jitter moves a particle out of the grid, to ({}, {}, {}): make the grid larger, "
          "or let a face of the grid lie between two points of the lattice",
          body.name, x[0], x[1], x[2]));
    place(x, point.volume);
  });
}

/// Bodies that touch share boxes, and the centroid of one's share may lie in the other: they overlap where
/// they have volume in common. Adds to `cut`.
template <class Place>
void place_lattice_shares(const Scene& scene, size_t b, CutVolume& cut, const Place& place) {
  const auto& body = scene.bodies[b];
  const auto limits = bounding_box(scene.grid, scene.dimension);
  const auto volume = for_each_lattice_share(scene, body, limits, [&](const LatticeShare& share) {
    for (size_t other = 0; other < b; ++other) {
      const Region both = intersection_of({body.region, scene.bodies[other].region});
      if (both.overlap(share.box) == Overlap::none) continue;
      const auto common = share_of(both, share.box, scene.dimension);
      if (common.volume > least_share * volume_of(share.box, scene.dimension))
        throw_overlap(body, scene.bodies[other], common.centroid);
    }
    place(share.position, share.volume);
  });
  cut.particles += volume.particles;
  cut.dropped += volume.dropped;
}

template <class Place>
void place_body(const Scene& scene, size_t b, CutVolume& cut, const Place& place) {
  if (scene.bodies[b].boundary == BoundaryBoxes::keep)
    place_lattice_points(scene, b, place);
  else
    place_lattice_shares(scene, b, cut, place);
}

}  // namespace

PlacedParticles place_particles(const Scene& scene) {
  refuse_what_does_not_fit(scene);
  refuse_cut_bodies(scene);
  PlacedParticles placed;
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    const auto& body = scene.bodies[b];
    const auto first = placed.position.size();
    place_body(scene, b, placed.cut, [&](const Point& x, double volume) {
      placed.position.push_back(x);
      placed.volume.push_back(volume);
    });
    if (placed.position.size() == first)
      throw SetupError(fmt::format(
          "body '{}' has no particle: its shape contains no lattice point of the grid", body.name));
    if (placed.position.size() > static_cast<size_t>(std::numeric_limits<int>::max()))
      throw SetupError("more than 2^31 particles");
    placed.bodies.push_back({static_cast<int>(first), static_cast<int>(placed.position.size())});
  }
  if (scene.method.moment_fit) placed.moment_fit = fit_moments(scene, placed);
  return placed;
}

MassCentre mass_centre(const Scene& scene, const PlacedParticles& placed) {
  MassCentre centre;
  Point
      moment{};  // about the first particle: differences of large coordinates are exact where they are small
  const Point& near = placed.position.front();
  for (size_t b = 0; b < scene.bodies.size(); ++b)
    for (int p = placed.bodies[b].first; p < placed.bodies[b].last; ++p) {
      const auto n = static_cast<size_t>(p);
      const double mass = scene.bodies[b].density * placed.volume[n];
      centre.mass += mass;
      for (size_t i = 0; i < 3; ++i) moment[i] += mass * (placed.position[n][i] - near[i]);
    }
  for (size_t i = 0; i < 3; ++i) centre.position[i] = near[i] + moment[i] / centre.mass;
  return centre;
}

void for_each_start(const Scene& scene, const std::function<void(const Point&)>& visit) {
  CutVolume cut;
  for (size_t b = 0; b < scene.bodies.size(); ++b)
    place_body(scene, b, cut, [&](const Point& x, double) { visit(x); });
}

}  // namespace vsb::app
