// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// How a load varies in time: a factor on its full value.
#pragma once

#include <utility>
#include <vector>

namespace vsb::app {

/// Piecewise linear through (time in s, factor) points of increasing time, constant before the first and
/// after the last. A ramp is {(0, 0), (T, 1)}; two points at the same time are a jump.
class TimeFunction {
 public:
  explicit TimeFunction(std::vector<std::pair<double, double>> points = {{0.0, 1.0}})
      : points_(std::move(points)) {}

  static TimeFunction ramp(double duration) { return TimeFunction({{0.0, 0.0}, {duration, 1.0}}); }
  static TimeFunction step(double at) { return TimeFunction({{at, 0.0}, {at, 1.0}}); }

  /// The factor at time t; at a jump, the value after it.
  double operator()(double t) const {
    if (t < points_.front().first) return points_.front().second;
    for (size_t i = 1; i < points_.size(); ++i) {
      const auto [t0, f0] = points_[i - 1];
      const auto [t1, f1] = points_[i];
      if (t < t1) return f0 + (f1 - f0) * ((t - t0) / (t1 - t0));
    }
    return points_.back().second;
  }

  /// From here on the factor is constant.
  double settled_at() const { return points_.back().first; }

 private:
  std::vector<std::pair<double, double>> points_;
};

}  // namespace vsb::app
