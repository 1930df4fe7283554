// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The clock of the benchmarks.
#pragma once

#include "scene.hpp"

#include <ctime>

namespace vsb::bench {

/// Whether other threads than the caller's, or a device, do the work: then wall time counts, not CPU time.
inline bool works_elsewhere() {
  return Exec().concurrency() > 1 || !runs_on_host;
}

/// Seconds: of the process's CPU time where one thread does all the work, else of wall time.
inline double now() {
  timespec t;
  clock_gettime(works_elsewhere() ? CLOCK_MONOTONIC : CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace vsb::bench
