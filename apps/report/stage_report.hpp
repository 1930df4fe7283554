// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What is told of failure in stages (run/stages.hpp), in numbers and in words.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/failed_zone.hpp"

namespace vsb::app {

/// One pass of Algorithm 2.
struct StageReport {
  long long first_step = 0, last_step = 0;
  bool at_rest = false;
  double force_ratio = 0;
  int particles = 0;     ///< at its begin
  int failed = 0;        ///< beyond the threshold at its end
  bool removed = false;  ///< whether these were then removed
  double largest = 0;    ///< of the measure
  double yielded = 0;    ///< m^3, volume of the particles with a plastic strain
  double seconds = 0;    ///< wall time of its steps
  FailedZone zone;       ///< zeros where the scene does not say where the hole is

  double share() const { return particles > 0 ? static_cast<double>(failed) / particles : 0; }
};

/// All stages of a run so far.
struct StagesReport {
  std::vector<StageReport> stages;
  std::string outcome;  ///< "steady", "collapse", or "max_stages"; empty before the end
  std::string reason;   ///< of the outcome, a sentence
};

/// As a TOML document, and back: every number with all its bits.
std::string to_toml(const StagesReport& report);
StagesReport stages_of_toml(const std::string& text);

/// A line about a stage.
std::string stage_text(const StageReport& stage, int number, bool with_hole);

/// The figures by name, NaN for stages up to `max_stages` that were not reached.
std::vector<std::pair<std::string, double>> stage_figures(const StagesReport& report, int max_stages,
                                                          bool with_hole);

}  // namespace vsb::app
