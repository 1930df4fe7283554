// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Volumes, centroids and counts of the particles of cut lattices, against closed forms and counts by hand.
#include <algorithm>
#include <set>

#include "app/shapes.hpp"
#include "engine/simulation.hpp"
#include "setup/box_share.hpp"
#include "setup/place_particles.hpp"

using namespace vsb::app;
using vsb::test::add_body;
using vsb::test::containing;
using vsb::test::grid_scene;
using vsb::test::WithinRel;

namespace {

constexpr AxisBox unit_box{{0, 0, 0}, {1, 1, 1}};

struct Sums {
  double volume = 0;
  Point first{};
};
Sums sums_of(const PlacedParticles& placed) {
  Sums sums;
  for (size_t p = 0; p < placed.volume.size(); ++p) {
    sums.volume += placed.volume[p];
    for (size_t i = 0; i < 3; ++i) sums.first[i] += placed.volume[p] * placed.position[p][i];
  }
  return sums;
}

PlacedParticles place_one(int dimension, const Region& region, double h, int n, BoundaryBoxes boundary) {
  auto scene = grid_scene(dimension, -3, h, static_cast<int>(std::lround(6 / h)));
  add_body(scene, region, n, boundary);
  return place_particles(scene);
}

}  // namespace

TEST_CASE("a box cut at 0.3 by a plane perpendicular to an axis, by hand") {
  for (const int d : {1, 2, 3})
    for (size_t axis = 0; axis < static_cast<size_t>(d); ++axis)
      for (const bool below : {true, false}) {
        Point on{}, normal{};
        on[axis] = 0.3;
        normal[axis] = below ? 1 : -1;
        const auto share = share_of(half_space(on, normal), unit_box, d);
        CHECK_THAT(share.volume, WithinRel(below ? 0.3 : 0.7, 1e-11));
        for (size_t i = 0; i < static_cast<size_t>(d); ++i)
          CHECK_THAT(share.centroid[i], WithinRel(i == axis ? (below ? 0.15 : 0.65) : 0.5, 1e-11));
        CHECK(!share.whole);
      }
}

TEST_CASE("a square cut along its diagonal, by hand") {
  const auto share = share_of(half_space({1, 0, 0}, {1, 1, 0}), unit_box, 2);
  const double h = 1.0 / samples_per_direction(2);
  CHECK_THAT(share.volume, WithinRel(0.5, 1e-11));
  // Midpoint rule for (1 - y)^2 / 2 along the lines and for y (1 - y) across: 1/6 - h^2/24, 1/6 + h^2/12.
  CHECK_THAT(share.centroid[0], WithinRel(1.0 / 3 - h * h / 12, 1e-10));
  CHECK_THAT(share.centroid[1], WithinRel(1.0 / 3 + h * h / 6, 1e-10));
}

TEST_CASE("a thin slab in a box is met at both faces, and a box without volume is none") {
  const auto slab = share_of(box(3, {-1, -1, 0.43}, {2, 2, 0.61}), unit_box, 3);
  CHECK_THAT(slab.volume, WithinRel(0.18, 1e-10));
  CHECK_THAT(slab.centroid[2], WithinRel(0.52, 1e-10));
  CHECK(share_of(ball({5, 5, 5}, 1), unit_box, 3).volume == 0);
  const auto whole = share_of(union_of({ball({0, 0.5, 0}, 0.9), ball({1, 0.5, 0}, 0.9)}), unit_box, 2);
  CHECK(whole.whole);  // found by the samples: neither disc has the square alone
  CHECK(whole.volume == 1);
}

