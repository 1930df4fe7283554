// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// How far failure reaches, on lattices small enough to count by hand.
#include "report/failed_zone.hpp"

#include <cmath>

#include "catch.hpp"

using namespace vsb::app;

namespace {

/// Particles at (k + 1/2) row, of which some have failed.
struct Lattice {
  HoleSpec hole{{0, 0, 0}, -1, 2, 0.5};
  std::vector<Point> start;
  std::vector<Fate> fate;

  template <class FateAt>
  void add(int first, int last, double z, const FateAt& fate_at) {
    for (int j = first; j < last; ++j)
      for (int i = first; i < last; ++i) {
        const Point x{(i + 0.5) * hole.row, (j + 0.5) * hole.row, z};
        if (std::hypot(x[0], x[1]) < hole.radius || std::hypot(x[0], x[1]) > 5) continue;
        start.push_back(x);
        fate.push_back(fate_at(i, j, std::hypot(x[0], x[1])));
      }
  }
};

}  // namespace

TEST_CASE("the depth of a plus-shaped zone differs on the axis and on the diagonal") {
  Lattice l;
  // In the first rows beside the axes up to place 7 (3.75 from the centre), on the diagonal up to 3 (2.47).
  l.add(0, 10, 0, [](int i, int j, double) {
    const bool beside_axis = std::min(i, j) == 0 && std::max(i, j) <= 7, diagonal = i == j && i <= 3;
    return beside_axis || diagonal ? Fate::failed : Fate::present;
  });
  const auto zone = measure_failed_zone(l.hole, 2, l.start, l.fate);
  CHECK(zone.rows_axis == Approx((std::hypot(3.75, 0.25) - 2) / 0.5));
  CHECK(zone.rows_diagonal == Approx((1.75 * std::sqrt(2.0) - 2) / 0.5));
  CHECK(zone.rows == zone.rows_axis);
  CHECK(zone.asymmetry == 0);
  CHECK(zone.per_layer ==
        2 * 4 + 1);  // positions 4 to 7 beside each axis lie outside of the hole, and (3, 3)
  CHECK(zone.layer_spread == 0);
}

TEST_CASE("the mean depth is that of a round zone, of what is gone too") {
  Lattice l;
  l.add(-10, 10, 0, [](int, int, double r) {
    return r < 3 ? Fate::gone : r < 4 ? Fate::failed : Fate::present;
  });
  const auto zone = measure_failed_zone(l.hole, 2, l.start, l.fate);
  double farthest = 0;
  for (const auto& x : l.start)
    if (const double r = std::hypot(x[0], x[1]); r < 4) farthest = std::max(farthest, r);
  CHECK(zone.rows_mean == Approx((farthest - 2) / 0.5));
  CHECK(zone.rows_mean == Approx(zone.rows));
  CHECK(zone.asymmetry == 0);
}

TEST_CASE("a particle that fails without its mirror image shows, and so does one that only one layer loses") {
  Lattice l;
  l.hole.axis = 2;
  const auto ring = [](int, int, double r) { return r < 3 ? Fate::failed : Fate::present; };
  l.add(-10, 10, 0.25, ring);
  l.add(-10, 10, 0.75, ring);
  const auto even = measure_failed_zone(l.hole, 3, l.start, l.fate);
  CHECK(even.layer_spread == 0);
  CHECK(even.asymmetry == 0);
  for (size_t p = 0; p < l.start.size(); ++p)
    if (l.start[p] == Point{3.25, 0.25, 0.75}) l.fate[p] = Fate::failed;
  const auto uneven = measure_failed_zone(l.hole, 3, l.start, l.fate);
  const double failed = 2 * even.per_layer + 1;
  CHECK(uneven.per_layer == failed / 2);
  CHECK(uneven.layer_spread == Approx(2 / failed));
  CHECK(uneven.asymmetry == Approx(1 / failed));
  // An image that is gone is none.
  for (size_t p = 0; p < l.start.size(); ++p)
    if (l.start[p][2] == 0.75 &&
        std::abs(std::hypot(l.start[p][0], l.start[p][1]) - std::hypot(3.25, 0.25)) < 1e-9 &&
        l.fate[p] == Fate::present)
      l.fate[p] = Fate::gone;
  CHECK(measure_failed_zone(l.hole, 3, l.start, l.fate).asymmetry == 0);
}
