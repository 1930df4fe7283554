// SPDX-License-Identifier: BSD-3-Clause
#include "scene/region.hpp"

#include <algorithm>
#include <cmath>

namespace vsb::app {

namespace {

double square(double x) {
  return x * x;
}

/// Distances along one axis from c to the nearest and to the farthest point of a box.
double nearest(const AxisBox& box, size_t i, double c) {
  return std::max({box.lower[i] - c, 0.0, c - box.upper[i]});
}
double farthest(const AxisBox& box, size_t i, double c) {
  return std::max(c - box.lower[i], box.upper[i] - c);
}

/// Of a region f <= limit, from the least and the greatest f in the box.
Overlap overlap_below(double limit, double least, double greatest) {
  return least >= limit ? Overlap::none : greatest <= limit ? Overlap::all : Overlap::some;
}

Overlap overlap_of_interval(const AxisBox& box, size_t i, double lower, double upper) {
  if (box.upper[i] <= lower || box.lower[i] >= upper) return Overlap::none;
  return box.lower[i] >= lower && box.upper[i] <= upper ? Overlap::all : Overlap::some;
}

Overlap overlap_of_both(Overlap a, Overlap b) {
  return std::min(a, b);
}

constexpr AxisBox no_space{{no_end, no_end, no_end}, {-no_end, -no_end, -no_end}};

AxisBox box_around(AxisBox a, const AxisBox& b) {
  for (size_t i = 0; i < 3; ++i) {
    a.lower[i] = std::min(a.lower[i], b.lower[i]);
    a.upper[i] = std::max(a.upper[i], b.upper[i]);
  }
  return a;
}

Overlap complement(Overlap overlap) {
  return overlap == Overlap::all ? Overlap::none : overlap == Overlap::none ? Overlap::all : Overlap::some;
}

/// center +- half_widths in the first `dimension` coordinates.
AxisBox box_about(int dimension, const Point& center, const Point& half_widths) {
  AxisBox box = all_space;
  for (size_t i = 0; i < static_cast<size_t>(dimension); ++i) {
    box.lower[i] = center[i] - half_widths[i];
    box.upper[i] = center[i] + half_widths[i];
  }
  return box;
}

}  // namespace

AxisBox common_box(const AxisBox& a, const AxisBox& b) {
  AxisBox common = a;
  for (size_t i = 0; i < 3; ++i) {
    common.lower[i] = std::max(a.lower[i], b.lower[i]);
    common.upper[i] = std::min(a.upper[i], b.upper[i]);
  }
  return common;
}

Region::Region(Operation operation, Parts parts)
    : operation_(operation), parts_(std::make_shared<const Parts>(std::move(parts))) {}

bool Region::is_same(const Region& other) const {
  return operation_ == other.operation_ && shape_ == other.shape_ && parts_ == other.parts_;
}

bool Region::operator()(const Point& x) const {
  const auto has_x = [&](const Region& part) { return part(x); };
  switch (operation_) {
    case Operation::shape:
      return shape_->contains(x);
    case Operation::sum:
      return std::any_of(parts_->begin(), parts_->end(), has_x);
    case Operation::intersection:
      return std::all_of(parts_->begin(), parts_->end(), has_x);
    case Operation::difference:
      return parts_->front()(x) && std::none_of(parts_->begin() + 1, parts_->end(), has_x);
    default:
      return operation_ == Operation::everywhere;
  }
}

Overlap Region::overlap(const AxisBox& box) const {
  switch (operation_) {
    case Operation::shape:
      return shape_->overlap(box);
    case Operation::sum: {
      Overlap most = Overlap::none;
      for (const auto& part : *parts_) most = std::max(most, part.overlap(box));
      return most;
    }
    case Operation::intersection: {
      Overlap least = Overlap::all;
      for (const auto& part : *parts_) least = overlap_of_both(least, part.overlap(box));
      return least;
    }
    case Operation::difference: {
      Overlap least = parts_->front().overlap(box);
      for (size_t k = 1; k < parts_->size() && least != Overlap::none; ++k)
        least = overlap_of_both(least, complement((*parts_)[k].overlap(box)));
      return least;
    }
    default:
      return operation_ == Operation::everywhere ? Overlap::all : Overlap::none;
  }
}

AxisBox Region::bounds() const {
  switch (operation_) {
    case Operation::shape:
      return shape_->bounds();
    case Operation::sum: {
      AxisBox around = no_space;
      for (const auto& part : *parts_) around = box_around(around, part.bounds());
      return around;
    }
    case Operation::intersection: {
      AxisBox common = all_space;
      for (const auto& part : *parts_) common = common_box(common, part.bounds());
      return common;
    }
    case Operation::difference:
      return parts_->front().bounds();
    default:
      return operation_ == Operation::everywhere ? all_space : no_space;
  }
}

Region Region::within(const AxisBox& box) const {
  if (operation_ == Operation::shape) {
    const Overlap overlap = shape_->overlap(box);
    return overlap == Overlap::none ? Region() : overlap == Overlap::all ? everywhere() : *this;
  }
  if (!parts_) return *this;
  Parts left;
  bool same = true;
  for (size_t k = 0; k < parts_->size(); ++k) {
    const Region& whole = (*parts_)[k];
    Region part = whole.within(box);
    const bool first = operation_ == Operation::difference && k == 0;
    const bool is_taken_out = operation_ == Operation::difference && k > 0;
    // A part that decides about the whole box, and one that has no say in it.
    const bool decides =
        operation_ == Operation::sum || is_taken_out ? part.is_everywhere() : part.is_empty();
    if (decides) return operation_ == Operation::sum ? everywhere() : Region();
    const bool counts =
        first || !(operation_ == Operation::intersection ? part.is_everywhere() : part.is_empty());
    same = same && counts && part.is_same(whole);
    if (counts) left.push_back(std::move(part));
  }
  if (same) return *this;
  if (left.empty()) return operation_ == Operation::intersection ? everywhere() : Region();
  return left.size() == 1 ? left.front() : Region(operation_, std::move(left));
}

Region everywhere() {
  Region region;
  region.operation_ = Region::Operation::everywhere;
  return region;
}

Region box(int dimension, const Point& lower, const Point& upper) {
  const auto d = static_cast<size_t>(dimension);
  AxisBox bounds = all_space;
  for (size_t i = 0; i < d; ++i) {
    bounds.lower[i] = lower[i];
    bounds.upper[i] = upper[i];
  }
  return {[=](const Point& x) {
            for (size_t i = 0; i < d; ++i)
              if (x[i] < lower[i] || x[i] > upper[i]) return false;
            return true;
          },
          [=](const AxisBox& b) {
            Overlap overlap = Overlap::all;
            for (size_t i = 0; i < d; ++i)
              overlap = overlap_of_both(overlap, overlap_of_interval(b, i, lower[i], upper[i]));
            return overlap;
          },
          bounds};
}

Region ball(const Point& center, double radius) {
  return {[=](const Point& x) {
            return square(x[0] - center[0]) + square(x[1] - center[1]) + square(x[2] - center[2]) <=
                   square(radius);
          },
          [=](const AxisBox& b) {
            double least = 0, greatest = 0;
            for (size_t i = 0; i < 3; ++i) {
              least += square(nearest(b, i, center[i]));
              greatest += square(farthest(b, i, center[i]));
            }
            return overlap_below(square(radius), least, greatest);
          },
          box_about(3, center, {radius, radius, radius})};
}

Region cylinder(int axis, const Point& center, double radius, double lower, double upper) {
  const auto a = static_cast<size_t>(axis), b = (a + 1) % 3, c = (a + 2) % 3;
  AxisBox bounds = box_about(3, center, {radius, radius, radius});
  bounds.lower[a] = lower;
  bounds.upper[a] = upper;
  return {[=](const Point& x) {
            return x[a] >= lower && x[a] <= upper &&
                   square(x[b] - center[b]) + square(x[c] - center[c]) <= square(radius);
          },
          [=](const AxisBox& box) {
            const double least = square(nearest(box, b, center[b])) + square(nearest(box, c, center[c]));
            const double greatest = square(farthest(box, b, center[b])) + square(farthest(box, c, center[c]));
            return overlap_of_both(overlap_of_interval(box, a, lower, upper),
                                   overlap_below(square(radius), least, greatest));
          },
          bounds};
}

Region ellipsoid(int dimension, const Point& center, const Point& semi_axes) {
  const auto d = static_cast<size_t>(dimension);
  return {[=](const Point& x) {
            double sum = 0;
            for (size_t i = 0; i < d; ++i) sum += square((x[i] - center[i]) / semi_axes[i]);
            return sum <= 1;
          },
          [=](const AxisBox& b) {
            double least = 0, greatest = 0;
            for (size_t i = 0; i < d; ++i) {
              least += square(nearest(b, i, center[i]) / semi_axes[i]);
              greatest += square(farthest(b, i, center[i]) / semi_axes[i]);
            }
            return overlap_below(1, least, greatest);
          },
          box_about(dimension, center, semi_axes)};
}

Region half_space(const Point& point, const Point& normal) {
  AxisBox bounds = all_space;  // but for a face across an axis
  for (size_t i = 0; i < 3; ++i)
    if (normal[i] != 0 && normal[(i + 1) % 3] == 0 && normal[(i + 2) % 3] == 0)
      (normal[i] > 0 ? bounds.upper : bounds.lower)[i] = point[i];
  return {[=](const Point& x) {
            return (x[0] - point[0]) * normal[0] + (x[1] - point[1]) * normal[1] +
                       (x[2] - point[2]) * normal[2] <=
                   0;
          },
          [=](const AxisBox& b) {
            double least = 0, greatest = 0;
            for (size_t i = 0; i < 3; ++i) {
              const double low = (b.lower[i] - point[i]) * normal[i],
                           high = (b.upper[i] - point[i]) * normal[i];
              least += std::min(low, high);
              greatest += std::max(low, high);
            }
            return overlap_below(0, least, greatest);
          },
          bounds};
}

Region union_of(std::vector<Region> parts) {
  return {Region::Operation::sum, std::move(parts)};
}

Region intersection_of(std::vector<Region> parts) {
  return {Region::Operation::intersection, std::move(parts)};
}

Region difference_of(std::vector<Region> parts) {
  return {Region::Operation::difference, std::move(parts)};
}

}  // namespace vsb::app
