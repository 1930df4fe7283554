// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// SIGINT and SIGTERM as a request to stop at the next good moment.
#pragma once

namespace vsb::app {

/// Whether a signal has arrived in the lifetime of the outermost guard.
bool interrupt_requested();

/// Turns the signals into a request while it lives. Guards nest: a study's one spans those of its runs.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

 private:
  using Handler = void (*)(int);
  Handler before_int_, before_term_;
};

}  // namespace vsb::app
