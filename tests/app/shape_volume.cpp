// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Volumes of regions, and of what a grid leaves of them, against closed forms.
#include "setup/shape_volume.hpp"

#include "app/shapes.hpp"
#include "scene/units.hpp"
#include "setup/body_volumes.hpp"

using namespace vsb::app;
using vsb::test::add_body;
using vsb::test::grid_scene;
using vsb::test::Random;
using vsb::test::WithinAbs;
using vsb::test::WithinRel;

namespace {

constexpr AxisBox around{{-3, -3, -3}, {3, 3, 3}};

/// Of one body in a grid from -3 to 3.
double volume(int dimension, const Region& region) {
  auto scene = grid_scene(dimension, -3, 1, 6);
  add_body(scene, region, 1, BoundaryBoxes::keep);
  return shape_volumes(scene).front().value;
}

}  // namespace

TEST_CASE("boxes have the volumes of boxes, however they are combined") {
  CHECK(volume(1, box(1, {0, 0, 0}, {0.95, 0, 0})) == 0.95);
  CHECK_THAT(volume(1, difference_of({box(1, {-1, 0, 0}, {2, 0, 0}), box(1, {0.1, 0, 0}, {0.7, 0, 0})})),
             WithinRel(2.4, 1e-9));
  CHECK(volume(3, box(3, {-1, 0, 0.25}, {0.5, 0.75, 1})) == 1.5 * 0.75 * 0.75);
  const Region a = box(2, {-1, -1, 0}, {0.5, 0.7, 0}), b = box(2, {0.3, -0.5, 0}, {1.1, 1.3, 0});
  CHECK_THAT(volume(2, union_of({a, b})), WithinRel(1.5 * 1.7 + 0.8 * 1.8 - 0.2 * 1.2, 1e-6));
  CHECK_THAT(volume(2, intersection_of({a, b})), WithinRel(0.2 * 1.2, 1e-9));
  CHECK_THAT(volume(2, difference_of({a, b})), WithinRel(1.5 * 1.7 - 0.2 * 1.2, 1e-6));
}

TEST_CASE("round shapes, holes, wedges and thin walls") {
  CHECK_THAT(volume(2, ball({0.1, -0.2, 0}, 2.1)), WithinRel(pi * 2.1 * 2.1, 1e-6));
  CHECK_THAT(volume(2, difference_of({ellipsoid(2, {}, {2, 1.5, 0}), ellipsoid(2, {}, {0.25, 0.5, 0})})),
             WithinRel(pi * (2 * 1.5 - 0.25 * 0.5), 1e-5));
  // A triangle between (0, 0), (2, 0) and (0, 1).
  CHECK_THAT(volume(2, intersection_of({half_space({}, {-1, 0, 0}), half_space({}, {0, -1, 0}),
                                        half_space({2, 0, 0}, {1, 2, 0})})),
             WithinRel(1.0, 1e-5));
  CHECK_THAT(volume(3, ball({0.1, 0, 0.2}, 2.1)), WithinRel(4 * pi / 3 * std::pow(2.1, 3), 1e-4));
  CHECK_THAT(volume(3, difference_of({cylinder(2, {}, 2.5, -1, 1.5), cylinder(2, {}, 1, -9, 9)})),
             WithinRel(pi * 5.25 * 2.5, 1e-4));
  CHECK_THAT(volume(2, difference_of({ball({}, 1), ball({}, 0.999)})),
             WithinRel(pi * (1 - 0.999 * 0.999), 1e-4));
  // An oblique wall of a thickness of 0.01 through a cube of edge 2, parallel to an axis.
  const Region wall = intersection_of({half_space({}, {-1, -2, 0}), half_space({0.01, 0, 0}, {1, 2, 0})});
  CHECK_THAT(volume(3, intersection_of({wall, box(3, {-1, -1, -1}, {1, 1, 1})})),
             WithinRel(0.01 / 2 * 2 * 2, 4e-3));  // far thinner than the boxes
}

TEST_CASE("thin walls in space, however they lie and however thin: far within the warning's hundredth") {
  const auto all = [](double r) { return 4 * pi / 3 * r * r * r; };
  for (const double t : {0.002}) {
    const Region shell = difference_of({ball({0.2, 0.1, -0.1}, 2), ball({0.2, 0.1, -0.1}, 2 - t)});
    CHECK_THAT(volume(3, shell), WithinRel(all(2) - all(2 - t), 1e-3));
    const double a = 2 - t, b = 1.2 - t, c = 0.7 - t;
    CHECK_THAT(volume(3, difference_of({ellipsoid(3, {}, {2, 1.2, 0.7}), ellipsoid(3, {}, {a, b, c})})),
               WithinRel(4 * pi / 3 * (2 * 1.2 * 0.7 - a * b * c), 1e-3));
    for (const Point& n : {Point{1, 1, 1}, Point{-1, -2, 0}, Point{-0.48, 0.04, 0.74}}) {
      const double k = t / std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
      const Region disc = intersection_of({half_space({}, {-n[0], -n[1], -n[2]}),
                                           half_space({k * n[0], k * n[1], k * n[2]}, n), ball({}, 2)});
      CHECK_THAT(volume(3, disc), WithinRel(pi * (4 * t - t * t * t / 3), 2e-3));
    }
  }
}

