// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Regions of space: where bodies are and which surfaces tractions act on. Host only.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace vsb::app {

/// A point in m; coordinates beyond the scene's dimension are zero.
using Point = std::array<double, 3>;

/// lower <= x <= upper.
struct AxisBox {
  Point lower{}, upper{};
};
constexpr double no_end = std::numeric_limits<double>::infinity();
constexpr AxisBox all_space{{-no_end, -no_end, -no_end}, {no_end, no_end, no_end}};

/// The share of a box that lies in a region: nothing or everything, but for sets of no volume, or possibly
/// some.
enum class Overlap { none, some, all };

/// A set of points. The answer for a box is safe: `none` and `all` are certain, however thin the region's
/// features are; of boxes in between, some are called `some` that are not. Copies share what they consist of.
/// One that nobody has made is empty.
class Region {
 public:
  Region() = default;
  /// A shape: whether it has a point, its overlap with a box, and its bounds.
  template <class Contains, class OverlapWith>
  Region(Contains contains, OverlapWith overlap, const AxisBox& bounds = all_space)
      : operation_(Operation::shape),
        shape_(std::make_shared<const ShapeOf<Contains, OverlapWith>>(std::move(contains), std::move(overlap),
                                                                      bounds)) {}

  bool operator()(const Point& x) const;
  Overlap overlap(const AxisBox& box) const;
  /// A box beyond which no point of the region lies; infinite where the shapes do not tell.
  AxisBox bounds() const;
  /// The region as it is in a box, but for sets of no volume, of the parts alone that have a say there. What
  /// it is beyond the box means nothing.
  Region within(const AxisBox& box) const;
  bool is_empty() const { return operation_ == Operation::nothing; }
  bool is_everywhere() const { return operation_ == Operation::everywhere; }

 private:
  enum class Operation { nothing, everywhere, shape, sum, intersection, difference };
  using Parts = std::vector<Region>;

  struct Shape {
    virtual ~Shape() = default;
    virtual bool contains(const Point& x) const = 0;
    virtual Overlap overlap(const AxisBox& box) const = 0;
    virtual const AxisBox& bounds() const = 0;
  };
  template <class Contains, class OverlapWith>
  class ShapeOf final : public Shape {
   public:
    ShapeOf(Contains contains, OverlapWith overlap, const AxisBox& bounds)
        : contains_(std::move(contains)), overlap_(std::move(overlap)), bounds_(bounds) {}
    bool contains(const Point& x) const override { return contains_(x); }
    Overlap overlap(const AxisBox& box) const override { return overlap_(box); }
    const AxisBox& bounds() const override { return bounds_; }

   private:
    Contains contains_;
    OverlapWith overlap_;
    AxisBox bounds_;
  };

  Region(Operation operation, Parts parts);
  bool is_same(const Region& other) const;

  Operation operation_ = Operation::nothing;
  std::shared_ptr<const Shape> shape_;
  std::shared_ptr<const Parts> parts_;  ///< those of a difference: of the first one the others are taken

  friend Region everywhere();
  friend Region union_of(std::vector<Region> parts);
  friend Region intersection_of(std::vector<Region> parts);
  friend Region difference_of(std::vector<Region> parts);
};

/// The points of both boxes; upper < lower where there are none.
AxisBox common_box(const AxisBox& a, const AxisBox& b);

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
