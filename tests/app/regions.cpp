// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Whether a box lies in a region: the answers none and all must be certain.
#include "scene/region.hpp"

#include <cmath>
#include <string>

#include "app/shapes.hpp"
#include "scene/inclined_cylinder.hpp"

using namespace vsb::app;
using vsb::test::Random;

namespace {

Point random_in(const AxisBox& box, Random& random) {
  Point x{};
  for (size_t i = 0; i < 3; ++i)
    if (box.upper[i] > box.lower[i]) x[i] = random(box.lower[i], box.upper[i]);
  return x;
}

/// No point of the region lies beyond its bounds, and within a box its parts there say what all of them say.
void check_parts(const Region& region, int dimension) {
  Random random(9);
  const AxisBox bounds = region.bounds();
  for (int n = 0; n < 400; ++n) {
    AxisBox box;
    for (size_t i = 0; i < static_cast<size_t>(dimension); ++i) {
      box.lower[i] = random(-2, 2);
      box.upper[i] = box.lower[i] + random(0.02, 1);
    }
    const Region within = region.within(box);
    bool agree = true, bounded = true;
    for (int k = 0; k < 20; ++k) {
      const Point x = random_in(box, random);
      agree = agree && region(x) == within(x);
      for (size_t i = 0; i < 3 && region(x); ++i)
        bounded = bounded && x[i] >= bounds.lower[i] && x[i] <= bounds.upper[i];
    }
    CHECK(agree);
    CHECK(bounded);
    const Overlap overlap = region.overlap(box);
    CHECK(within.is_empty() == (overlap == Overlap::none));
    CHECK(within.is_everywhere() == (overlap == Overlap::all));
  }
}

/// Corners and random points of a box against the region's answer for the box.
void check_answers(const Region& region, int dimension) {
  check_parts(region, dimension);
  Random random(7);
  int answers[3] = {0, 0, 0};
  for (int n = 0; n < 4000; ++n) {
    AxisBox box;
    const double size = std::pow(10, random(-2, 0));
    for (size_t i = 0; i < static_cast<size_t>(dimension); ++i) {
      box.lower[i] = random(-2, 2);
      box.upper[i] = box.lower[i] + size * random(0.5, 1.5);
    }
    const Overlap overlap = region.overlap(box);
    ++answers[static_cast<int>(overlap)];
    if (overlap == Overlap::some) continue;
    bool agree = true;
    for (int k = 0; k < 30; ++k) agree = agree && region(random_in(box, random)) == (overlap == Overlap::all);
    CHECK(agree);
  }
  for (const int count : answers) CHECK(count > 40);  // every answer was put to the test
}

}  // namespace

TEST_CASE("none and all are certain for every shape and combination") {
  for (const int d : {1, 2, 3}) {
    check_answers(box(d, {-1, -0.7, -0.8}, {0.5, 0.9, 1}), d);
    check_answers(ball(d == 1   ? Point{0.2, 0, 0}
                       : d == 2 ? Point{0.2, 0.1, 0}
                                : Point{0.2, 0.1, -0.3},
                       1.1),
                  d);
    check_answers(ellipsoid(d, {0.1, -0.2, 0.3}, {1.5, 0.8, 1.1}), d);
    check_answers(half_space({0.2, 0, 0}, {1, d > 1 ? -2.0 : 0.0, d > 2 ? 0.5 : 0.0}), d);
    const Region a = box(d, {-1.5, -1, -1}, {0.3, 1, 1}), b = box(d, {0.1, -1.2, -1.3}, {1.4, 0.6, 1});
    check_answers(union_of({a, b}), d);
    check_answers(difference_of({box(d, {-1.7, -1.7, -1.7}, {1.7, 1.7, 1.7}), ball({}, 0.9)}), d);
    check_answers(intersection_of({ball({}, 1.6), half_space({0.5, 0, 0}, {1, 0, 0})}), d);
  }
  for (const int axis : {0, 1, 2}) check_answers(cylinder(axis, {0.1, 0.2, -0.1}, 1.3, -1.1, 1.2), 3);
  check_answers(inclined_cylinder({1, -2, 0.5}, {0.1, 0.2, -0.1}, 1.3, -1.1, 1.2), 3);
}

