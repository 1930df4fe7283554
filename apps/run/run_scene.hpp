// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Runs a scene from start to end: by time steps (run/time_loop.hpp), or without any.
#pragma once

#include <string>

#include "report/solution.hpp"
#include "report/summary.hpp"
#include "scene/scene.hpp"

namespace vsb::app {

enum ExitCode {
  exit_done = 0,
  exit_internal = 1,
  exit_input = 2,
  exit_diverged = 3,
  exit_files = 4,
  exit_interrupted = 5,
  exit_study_failed = 6,  ///< a study was run, but not all of its expectations are met
  exit_not_static = 7,  ///< a run until static, or a static solution, came to its last step before it was, or
                        ///< to rest without one of its loads
  exit_left_grid = 8    ///< a healthy body left the grid; its last state is a frame
};

struct RunOptions {
  std::string directory;  ///< where results go
  bool quiet = false;
  bool progress_only = false;  ///< print neither head nor report: the caller does
  Solution solution = Solution::steps;
  std::string threads;                ///< how many, and why, for the screen
  bool resume = false;                ///< continue from the directory's checkpoint, if there is one
  PlacedParticles* placed = nullptr;  ///< where they have been placed already; the run takes them
};

struct RunResult {
  /// exit_done, exit_not_static, or exit_interrupted after SIGINT or SIGTERM with a checkpoint written
  ExitCode code;
  RunFigures figures;  ///< of an interrupted run only the steps and their time
};

/// Throws SetupError before anything is written, Diverged, FileError; NotStatic for a static solution;
/// LeftGrid after the last state and the summary are written.
RunResult run_scene(const Scene& scene, const RunOptions& options);

}  // namespace vsb::app
