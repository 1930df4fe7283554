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

}  // namespace

Region everywhere() {
  return {[](const Point&) { return true; }, [](const AxisBox&) { return Overlap::all; }};
}

Region box(int dimension, const Point& lower, const Point& upper) {
  const auto d = static_cast<size_t>(dimension);
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
          }};
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
          }};
}

Region cylinder(int axis, const Point& center, double radius, double lower, double upper) {
  const auto a = static_cast<size_t>(axis), b = (a + 1) % 3, c = (a + 2) % 3;
  return {[=](const Point& x) {
            return x[a] >= lower && x[a] <= upper &&
                   square(x[b] - center[b]) + square(x[c] - center[c]) <= square(radius);
          },
          [=](const AxisBox& box) {
            const double least = square(nearest(box, b, center[b])) + square(nearest(box, c, center[c]));
            const double greatest = square(farthest(box, b, center[b])) + square(farthest(box, c, center[c]));
            return overlap_of_both(overlap_of_interval(box, a, lower, upper),
                                   overlap_below(square(radius), least, greatest));
          }};
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
          }};
}

Region half_space(const Point& point, const Point& normal) {
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
          }};
}

Region union_of(std::vector<Region> parts) {
  const auto overlap = [parts](const AxisBox& b) {
    Overlap most = Overlap::none;
    for (const auto& part : parts) most = std::max(most, part.overlap(b));
    return most;
  };
  return {[parts = std::move(parts)](const Point& x) {
            return std::any_of(parts.begin(), parts.end(), [&](const Region& part) { return part(x); });
          },
          overlap};
}

Region intersection_of(std::vector<Region> parts) {
  const auto overlap = [parts](const AxisBox& b) {
    Overlap least = Overlap::all;
    for (const auto& part : parts) least = overlap_of_both(least, part.overlap(b));
    return least;
  };
  return {[parts = std::move(parts)](const Point& x) {
            return std::all_of(parts.begin(), parts.end(), [&](const Region& part) { return part(x); });
          },
          overlap};
}

Region difference_of(std::vector<Region> parts) {
  const auto overlap = [parts](const AxisBox& b) {
    Overlap least = parts.front().overlap(b);
    for (size_t k = 1; k < parts.size(); ++k) {
      const Overlap without = parts[k].overlap(b);
      least = overlap_of_both(least, without == Overlap::all    ? Overlap::none
                                     : without == Overlap::none ? Overlap::all
                                                                : Overlap::some);
    }
    return least;
  };
  return {[parts = std::move(parts)](const Point& x) {
            return parts.front()(x) &&
                   std::none_of(parts.begin() + 1, parts.end(), [&](const Region& part) { return part(x); });
          },
          overlap};
}

}  // namespace vsb::app
