// SPDX-License-Identifier: BSD-3-Clause
#include "run/step_timer.hpp"

#include <chrono>

#include "engine/kokkos_session.hpp"
#include "engine/waiting_threads.hpp"

namespace vsb::app {

double StepTimer::wall_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double StepTimer::processor_now() {
  return processor_seconds();
}

std::string StepTimer::waiting_threads_once() {
  if (looked_at_threads_ || seconds_ < seconds_to_look_at_threads) return {};
  looked_at_threads_ = true;
  return waiting_threads(threads_at_hand(), processor_, seconds_);
}

}  // namespace vsb::app
