// SPDX-License-Identifier: BSD-3-Clause
#include "engine/waiting_threads.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>

namespace vsb::app {

namespace {

constexpr double least_share = 0.6;  ///< of the time of all threads

}  // namespace

double processor_seconds() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

std::string waiting_threads(int threads, double processor, double wall) {
  if (threads < 2 || wall < seconds_to_look_at_threads) return "";
  const double busy = processor / wall;
  if (busy >= least_share * threads) return "";
  return fmt::format(
      "{} threads had {:.1f} cores in the first {:.1f} s of steps and waited for the rest: other work has "
      "taken cores, or there is too little of this; --threads {} may be faster (--resume goes on from here "
      "after Ctrl-C)",
      threads, busy, wall, std::clamp(static_cast<int>(std::lround(busy)), 1, threads - 1));
}

}  // namespace vsb::app
