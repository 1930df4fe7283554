// SPDX-License-Identifier: BSD-3-Clause
#include "scene/region.hpp"

#include <algorithm>

namespace vsb::app {

namespace {
double square(double x) {
  return x * x;
}
}  // namespace

Region everywhere() {
  return [](const Point&) { return true; };
}

Region box(int dimension, const Point& lower, const Point& upper) {
  return [=](const Point& x) {
    for (size_t i = 0; i < static_cast<size_t>(dimension); ++i)
      if (x[i] < lower[i] || x[i] > upper[i]) return false;
    return true;
  };
}

Region ball(const Point& center, double radius) {
  return [=](const Point& x) {
    return square(x[0] - center[0]) + square(x[1] - center[1]) + square(x[2] - center[2]) <= square(radius);
  };
}

Region cylinder(int axis, const Point& center, double radius, double lower, double upper) {
  const auto a = static_cast<size_t>(axis), b = (a + 1) % 3, c = (a + 2) % 3;
  return [=](const Point& x) {
    return x[a] >= lower && x[a] <= upper &&
           square(x[b] - center[b]) + square(x[c] - center[c]) <= square(radius);
  };
}

Region ellipsoid(int dimension, const Point& center, const Point& semi_axes) {
  return [=](const Point& x) {
    double sum = 0;
    for (size_t i = 0; i < static_cast<size_t>(dimension); ++i)
      sum += square((x[i] - center[i]) / semi_axes[i]);
    return sum <= 1;
  };
}

Region half_space(const Point& point, const Point& normal) {
  return [=](const Point& x) {
    return (x[0] - point[0]) * normal[0] + (x[1] - point[1]) * normal[1] + (x[2] - point[2]) * normal[2] <= 0;
  };
}

Region union_of(std::vector<Region> parts) {
  return [parts = std::move(parts)](const Point& x) {
    return std::any_of(parts.begin(), parts.end(), [&](const Region& part) { return part(x); });
  };
}

Region intersection_of(std::vector<Region> parts) {
  return [parts = std::move(parts)](const Point& x) {
    return std::all_of(parts.begin(), parts.end(), [&](const Region& part) { return part(x); });
  };
}

Region difference_of(std::vector<Region> parts) {
  return [parts = std::move(parts)](const Point& x) {
    return parts.front()(x) &&
           std::none_of(parts.begin() + 1, parts.end(), [&](const Region& part) { return part(x); });
  };
}

}  // namespace vsb::app
