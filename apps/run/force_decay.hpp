// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// How the force ratio of a run until static falls, once the loads are constant: exponentially, towards rest,
/// or not at all.
#pragma once

#include <optional>
#include <utility>
#include <vector>

namespace vsb::app {

class ForceDecay {
 public:
  /// A force ratio that stays.
  struct Level {
    double ratio;
    long long since;  ///< step
  };

  /// The force ratio at a step, later than the ones before.
  void observe(long long step, double force_ratio);
  /// The step at which it falls to a ratio, by its medians over the middle and over the last third of the
  /// steps; nothing while too few were observed, or where it does not fall.
  std::optional<long long> reaches(double ratio) const;
  /// Where it has not fallen by a tenth from the middle third to the last one.
  std::optional<Level> stands() const;

 private:
  /// Of the ratios from `begin` to before `end`.
  double median(size_t begin, size_t end) const;
  /// Those over the middle and over the last third.
  std::optional<std::pair<double, double>> medians() const;

  std::vector<std::pair<long long, double>> seen_;  ///< step, force ratio; thinned out as they become many
  long long stride_ = 1, count_ = 0;                ///< one in `stride_` of `count_` is kept
};

}  // namespace vsb::app
