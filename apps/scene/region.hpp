// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Regions of space: where bodies are and which surfaces tractions act on. Host only.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace vsb::app {

/// A point in m; coordinates beyond the scene's dimension are zero.
using Point = std::array<double, 3>;

/// lower <= x <= upper.
struct AxisBox {
  Point lower{}, upper{};
};

/// The share of a box that lies in a region: nothing or everything, but for sets of no volume, or possibly
/// some.
enum class Overlap { none, some, all };

/// A set of points. The answer for a box is safe: `none` and `all` are certain, however thin the region's
/// features are; of boxes in between, some are called `some` that are not.
class Region {
 public:
  using Contains = std::function<bool(const Point&)>;
  using OverlapWith = std::function<Overlap(const AxisBox&)>;

  Region() = default;
  Region(Contains contains, OverlapWith overlap)
      : contains_(std::move(contains)), overlap_(std::move(overlap)) {}

  bool operator()(const Point& x) const { return contains_(x); }
  Overlap overlap(const AxisBox& box) const { return overlap_(box); }

 private:
  Contains contains_;
  OverlapWith overlap_;
};

Region everywhere();
/// lower <= x <= upper in the first `dimension` coordinates.
Region box(int dimension, const Point& lower, const Point& upper);
/// |x - center| <= radius; a disc in 2D.
Region ball(const Point& center, double radius);
/// Infinite along `axis` (0, 1, 2), or between lower and upper along it.
Region cylinder(int axis, const Point& center, double radius, double lower, double upper);
/// sum ((x_i - center_i) / semi_axes_i)^2 <= 1 in the first `dimension` coordinates; an ellipse in 2D.
Region ellipsoid(int dimension, const Point& center, const Point& semi_axes);
/// (x - point) . normal <= 0.
Region half_space(const Point& point, const Point& normal);
Region union_of(std::vector<Region> parts);
Region intersection_of(std::vector<Region> parts);
/// The first part without the others.
Region difference_of(std::vector<Region> parts);

}  // namespace vsb::app
