// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The time loop of a run: steps up to the next one at which something is due, then what is due there.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/progress.hpp"
#include "run/checkpoint_clock.hpp"
#include "run/rest_search.hpp"
#include "run/run_state.hpp"
#include "run/step_timer.hpp"

namespace vsb::app {

class TimeLoop {
 public:
  TimeLoop(const Scene& scene, const RunOptions& options, RunState& state);

  /// Writes all that a run leaves behind. It ends at the end of the scene, where the state has become
  /// meaningless, or after an interrupt. Throws as run_scene does.
  RunResult run();

 private:
  /// Before the first step: what earlier runs left goes, the screen is told what comes, the first frame.
  void begin();
  /// A run that was over may go on if its end has changed since; one that was interrupted was not over.
  bool over_when_resumed();
  /// To the next step at which something is due, or to an interrupt.
  void advance();
  /// Does what is due at this step. Whether the run is over.
  bool look();
  /// Whether the run, or its stage, ends at this step; call it where checks are due.
  bool ends_here();
  /// Ends a stage of a run that removes particles, and sets out on the next one. Whether it was the last.
  bool end_stage();
  void write_checkpoint();
  RunResult interrupted();

  /// After the last step, in good order.
  void conclude();
  /// Ends the stages of a run that diverged. False where this is no collapse, but an error.
  bool collapsed(const std::string& message);
  void left_grid(const LeftGrid& error);
  /// Writes what a run leaves at its end.
  RunResult end();
  void count_steps();
  void enter_state();

  /// Warnings, each on a line of its own.
  void tell(const std::vector<std::string>& warnings);
  void print_stage();
  long long steps_made() const { return simulation_.step() - first_step_; }

  const Scene& scene_;
  const RunOptions& options_;
  RunState& state_;
  Simulation& simulation_;
  const bool reports_;          ///< whether the screen wants a head and reports
  const long long first_step_;  ///< of this program's life
  Progress progress_;
  RestSearch rest_;
  StepTimer timer_;
  CheckpointClock clock_;
  RunFigures figures_;
  bool found_static_ = false, collapsed_ = false;
  std::optional<LeftGrid> left_;
};

}  // namespace vsb::app
