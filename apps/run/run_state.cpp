// SPDX-License-Identifier: BSD-3-Clause
#include "run/run_state.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "run/run_parts.hpp"

namespace vsb::app {

namespace {

/// Refuses to go on from a step behind the last one.
void refuse_end_before(const Scene& scene, long long step, long long last) {
  if (step > last)
    throw SetupError(fmt::format("the checkpoint is of step {}, and {} = {} ends the run before it", step,
                                 scene.time.until_static ? "time.until_static.max_steps" : "time.steps",
                                 scene.time.steps));
}

}  // namespace

RunState::RunState(const Scene& scene, const RunOptions& options)
    : scene_(scene),
      simulation(make_simulation(scene, options.placed)),
      stages(scene.removal ? std::optional<Stages>(std::in_place, scene, *simulation) : std::nullopt),
      watch(scene, *simulation),
      results(options.directory, scene) {
  results.claim();
  if (options.resume) resume(!options.progress_only);
}

void RunState::resume(bool tell) {
  auto& checkpoints = results.checkpoints();
  const auto saved = checkpoints.read();
  if (!saved) {
    if (tell) fmt::print(stderr, "vsb: no checkpoint in {}; starting from step 0\n", results.directory());
    return;
  }
  simulation->restore(*saved, *checkpoints.read_particles());
  if (stages) stages->restore(saved->staged);
  watch.restore(checkpoints.watched());
  resumed_step_ = saved->step;
  refuse_end_before(scene_, resumed_step_, last_step());
}

void RunState::write_frame() {
  write_frames(results, scene_, *simulation);
  framed_step_ = simulation->step();
}

void RunState::write_checkpoint(double stage_seconds) {
  auto saved = simulation->saved_state();
  if (stages) saved = stages->with_stages(std::move(saved), stage_seconds);
  results.checkpoints().write(saved, watch.saved(), *simulation);
}

}  // namespace vsb::app
