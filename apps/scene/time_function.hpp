// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// How a load varies in time: a factor on its full value.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>
#include <vector>

#include "scene/units.hpp"

namespace vsb::app {

class TimeFunction {
 public:
  /// Piecewise linear through (time in s, factor) points of increasing time, constant before the first and
  /// after the last. Two points at the same time are a jump.
  using Table = std::vector<std::pair<double, double>>;
  /// 10 s^3 - 15 s^4 + 6 s^5 of s = t / duration: slope and curvature vanish at both ends.
  struct SmoothRamp {
    double duration;  ///< s
  };
  /// mean + amplitude sin(2 pi (t - start) / period + phase); before `start` the mean.
  struct Sine {
    double period, amplitude, mean, start, phase;  ///< s, 1, 1, s, rad
  };

  TimeFunction(Table points = {{0.0, 1.0}}) : form_(std::move(points)) {}
  TimeFunction(SmoothRamp ramp) : form_(ramp) {}
  TimeFunction(Sine sine) : form_(sine) {}

  static TimeFunction ramp(double duration) { return Table{{0.0, 0.0}, {duration, 1.0}}; }
  static TimeFunction step(double at) { return Table{{at, 0.0}, {at, 1.0}}; }

  /// The factor at time t; at a jump, the value after it.
  double operator()(double t) const {
    return std::visit([t](const auto& form) { return factor(form, t); }, form_);
  }

  /// From here on the factor is constant; infinite where it never is.
  double settled_at() const {
    if (const auto* points = std::get_if<Table>(&form_)) return points->back().first;
    if (const auto* ramp = std::get_if<SmoothRamp>(&form_)) return ramp->duration;
    return std::numeric_limits<double>::infinity();
  }

  /// The largest slope of the factor, up or down, 1/s; infinite at a jump.
  double steepest() const {
    if (const auto* points = std::get_if<Table>(&form_)) return steepest(*points);
    if (const auto* ramp = std::get_if<SmoothRamp>(&form_)) return 1.875 / ramp->duration;  // in its middle
    const auto& sine = std::get<Sine>(form_);
    return 2 * pi * std::abs(sine.amplitude) / sine.period;
  }

 private:
  static double steepest(const Table& points) {
    double most = 0;
    for (size_t i = 1; i < points.size(); ++i)
      if (const double change = std::abs(points[i].second - points[i - 1].second); change > 0)
        most = std::max(most, change / (points[i].first - points[i - 1].first));
    return most;
  }
  static double factor(const Table& points, double t) {
    if (t < points.front().first) return points.front().second;
    for (size_t i = 1; i < points.size(); ++i) {
      const auto [t0, f0] = points[i - 1];
      const auto [t1, f1] = points[i];
      if (t < t1) return f0 + (f1 - f0) * ((t - t0) / (t1 - t0));
    }
    return points.back().second;
  }
  static double factor(const SmoothRamp& ramp, double t) {
    if (t >= ramp.duration) return 1;
    const double s = t / ramp.duration;
    return s * s * s * (10 + s * (6 * s - 15));
  }
  static double factor(const Sine& sine, double t) {
    if (t < sine.start) return sine.mean;
    return sine.mean + sine.amplitude * std::sin(2 * pi * (t - sine.start) / sine.period + sine.phase);
  }

  std::variant<Table, SmoothRamp, Sine> form_;
};

}  // namespace vsb::app