TEST_CASE("an inclined cylinder along an axis is the one of that axis") {
  Random random(11);
  const AxisBox everything{{-2, -2, -2}, {2, 2, 2}};
  for (const int axis : {0, 1, 2}) {
    Point along{};
    along[static_cast<size_t>(axis)] = 3.0;  // its length does not matter
    const Point center{0.1, 0.2, -0.1};
    const Region straight = cylinder(axis, center, 1.3, -0.9, 1.2);
    const Region inclined = inclined_cylinder(along, center, 1.3, -0.9, 1.2);
    for (int n = 0; n < 500; ++n) {
      const Point x = random_in(everything, random);
      CHECK(inclined(x) == straight(x));
    }
  }
  // 45 degrees: the axis through the origin along (1, 0, 1), from -1 to 2 along it.
  const Region borehole = inclined_cylinder({1, 0, 1}, {}, 0.5, -1, 2);
  CHECK(borehole({1.4, 0, 1.4}));   // 1.98 along
  CHECK(!borehole({1.5, 0, 1.5}));  // 2.12 along
  CHECK(!borehole({-0.8, 0, -0.8}));
  CHECK(borehole({0.3, 0.25, -0.3}));   // sqrt(0.09 * 2 + 0.0625) = 0.49 from the axis
  CHECK(!borehole({0.3, 0.30, -0.3}));  // 0.52
}

TEST_CASE("a feature of any thickness makes a box that it crosses a box in between") {
  const double thin = 1e-7;
  const Region slit =
      difference_of({box(2, {-1, -1, 0}, {1, 1, 0}), box(2, {-2, 0.31, 0}, {2, 0.31 + thin, 0})});
  CHECK(slit.overlap({{-0.5, 0, 0}, {0.5, 0.5, 0}}) == Overlap::some);
  CHECK(slit.overlap({{-0.5, 0, 0}, {0.5, 0.31, 0}}) == Overlap::all);
  const Region shell = difference_of({ball({}, 1), ball({}, 1 - thin)});
  CHECK(shell.overlap({{0.9, -0.1, -0.1}, {1.1, 0.1, 0.1}}) == Overlap::some);
  CHECK(shell.overlap({{0.1, 0.1, 0.1}, {0.4, 0.4, 0.4}}) == Overlap::none);
}

TEST_CASE("faces in common count for nothing") {
  const Region unit = box(3, {0, 0, 0}, {1, 1, 1});
  CHECK(unit.overlap({{0, 0, 0}, {1, 1, 1}}) == Overlap::all);
  CHECK(unit.overlap({{1, 0, 0}, {2, 1, 1}}) == Overlap::none);
  CHECK(unit.overlap({{0.5, 0, 0}, {2, 1, 1}}) == Overlap::some);
  CHECK(half_space({1, 0, 0}, {1, 0, 0}).overlap({{1, 0, 0}, {2, 1, 1}}) == Overlap::none);
  CHECK(difference_of({everywhere(), unit}).overlap({{0.2, 0, 0}, {1, 1, 1}}) == Overlap::none);
  CHECK(difference_of({everywhere(), unit}).overlap({{1, 0, 0}, {2, 1, 1}}) == Overlap::all);
}

TEST_CASE("bounds are as tight as the shapes tell") {
  const auto same = [](const AxisBox& a, const AxisBox& b) {
    return a.lower == b.lower && a.upper == b.upper;
  };
  const Region unit = box(3, {0, 0, 0}, {1, 1, 1}), disc = ball({2, 0, 0}, 0.5);
  CHECK(same(disc.bounds(), {{1.5, -0.5, -0.5}, {2.5, 0.5, 0.5}}));
  CHECK(same(cylinder(1, {1, 2, 3}, 0.5, -4, 4).bounds(), {{0.5, -4, 2.5}, {1.5, 4, 3.5}}));
  CHECK(same(ellipsoid(3, {1, 0, 0}, {1, 2, 3}).bounds(), {{0, -2, -3}, {2, 2, 3}}));
  CHECK(same(union_of({unit, disc}).bounds(), {{0, -0.5, -0.5}, {2.5, 1, 1}}));
  CHECK(same(difference_of({unit, disc}).bounds(), unit.bounds()));
  CHECK(same(intersection_of({unit, half_space({0.5, 9, 9}, {2, 0, 0})}).bounds(), {{0, 0, 0}, {0.5, 1, 1}}));
  CHECK(half_space({0, 0, 0}, {1, 1, 0}).bounds().upper[0] == no_end);
  CHECK(everywhere().bounds().lower[2] == -no_end);
}

TEST_CASE("shapes that are nested deep share their parts") {
  // A copy per level and question would be 2^60 of them.
  Region nested = ball({}, 1);
  for (int k = 0; k < 60; ++k) nested = difference_of({nested, ball({0.02 * k, 0.5, 0}, 0.01)});
  const Region copy = nested;
  CHECK(copy({0, 0, 0}));
  CHECK(!copy({0.02 * 59, 0.5, 0}));
  CHECK(!copy({0.1, 0.5, 0}));
  CHECK(copy.overlap({{-0.1, -0.1, 0}, {0.1, 0.1, 0}}) == Overlap::all);
  CHECK(!Region()({0, 0, 0}));
  CHECK(Region().overlap({{0, 0, 0}, {1, 1, 1}}) == Overlap::none);
}
