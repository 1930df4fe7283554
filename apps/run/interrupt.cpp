// SPDX-License-Identifier: BSD-3-Clause
#include "run/interrupt.hpp"

#include <csignal>

namespace vsb::app {

namespace {

volatile std::sig_atomic_t requested = 0;
int guards = 0;

void on_signal(int) {
  requested = 1;
}

}  // namespace

bool interrupt_requested() {
  return requested != 0;
}

InterruptGuard::InterruptGuard() {
  if (guards++ == 0) requested = 0;
  before_int_ = std::signal(SIGINT, on_signal);
  before_term_ = std::signal(SIGTERM, on_signal);
}

InterruptGuard::~InterruptGuard() {
  std::signal(SIGINT, before_int_);
  std::signal(SIGTERM, before_term_);
  --guards;
}

}  // namespace vsb::app
