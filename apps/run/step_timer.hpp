// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The time that the steps of a run take, without its checks and files.
#pragma once

#include <string>

namespace vsb::app {

class StepTimer {
 public:
  /// Calls work(), which makes steps.
  template <class Work>
  void time(const Work& work) {
    const double wall = wall_now(), processor = processor_now();
    work();
    seconds_ += wall_now() - wall;
    processor_ += processor_now() - processor;
  }

  /// Wall time, s: of all steps, and of those since the last begin_stage().
  double seconds() const { return seconds_; }
  double stage_seconds() const { return seconds_ - before_stage_; }
  void begin_stage() { before_stage_ = seconds_; }

  /// A sentence where the threads wait for the processor; empty where they do not, before that can be told,
  /// and after it was told once.
  std::string waiting_threads_once();

 private:
  static double wall_now();
  static double processor_now();

  double seconds_ = 0, processor_ = 0, before_stage_ = 0;
  bool looked_at_threads_ = false;
};

}  // namespace vsb::app
