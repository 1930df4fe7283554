// SPDX-License-Identifier: BSD-3-Clause
#include "run/run_scene.hpp"

#include <fmt/format.h>

#include "report/scene_advice.hpp"
#include "run/interrupt.hpp"
#include "run/run_balance.hpp"
#include "run/run_static.hpp"
#include "run/time_loop.hpp"

namespace vsb::app {

namespace {

RunResult run_steps(const Scene& scene, const RunOptions& options) {
  RunState state(scene, options);
  const InterruptGuard guard;  // from the first file on
  return TimeLoop(scene, options, state).run();
}

}  // namespace

RunResult run_scene(const Scene& scene, const RunOptions& options) {
  if (scene.growth && options.solution != Solution::steps)
    throw SetupError("[growth] is of a run by time steps: leave it out of a static solution or a balance");
  try {
    switch (options.solution) {
      case Solution::static_state:
        return run_static(scene, options);
      case Solution::balance:
        return run_balance(scene, options);
      case Solution::steps:
        break;
    }
    return run_steps(scene, options);
  } catch (const Diverged& error) {
    const auto hint = units_hint(scene);
    if (hint.empty()) throw;
    throw Diverged(fmt::format("{}; {}", error.what(), hint));
  }
}

}  // namespace vsb::app
