// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Bounds and least volume of a region against those of shapes of which both are known.
#include "setup/region_size.hpp"

#include <algorithm>
#include <cmath>

#include "support.hpp"

using namespace vsb::app;

namespace {

/// A body somewhere in a box that is as much larger as `width` says.
void check_size(const Region& region, int dimension, const AxisBox& exact, double volume, double width) {
  AxisBox box;
  for (size_t i = 0; i < static_cast<size_t>(dimension); ++i) {
    box.lower[i] = -0.37 * width;
    box.upper[i] = 0.63 * width;
  }
  const auto bounds = bounds_of(region, box, dimension);
  for (size_t i = 0; i < static_cast<size_t>(dimension); ++i) {
    const double edge = exact.upper[i] - exact.lower[i];
    CHECK(std::abs(bounds.lower[i] - exact.lower[i]) < 1e-12 * edge);
    CHECK(std::abs(bounds.upper[i] - exact.upper[i]) < 1e-12 * edge);
  }
  const double least = least_volume(region, box, dimension);
  CHECK(least <= volume * (1 + 1e-12));
  CHECK(least >= 0.6 * volume);
}

}  // namespace

TEST_CASE("a region is found wherever it lies, however small") {
  const double pi = std::acos(-1.0);
  for (const double width : {4.0, 1e3, 1e9}) {
    check_size(box(1, {0.2, 0, 0}, {1.1, 0, 0}), 1, {{0.2, 0, 0}, {1.1, 0, 0}}, 0.9, width);
    check_size(ball({0.5, -0.3, 0}, 0.7), 2, {{-0.2, -1.0, 0}, {1.2, 0.4, 0}}, pi * 0.49, width);
    check_size(ball({0.1, -0.3, 0.6}, 0.7), 3, {{-0.6, -1.0, -0.1}, {0.8, 0.4, 1.3}}, pi * 0.343 * 4 / 3,
               width);
  }
}

TEST_CASE("what is empty, or everything, has the box itself") {
  const AxisBox box{{-1, -1, 0}, {1, 2, 0}};
  CHECK(bounds_of(everywhere(), box, 2).upper == box.upper);
  CHECK(std::abs(least_volume(everywhere(), box, 2) - 6) < 1e-12);
  const Region far = ball({9, 9, 0}, 1);
  CHECK(bounds_of(far, box, 2).lower == box.lower);
  CHECK(least_volume(far, box, 2) == 0);
}