TEST_CASE("volumes and first moments of bodies, and the rate at which their errors fall") {
  struct Case {
    int dimension;
    Region region;
    double volume;
    Point centroid;
    double error[2];  // allowed, of the volume, relative, at h = 0.5 and 0.125
  };
  const double two_ellipses = pi * (2 * 1.5 - 0.25 * 0.5);
  const std::vector<Case> cases = {
      {1, ball({0.1, 0, 0}, 1.234), 2.468, {0.1, 0, 0}, {1e-10, 1e-10}},
      {1, difference_of({ball({}, 2.03), ball({}, 0.61)}), 2.84, {}, {1e-10, 1e-10}},
      {2, ball({0.1, -0.2, 0}, 2.1), pi * 2.1 * 2.1, {0.1, -0.2, 0}, {1e-4, 6e-6}},
      {2, difference_of({ball({}, 2.5), ball({}, 1)}), pi * 5.25, {}, {1e-4, 6e-6}},
      {2,
       difference_of({ellipsoid(2, {}, {2, 1.5, 0}), ellipsoid(2, {}, {0.25, 0.5, 0})}),
       two_ellipses,
       {},
       {1e-4, 6e-6}},
      {2, box(2, {-1.03, 0.17, 0}, {2.2, 1.9, 0}), 3.23 * 1.73, {0.585, 1.035, 0}, {1e-3, 1e-3}},
      {3, ball({0.1, 0, 0.2}, 2.1), 4 * pi / 3 * std::pow(2.1, 3), {0.1, 0, 0.2}, {4e-4, 3e-5}},
      {3,
       ellipsoid(3, {0.1, 0, 0.2}, {2.1, 1.7, 2.5}),
       4 * pi / 3 * 2.1 * 1.7 * 2.5,
       {0.1, 0, 0.2},
       {4e-4, 3e-5}},
      {3,
       difference_of({cylinder(2, {}, 2.5, -1, 1.5), cylinder(2, {}, 1, -9, 9)}),
       pi * 5.25 * 2.5,
       {0, 0, 0.25},
       {4e-4, 3e-5}},
  };
  for (const auto& c : cases)
    for (const int level : {0, 1}) {
      const double h = level == 0 ? 0.5 : 0.125;
      if (c.dimension == 3 && level == 1) continue;
      for (const auto boundary : {BoundaryBoxes::cut, BoundaryBoxes::cut2x2}) {
        const auto placed = place_one(c.dimension, c.region, h, 2, boundary);
        const auto sums = sums_of(placed);
        CHECK_THAT(placed.cut.particles, WithinRel(sums.volume, 1e-12));
        const double all = placed.cut.particles + placed.cut.dropped;
        INFO(c.dimension << "D, volume " << c.volume << ", h " << h << ", error " << all / c.volume - 1
                         << ", dropped " << placed.cut.dropped / c.volume);
        CHECK(std::abs(all / c.volume - 1) < c.error[level]);
        CHECK(placed.cut.dropped < 2e-3 * c.volume);
        for (size_t i = 0; i < 3; ++i)
          CHECK(std::abs(sums.first[i] / sums.volume - c.centroid[i]) < 20 * c.error[level] + 1e-3 * h);
      }
    }
}

TEST_CASE("boxes wholly in the body are the particles that they are without cutting") {
  const Region disc = ball({0.05, 0.1, 0}, 2.0);
  const auto kept = place_one(2, disc, 0.5, 4, BoundaryBoxes::keep);
  for (const auto boundary : {BoundaryBoxes::cut, BoundaryBoxes::cut2x2}) {
    const auto cut = place_one(2, disc, 0.5, 4, boundary);
    const std::set<Point> positions(cut.position.begin(), cut.position.end());
    size_t whole = 0;
    for (const Point& x : kept.position) {
      // A disc is convex. With cut2x2 the neighbours' halves that touch the box must be whole too.
      const double half = boundary == BoundaryBoxes::cut ? 0.0625 : 0.125;
      bool all_corners = true;
      for (const double dx : {-half, half})
        for (const double dy : {-half, half}) all_corners = all_corners && disc({x[0] + dx, x[1] + dy, 0});
      if (!all_corners) continue;
      ++whole;
      CHECK(positions.count(x) == 1);
    }
    CHECK(whole > (boundary == BoundaryBoxes::cut ? 700u : 600u));
    CHECK(static_cast<size_t>(std::count(cut.volume.begin(), cut.volume.end(), kept.volume[0])) >= whole);
    const auto again = place_one(2, disc, 0.5, 4, boundary);
    CHECK(again.position == cut.position);
    CHECK(again.volume == cut.volume);
    // Boxes along x first: a row of boxes is complete before the next begins.
    for (size_t p = 1; p < cut.position.size(); ++p) {
      const auto row = [&](size_t q) { return std::floor(cut.position[q][1] / 0.125); };
      CHECK(row(p) >= row(p - 1));
    }
  }
}

TEST_CASE("counts of halves, quarters and octants, by hand") {
  // Boxes of 0.25: four whole ones, and [1, 1.25] cut at 1.15; of its halves one is whole, one is cut.
  const Point corner{1.15, 1.15, 1.15};
  const int kept[] = {5, 25, 125}, cut[] = {5, 25, 125};
  // 5^d boxes less the 4^d whole ones become 2^d halves each, of which the octant in the corner is
  // too small, 0.2^3 of it.
  const int cut2x2[] = {4 + 2, 16 + 9 * 4, 64 + 61 * 8 - 1};
  for (const int d : {1, 2, 3}) {
    const Region cube = box(d, {0, 0, 0}, corner);
    const auto count = [&](BoundaryBoxes boundary) {
      return static_cast<int>(place_one(d, cube, 0.5, 2, boundary).position.size());
    };
    CHECK(count(BoundaryBoxes::keep) == kept[d - 1]);
    CHECK(count(BoundaryBoxes::cut) == cut[d - 1]);
    CHECK(count(BoundaryBoxes::cut2x2) == cut2x2[d - 1]);
  }
  const auto halves = place_one(1, box(1, {0, 0, 0}, corner), 0.5, 2, BoundaryBoxes::cut2x2);
  CHECK_THAT(halves.position[4][0], WithinRel(1.0625, 1e-14));
  CHECK_THAT(halves.volume[4], WithinRel(0.125, 1e-14));
  CHECK_THAT(halves.position[5][0], WithinRel(1.1375, 1e-11));
  CHECK_THAT(halves.volume[5], WithinRel(0.025, 1e-9));
}

