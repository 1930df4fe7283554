// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// When a run writes its next checkpoint.
#pragma once

#include <algorithm>
#include <chrono>

namespace vsb::app {

/// The first checkpoint is due after a minute at most, later ones after the interval that the scene asks for.
class CheckpointClock {
 public:
  /// 0 minutes: none is ever due.
  explicit CheckpointClock(double minutes) : minutes_(minutes) {}

  bool due() const {
    const double wait = any_ ? minutes_ : std::min(1.0, minutes_);
    return minutes_ > 0 && std::chrono::duration<double>(Clock::now() - last_).count() > 60 * wait;
  }
  void written() {
    last_ = Clock::now();
    any_ = true;
  }

 private:
  using Clock = std::chrono::steady_clock;

  double minutes_;
  bool any_ = false;
  Clock::time_point last_ = Clock::now();
};

}  // namespace vsb::app