TEST_CASE("many shapes: every box looks at those that it meets alone") {
  std::vector<Region> discs;
  for (int k = 0; k < 200; ++k)
    discs.push_back(ball({-2.8 + 0.28 * (k % 20), -2.8 + 0.5 * (k / 20), 0}, 0.1));
  CHECK_THAT(volume(2, union_of(discs)), WithinRel(200 * pi * 0.01, 1e-3));
  // Differences nested a hundred deep: every level takes a disc out.
  Region nested = box(2, {-3, -3, 0}, {3, 3, 0});
  for (const auto& disc : discs) nested = difference_of({nested, disc});
  CHECK_THAT(volume(2, nested), WithinRel(36 - 200 * pi * 0.01, 1e-4));
}

TEST_CASE("what lies beyond the grid does not count") {
  auto scene = grid_scene(2, 0, 0.5, 6);
  add_body(scene, ball({}, 2), 1, BoundaryBoxes::keep);
  CHECK_THAT(shape_volumes(scene).front().value, WithinRel(pi, 1e-6));
  scene.bodies[0].region = half_space({1, 0, 0}, {-1, 0, 0});  // ends where the grid does
  CHECK(shape_volumes(scene).front().value == 2 * 3);

  auto& grid = scene.grid;  // a polar one: with its arcs
  grid.polar = true;
  grid.coordinates[0] = {1, 1.5, 2};
  for (const double last : {pi / 2, 1.5 * pi}) {
    grid.coordinates[1].clear();
    for (int k = 0; k <= 6; ++k) grid.coordinates[1].push_back(last * k / 6);
    grid.cells = {2, 6, 1};
    scene.bodies[0].region = box(2, {-9, -9, 0}, {9, 9, 0});
    CHECK_THAT(shape_volumes(scene).front().value, WithinRel(0.5 * last * 3, 1e-5));
  }
}

TEST_CASE("random combinations agree with counts of random points") {
  Random random(11);
  for (int n = 0; n < 20; ++n) {
    const int d = 2 + n % 2;
    const auto point = [&] {
      return Point{random(-1.5, 1.5), random(-1.5, 1.5), d == 3 ? random(-1.5, 1.5) : 0};
    };
    const Point corner = point();
    const Region disc = ball(point(), random(0.5, 1.5)), half = half_space(point(), {1, random(-1, 1), 0}),
                 block =
                     box(d, corner, {corner[0] + random(0.5, 2), corner[1] + random(0.5, 2), corner[2] + 1});
    const Region region = difference_of({union_of({disc, block}), intersection_of({half, ball(point(), 1)})});
    const int points = 40000;
    int inside = 0;
    for (int p = 0; p < points; ++p) {
      const Point x{random(-3, 3), random(-3, 3), d == 3 ? random(-3, 3) : 0};
      if (region(x)) ++inside;
    }
    const double all = std::pow(6, d), share = static_cast<double>(inside) / points;
    CHECK_THAT(volume(d, region), WithinAbs(all * share, all * 5 * std::sqrt(share / points)));
  }
}

TEST_CASE("the bar of 0.95 m on a lattice of 0.4 m has 0.8 m of particles, and that is told") {
  auto scene = grid_scene(1, 0, 0.5, 8);
  scene.faces.fixed[0][0] = 1;
  auto& body = add_body(scene, box(1, {0, 0, 0}, {0.95, 0, 0}), 1, BoundaryBoxes::keep);
  body.lattice = UniformLattice{{0, 0, 0}, {0.4, 0, 0}};
  auto volumes = body_volumes(scene, place_particles(scene));
  CHECK_THAT(volumes[0].particles, WithinRel(0.8, 1e-14));
  CHECK(volumes[0].shape == 0.95);
  const auto advice = volume_advice(scene, volumes);
  REQUIRE(advice.size() == 1);
  for (const char* word : {"'body 1'", "0.8 m and 800 kg/m^2", "0.95 m and 950 kg/m^2", "-15.79 %"})
    CHECK(advice[0].find(word) != std::string::npos);
  body.boundary = BoundaryBoxes::cut;
  volumes = body_volumes(scene, place_particles(scene));
  CHECK_THAT(volumes[0].particles, WithinRel(0.95, 1e-10));
  CHECK(volume_advice(scene, volumes).empty());
  // The limit itself: a hundredth.
  CHECK(volume_advice(scene, {{1.0099, 1}}).empty());
  CHECK(volume_advice(scene, {{1.0101, 1}}).size() == 1);
  CHECK(volume_advice(scene, {{0.9899, 1}}).size() == 1);
  CHECK(volume_advice(scene, {{0.9899, 1, 0.001}}).empty());  // the shape's own error
}
