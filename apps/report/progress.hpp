// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// How far a run is: one line that rewrites itself on a terminal, a line every ten seconds elsewhere.
#pragma once

#include <chrono>
#include <string>

namespace vsb::app {

/// "12 s", "3 min 05 s", "2 h 10 min".
std::string duration_text(double seconds);

/// The step at which a run will end, and how that is known.
struct ExpectedEnd {
  enum Kind {
    known,
    foreseen,     ///< a guess
    at_most,      ///< an upper limit
    not_foreseen  ///< an upper limit: the force ratio stands where it is
  };
  long long step;
  Kind kind;
};

class Progress {
 public:
  Progress(bool quiet, int particles);

  /// Whether it is time for another report.
  bool due() const;
  /// `step` steps are done, of which `made` in `seconds` of this program's life.
  void report(long long step, long long made, double seconds, const ExpectedEnd& end, double force_ratio);
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
