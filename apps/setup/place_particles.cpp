// SPDX-License-Identifier: BSD-3-Clause
#include "setup/place_particles.hpp"

#include <fmt/format.h>

#include <limits>

#include "setup/box_share.hpp"
#include "setup/cut_bodies.hpp"
#include "setup/cut_lattice.hpp"
#include "setup/face_cover.hpp"
#include "setup/initial_stress.hpp"
#include "setup/lattice_points.hpp"
#include "setup/moment_fit.hpp"
#include "setup/needed_memory.hpp"
#include "setup/setup_error.hpp"

namespace vsb::app {

namespace {

bool in_grid(const Scene& scene, const Point& x) {
  return contains(scene.grid, scene.dimension, x);
}

[[noreturn]] void throw_overlap(const BodySpec& body, const BodySpec& other, const Point& x) {
  throw SetupError(
      body.where,
      fmt::format("body '{}' overlaps body '{}' at ({}, {}, {}): cut one out of the other with a difference",
                  body.name, other.name, x[0], x[1], x[2]));
}

/// The bodies before this one that may have points in common with it.
std::vector<size_t> neighbours(const Scene& scene, size_t b) {
  std::vector<size_t> near;
  for (size_t other = 0; other < b; ++other) {
    const AxisBox common = common_box(scene.bodies[b].region.bounds(), scene.bodies[other].region.bounds());
    bool meet = true;
    for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i)
      meet = meet && common.lower[i] <= common.upper[i];
    if (meet) near.push_back(other);
  }
  return near;
}

/// Calls work(x, point) for the points of a body's lattice where it has a particle.
template <class Work>
void for_each_kept_point(const Scene& scene, const BodySpec& body, const Work& work) {
  for_each_lattice_point(scene, body, [&](const LatticePoint& point) {
    if (in_grid(scene, point.x) && body.region(point.x)) work(point);
  });
}

Point shifted(const LatticePoint& point) {
  Point x = point.x;
  for (size_t i = 0; i < 3; ++i) x[i] += point.shift[i];
  return x;
}

/// Calls place(position, volume, the middle of the lattice's box, its edges).
template <class Place>
void place_lattice_points(const Scene& scene, size_t b, const Place& place) {
  const auto& body = scene.bodies[b];
  const auto near = neighbours(scene, b);
  for_each_kept_point(scene, body, [&](const LatticePoint& point) {
    for (const size_t other : near)
      if (scene.bodies[other].region(point.x)) throw_overlap(body, scene.bodies[other], point.x);
    const Point x = shifted(point);
    if (!in_grid(scene, x))
      throw SetupError(body.where,
                       fmt::format("body '{}': its jitter moves a particle out of the grid, to ({}, {}, {}): "
                                   "make the grid larger, "
                                   "or let a face of the grid lie between two points of the lattice",
                                   body.name, x[0], x[1], x[2]));
    place(x, point.volume, point.x, point.edges);
  });
}

/// Bodies that touch share boxes, and the centroid of one's share may lie in the other: they overlap where
/// they have volume in common.
template <class Place>
void place_lattice_shares(const Scene& scene, size_t b, PlacedParticles& placed, const Place& place) {
  const auto& body = scene.bodies[b];
  const auto limits = bounding_box(scene.grid, scene.dimension);
  const auto near = neighbours(scene, b);
  std::vector<Region> both;
  for (const size_t other : near) both.push_back(intersection_of({body.region, scene.bodies[other].region}));
  auto& starts = placed.starts[b] = CutStarts(uniform_lattice(scene.grid, body.lattice));
  const auto volume = for_each_lattice_share(scene, body, limits, [&](const LatticeShare& share) {
    for (size_t n = 0; n < near.size(); ++n) {
      if (both[n].overlap(share.box) == Overlap::none) continue;
      const auto common = share_of(both[n], share.box, scene.dimension);
      if (common.volume > least_share * volume_of(share.box, scene.dimension))
        throw_overlap(body, scene.bodies[near[n]], common.centroid);
    }
    if (share.whole)
      starts.add_whole(share.index);
    else
      starts.add_share(share.position);
    Point middle{}, edges{};
    for (size_t i = 0; i < 3; ++i) {
      middle[i] = 0.5 * (share.box.lower[i] + share.box.upper[i]);
      edges[i] = share.box.upper[i] - share.box.lower[i];
    }
    place(share.position, share.volume, middle, edges);
  });
  placed.cut.particles += volume.particles;
  placed.cut.dropped += volume.dropped;
}

}  // namespace

void CutStarts::add_whole(const LatticeIndex& box) {
  if (!runs_.empty() && runs_.back().shares == 0) {
    auto next = runs_.back().first;
    next[0] += runs_.back().whole;
    if (next == box) {
      ++runs_.back().whole;
      return;
    }
  }
  runs_.push_back({box, 1, 0});
}

void CutStarts::add_share(const Point& x) {
  if (runs_.empty()) runs_.push_back({{}, 0, 0});
  ++runs_.back().shares;
  shares_.push_back(x);
}

void CutStarts::for_each(int dimension, const std::function<void(const Point&)>& visit) const {
  auto share = shares_.begin();
  for (const auto& run : runs_) {
    for (LatticeIndex at = run.first; at[0] < run.first[0] + run.whole; ++at[0]) {
      Point x{};
      for (size_t i = 0; i < static_cast<size_t>(dimension); ++i) x[i] = lattice_.point(at, i);
      visit(x);
    }
    for (long long n = 0; n < run.shares; ++n) visit(*share++);
  }
}

PlacedParticles place_particles(const Scene& scene) {
  refuse_what_does_not_fit(scene);
  refuse_cut_bodies(scene);
  PlacedParticles placed;
  placed.starts.resize(scene.bodies.size());
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    const auto& body = scene.bodies[b];
    const auto first = placed.position.size();
    const auto place = [&](const Point& x, double volume, const Point& middle, const Point& edges) {
      add_covers(scene, body, {x, volume, middle, edges}, static_cast<int>(placed.position.size()),
                 placed.covers);
      placed.position.push_back(x);
      placed.volume.push_back(volume);
    };
    if (body.boundary == BoundaryBoxes::keep)
      place_lattice_points(scene, b, place);
    else
      place_lattice_shares(scene, b, placed, place);
    if (placed.position.size() == first)
      throw SetupError(
          body.where,
          fmt::format("body '{}' has no particle: its shape contains no lattice point of the grid",
                      body.name));
    if (placed.position.size() > static_cast<size_t>(std::numeric_limits<int>::max()))
      throw SetupError("more than 2^31 particles");
    placed.bodies.push_back({static_cast<int>(first), static_cast<int>(placed.position.size())});
  }
  refuse_stress_beyond_yield(scene, placed);
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

const BodySpec& body_of(const Scene& scene, const PlacedParticles& placed, size_t particle) {
  size_t b = 0;
  while (particle >= static_cast<size_t>(placed.bodies[b].last)) ++b;
  return scene.bodies[b];
}

void for_each_start(const Scene& scene, const std::vector<CutStarts>& starts,
                    const std::function<void(const Point&)>& visit) {
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    const auto& body = scene.bodies[b];
    if (body.boundary == BoundaryBoxes::keep)
      for_each_kept_point(scene, body, [&](const LatticePoint& point) { visit(shifted(point)); });
    else
      starts[b].for_each(scene.dimension, visit);
  }
}

}  // namespace vsb::app
