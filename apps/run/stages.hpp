// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Failure in stages, Algorithm 2: 1. equilibrium of the body as it is; 2. which particles are beyond the
/// threshold; 3. they are removed; and again, until nothing fails or the body collapses.
#pragma once

#include "engine/simulation.hpp"
#include "report/stage_report.hpp"

namespace vsb::app {

class Stages {
 public:
  /// The scene must have a table 'removal'.
  Stages(const Scene& scene, Simulation& simulation);

  /// The stages of a run that is resumed.
  void restore(const StagedState& saved);
  /// For a checkpoint: `saved` with the stages entered, of which the present one has taken `seconds`.
  SavedState with_stages(SavedState saved, double seconds) const;

  /// The number of the present stage, from 1, and its first step.
  int number() const { return static_cast<int>(report_.stages.size()) + 1; }
  long long first_step() const { return first_step_; }

  /// What the particles tell on the way.
  enum class Signs {
    none,
    settled,  ///< hardly another particle has failed for a while, under loads that stay the same
    failed    ///< the body has collapsed
  };
  Signs look(bool constant_loads);
  /// Ends the stage, which has taken `seconds`, and removes what failed. Whether another stage begins.
  bool end(bool at_rest, double force_ratio, double seconds);
  /// Ends the last stage of a run that diverged. False where it has not collapsed: fewer than half of the
  /// particles had failed when they were last looked at.
  bool end_diverged(const std::string& message, double seconds);

  const StagesReport& report() const { return report_; }

 private:
  StageReport present_stage(double seconds) const;
  /// Why the body with these failed particles has collapsed; empty where it has not.
  std::string collapse_of(const std::vector<unsigned char>& failed) const;
  FailedZone zone_of(const std::vector<unsigned char>& failed) const;

  const Scene& scene_;
  const RemovalSpec& removal_;
  Simulation& simulation_;
  std::vector<unsigned char> present_;  ///< [particle at the start]
  long long first_step_ = 0;
  double seconds_before_ = 0;           ///< of the present stage, before a resume
  int last_count_ = 0;                  ///< failed particles when they were last looked at
  std::vector<unsigned char> settled_;  ///< the failed ones of step settled_step_, and still but for a few
  long long settled_step_ = 0;
  StagesReport report_;
};

}  // namespace vsb::app