TEST_CASE("slivers: more than 2 % of the box, or of the half, is a particle; less is dropped and counted") {
  const auto place = [](double end, BoundaryBoxes boundary) {
    return place_one(1, box(1, {0, 0, 0}, {end, 0, 0}), 0.5, 2, boundary);
  };
  const auto below = place(1.0049, BoundaryBoxes::cut);  // 1.96 % of 0.25
  CHECK(below.position.size() == 4);
  CHECK_THAT(below.cut.dropped, WithinRel(0.0049, 1e-8));
  CHECK_THAT(below.cut.particles, WithinRel(1.0, 1e-14));
  const auto above = place(1.0051, BoundaryBoxes::cut);
  CHECK(above.position.size() == 5);
  CHECK(above.cut.dropped == 0);
  CHECK_THAT(above.position[4][0], WithinRel(1.00255, 1e-10));
  // The box [0.75, 1] touches the half [1, 1.125], which is cut, and is split too.
  CHECK(place(1.0049, BoundaryBoxes::cut2x2).position.size() == 6);  // 3.9 % of 0.125
  CHECK(place(1.0024, BoundaryBoxes::cut2x2).position.size() == 5);  // 1.92 %
  CHECK(place(1.0000, BoundaryBoxes::cut2x2).position.size() == 4);  // nothing is cut
}

TEST_CASE("a plane of symmetry cuts the boxes that it crosses") {
  auto scene = grid_scene(2, 0, 0.5, 6);
  auto& body = add_body(scene, ball({}, 2), 1, BoundaryBoxes::cut);
  for (auto& faces : scene.faces.fixed) faces[0] = 7;
  body.lattice = UniformLattice{{-0.1, -0.1, 0}, {0.25, 0.25, 0.25}};
  const auto placed = place_particles(scene);
  const auto sums = sums_of(placed);
  CHECK_THAT(sums.volume, WithinRel(pi, 1e-3));
  CHECK_THAT(sums.first[0] / sums.volume, WithinRel(8 / (3 * pi), 1e-3));
  CHECK_THAT(placed.position[0][0], WithinRel(0.075, 1e-12));  // [-0.1, 0.15] from 0 on
  CHECK_THAT(placed.volume[0], WithinRel(0.0225, 1e-12));
}

TEST_CASE("a cut body that reaches out of an open face is refused, by however little") {
  auto scene = grid_scene(1, 0, 0.5, 6);
  add_body(scene, box(1, {1, 0, 0}, {3.02, 0, 0}), 2, BoundaryBoxes::cut);
  CHECK_THROWS_WITH(place_particles(scene), containing("open face x_max"));
  scene.faces.fixed[0][1] = 1;
  CHECK(place_particles(scene).position.size() == 8);
  scene.faces.fixed[0][1] = 0;
  scene.bodies[0].region = half_space({1, 0, 0}, {-1, 0, 0});  // ends where the grid does
  CHECK(place_particles(scene).position.size() == 8);
}

TEST_CASE("bodies that touch share boxes; bodies that overlap are refused") {
  auto scene = grid_scene(2, -3, 0.5, 12);
  // The small disc lies in one box, so the centroid of what surrounds it there lies in the disc.
  const Region disc = ball({0.13, 0.13, 0}, 0.1);
  add_body(scene, disc, 2, BoundaryBoxes::cut);
  add_body(scene, difference_of({ball({}, 1.5), disc}), 2, BoundaryBoxes::cut);
  const auto placed = place_particles(scene);
  CHECK_THAT(sums_of(placed).volume + placed.cut.dropped, WithinRel(pi * 2.25, 2e-4));
  CHECK(placed.bodies[0].last - placed.bodies[0].first == 1);
  scene.bodies[1].region = ball({}, 1.5);
  CHECK_THROWS_WITH(place_particles(scene), containing("body 'body 2' overlaps body 'body 1'"));
}
