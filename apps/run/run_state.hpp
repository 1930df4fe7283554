// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What a run by time steps works on: the simulation, the stages of its removal, the watch over its
/// tractions, and its files; new, or as its checkpoint left them.
#pragma once

#include <memory>
#include <optional>

#include "engine/simulation.hpp"
#include "files/results.hpp"
#include "report/traction_watch.hpp"
#include "run/run_scene.hpp"
#include "run/stages.hpp"

namespace vsb::app {

class RunState {
 public:
  /// Claims the directory of the results; with options.resume it goes on from the checkpoint there. Throws
  /// SetupError and FileError.
  RunState(const Scene& scene, const RunOptions& options);

  /// The step of the checkpoint; -1 without one.
  long long resumed_step() const { return resumed_step_; }
  /// Of the run, or of its present stage.
  long long last_step() const { return (stages ? stages->first_step() : 0) + scene_.time.steps; }
  /// Whether the run was resumed between two stages.
  bool resumed_between_stages() const { return stages && resumed_step_ == stages->first_step(); }

  void write_frame();
  /// Whether the last frame is of the present state.
  bool frame_is_written() const { return framed_step_ == simulation->step(); }
  /// `stage_seconds`: what the present stage has taken.
  void write_checkpoint(double stage_seconds);

 private:
  void resume(bool tell);

  const Scene& scene_;

 public:
  const std::unique_ptr<Simulation> simulation;
  std::optional<Stages> stages;  ///< where particles are removed in stages
  TractionWatch watch;
  Results results;

 private:
  long long resumed_step_ = -1, framed_step_ = -1;
};

}  // namespace vsb::app
