// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What a study knows of a case between two calls: a small TOML file, case.toml, in the case's directory.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "report/solution.hpp"
#include "scene/scene.hpp"

namespace vsb::app {

struct CaseRecord {
  enum class State {
    running,   ///< begun; there may be a checkpoint
    finished,  ///< with figures
    failed     ///< refused or diverged; the message says why
  };
  State state = State::running;
  std::string message;
  int particles = 0;
  double seconds = 0;         ///< wall time of the steps that were timed
  long long steps_timed = 0;  ///< fewer than all where a run was killed and continued
  double end_time = 0;        ///< physical time at the end, s
  long long steps = 0;
  long long iterations = 0;  ///< of a static solution, each about as dear as a step
  std::string state_hash;
  std::vector<std::pair<std::string, double>> figures;

  std::optional<double> figure(const std::string& name) const;
  double particle_steps() const {
    return static_cast<double>(particles) * static_cast<double>(steps + iterations);
  }
  double ns_per_particle_step() const;
  /// Of the whole run, from the time per step of what was timed.
  double total_seconds() const { return 1e-9 * ns_per_particle_step() * particle_steps(); }
};

/// What a record is of: the scene with all defaults, and what is done with it.
std::string record_subject(const Scene& scene, Solution solution);

/// The record in a directory; none where there is none, it is damaged, or it is of another subject or another
/// version of the program.
std::optional<CaseRecord> read_case_record(const std::string& directory, const std::string& subject);

/// Throws FileError.
void write_case_record(const std::string& directory, const std::string& subject, const CaseRecord& record);

}  // namespace vsb::app
