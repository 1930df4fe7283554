// SPDX-License-Identifier: BSD-3-Clause
#include "run/interrupt.hpp"

#include <csignal>

namespace vsb::app {

namespace {

constexpr std::array<int, 3> signals = {SIGINT, SIGTERM, SIGHUP};
volatile std::sig_atomic_t requested = 0;
int guards = 0;

void on_signal(int) {
  requested = 1;
}

}  // namespace

bool interrupt_requested() {
  return requested != 0;
}

bool request_interrupt() {
  requested = 1;
  return guards > 0;
}

InterruptGuard::InterruptGuard() {
  if (guards++ == 0) requested = 0;
  for (size_t n = 0; n < signals.size(); ++n) {
    before_[n] = std::signal(signals[n], on_signal);
    if (signals[n] == SIGHUP && before_[n] == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  }
}

InterruptGuard::~InterruptGuard() {
  for (size_t n = 0; n < signals.size(); ++n) std::signal(signals[n], before_[n]);
  --guards;
}

}  // namespace vsb::app
