// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// SIGINT, SIGTERM, SIGHUP, and an output that nobody reads any more, as a request to stop at the next good
/// moment.
#pragma once

#include <array>

namespace vsb::app {

/// Whether a signal or request_interrupt came in the lifetime of the outermost guard.
bool interrupt_requested();

/// What a signal does. False where no guard lives, so that nobody will answer.
bool request_interrupt();

/// Turns the signals into a request while it lives. Guards nest: a study's one spans those of its runs. A
/// SIGHUP that is ignored (nohup) stays so.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

 private:
  using Handler = void (*)(int);
  std::array<Handler, 3> before_{};
};

}  // namespace vsb::app
