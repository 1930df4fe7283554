// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Runs a study: every case that is not done yet, then the verdicts, the table and the pictures.
#pragma once

#include <string>

#include "study/run_case.hpp"
#include "study/study.hpp"

namespace vsb::app {

struct StudyOptions {
  std::string directory;
  bool quiet = false;  ///< print failing lines only
  SceneRunner run;     ///< of a case
};

/// Returns exit_done, exit_study_failed where an expectation is not met, or exit_interrupted: the next call
/// goes on from there. Throws FileError.
ExitCode run_study(const Study& study, const StudyOptions& options);

}  // namespace vsb::app
