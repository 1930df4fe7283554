// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// One case of a study, in a process of its own: it takes as many threads as it can use, which Kokkos settles
/// once per process, and a crash ends the case alone.
#pragma once

#include <functional>

#include "run/run_scene.hpp"
#include "study/case_record.hpp"

namespace vsb::app {

/// Starts Kokkos and runs the scene; called in the case's process.
using SceneRunner = std::function<RunResult(const Scene&, const RunOptions&)>;

struct CaseResult {
  ExitCode
      code;  ///< exit_done also for a scene that is refused or diverges; else exit_interrupted or exit_files
  CaseRecord record;  ///< as written to the case's directory
};

/// Runs the scene, from its checkpoint where `options` say so. `record` is what is known of the case so far.
/// Signals go on to the case's process.
CaseResult run_case(const Scene& scene, const RunOptions& options, const CaseRecord& record,
                    const SceneRunner& run);

}  // namespace vsb::app
