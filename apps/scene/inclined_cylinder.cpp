// SPDX-License-Identifier: BSD-3-Clause
#include "scene/inclined_cylinder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vsb::app {

namespace {

class InclinedCylinder {
 public:
  InclinedCylinder(const Point& axis, const Point& center, double radius, double lower, double upper)
      : center_(center), radius_(radius), lower_(lower), upper_(upper) {
    const double length = std::hypot(axis[0], axis[1], axis[2]);
    for (size_t i = 0; i < 3; ++i) e_[i] = axis[i] / length;
  }

  bool contains(const Point& x) const {
    const double s = along(x);
    return s >= lower_ && s <= upper_ && from_axis(from_center(x)) <= radius_;
  }

  /// The distance from the axis is convex: greatest at a corner; and nowhere less than in the middle but for
  /// what a corner is away from the middle across the axis.
  Overlap overlap(const AxisBox& box) const {
    Point middle{}, half{};
    for (size_t i = 0; i < 3; ++i) {
      middle[i] = 0.5 * (box.lower[i] + box.upper[i]);
      half[i] = 0.5 * (box.upper[i] - box.lower[i]);
    }
    double first = std::numeric_limits<double>::infinity(), last = -first, farthest = 0, across = 0;
    for (unsigned corner = 0; corner < 8; ++corner) {
      Point x = middle, to_corner{};
      for (size_t i = 0; i < 3; ++i) {
        to_corner[i] = corner >> i & 1 ? half[i] : -half[i];
        x[i] += to_corner[i];
      }
      first = std::min(first, along(x));
      last = std::max(last, along(x));
      farthest = std::max(farthest, from_axis(from_center(x)));
      across = std::max(across, from_axis(to_corner));
    }
    const double nearest = from_axis(from_center(middle)) - across;
    if (nearest >= radius_ || last <= lower_ || first >= upper_) return Overlap::none;
    return farthest <= radius_ && first >= lower_ && last <= upper_ ? Overlap::all : Overlap::some;
  }

 private:
  double along(const Point& x) const { return x[0] * e_[0] + x[1] * e_[1] + x[2] * e_[2]; }
  Point from_center(const Point& x) const {
    return {x[0] - center_[0], x[1] - center_[1], x[2] - center_[2]};
  }
  /// |x - (x . e) e|.
  double from_axis(const Point& x) const {
    const double s = along(x);
    return std::hypot(x[0] - s * e_[0], x[1] - s * e_[1], x[2] - s * e_[2]);
  }

  Point e_{}, center_;
  double radius_, lower_, upper_;
};

}  // namespace

Region inclined_cylinder(const Point& axis, const Point& center, double radius, double lower, double upper) {
  const InclinedCylinder cylinder(axis, center, radius, lower, upper);
  return {[=](const Point& x) { return cylinder.contains(x); },
          [=](const AxisBox& box) { return cylinder.overlap(box); }};
}

}  // namespace vsb::app
