// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// How far a run is: one line that rewrites itself on a terminal, a line every ten seconds elsewhere.
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace vsb::app {

/// "12 s", "3 min 05 s", "2 h 10 min".
std::string duration_text(double seconds);

class Progress {
 public:
  Progress(bool quiet, int particles);

  /// Whether it is time for another report.
  bool due() const;
  /// `step` steps are done, of which `made` in `seconds` of this program's life; `expected` is the step at
  /// which the run will end, where one can tell; `foreseen` where that is a guess.
  void report(long long step, long long made, double seconds, std::optional<long long> expected,
              double force_ratio, bool foreseen);
  /// The same for a static solution.
  void report_iteration(int iteration, double residual);
  /// Ends the line on a terminal.
  void finish();

 private:
  void show(const std::string& line);

  using Clock = std::chrono::steady_clock;
  bool quiet_, terminal_, open_line_ = false;
  int particles_;
  Clock::time_point last_;
};

}  // namespace vsb::app
