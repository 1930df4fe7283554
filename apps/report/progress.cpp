// SPDX-License-Identifier: BSD-3-Clause
#include "report/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace vsb::app {

std::string duration_text(double seconds) {
  const auto s = static_cast<long long>(seconds + 0.5);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} h {:02} min", s / 3600, s / 60 % 60);
}

Progress::Progress(bool quiet, int particles)
    : quiet_(quiet), terminal_(isatty(STDOUT_FILENO) == 1), particles_(particles), last_(Clock::now()) {}

bool Progress::due() const {
  const double wait = terminal_ ? 0.5 : 10.0;
  return !quiet_ && std::chrono::duration<double>(Clock::now() - last_).count() >= wait;
}

void Progress::report(long long step, long long made, double seconds, const ExpectedEnd& end,
                      double force_ratio) {
  if (quiet_) return;
  const char* how = end.kind == ExpectedEnd::known      ? ""
                    : end.kind == ExpectedEnd::foreseen ? "about "
                                                        : "at most ";
  std::string line = fmt::format("step {} of {}{}", step, how, end.step);
  if (made > 0 && seconds > 0) {
    const double rate = static_cast<double>(made) / seconds;
    line += fmt::format(", {:.3g} particle-steps/s", rate * particles_);
    line += fmt::format(", {}{} left", how, duration_text(static_cast<double>(end.step - step) / rate));
  }
  line += fmt::format(", force ratio {}{:.2e}", end.kind == ExpectedEnd::not_foreseen ? "stands at " : "",
                      force_ratio);
  show(line);
}

void Progress::report_iteration(int iteration, double residual) {
  if (!quiet_) show(fmt::format("iteration {}, relative residual {:.2e}", iteration, residual));
}

void Progress::show(const std::string& line) {
  last_ = Clock::now();
  if (terminal_)
    fmt::print("\r{:<100}", line);
  else
    fmt::print("{}\n", line);
  std::fflush(stdout);
  open_line_ = terminal_;
}

void Progress::finish() {
  if (open_line_) fmt::print("\n");
  open_line_ = false;
}

}  // namespace vsb::app
