// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Whether the threads of a run work or wait. Their number is chosen when the program starts and stays; the
/// machine may become busy after that.
#pragma once

#include <string>

namespace vsb::app {

/// Of steps, before it can be told.
constexpr double seconds_to_look_at_threads = 2;

/// Of this process, all its threads together, s.
double processor_seconds();

/// A sentence where `threads` got much less of the processor in `wall` seconds of steps than they could have
/// had; empty where they did not, and in the first seconds_to_look_at_threads.
std::string waiting_threads(int threads, double processor, double wall);

}  // namespace vsb::app
