// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The figures of a finished run, for summary.json and for the terminal.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/simulation.hpp"
#include "report/resultant_share.hpp"
#include "report/solution.hpp"
#include "report/stage_report.hpp"
#include "report/state_figures.hpp"
#include "report/traction_watch.hpp"

namespace vsb::app {

struct RunFigures {
  long long steps = 0;        ///< step number at the end
  long long steps_timed = 0;  ///< steps made by this program, fewer after a resume
  double seconds = 0;         ///< wall time of those steps alone
  double particle_steps = 0;  ///< sum over those steps of the particles there were
  Solution solution = Solution::steps;
  int iterations = 0;  ///< of a static solution
  bool found_static = false;
  int particles = 0, boundary_nodes = 0;
  size_t state_bytes = 0;
  std::vector<BodyVolume> volumes;  ///< of the bodies at the start
  CutVolume cut;
  MomentFit moment_fit;
  VoidFilterReport void_filter;
  BalanceReport balance;
  StateFigures state;
  double growth_rate = StateFigures::none;  ///< of scene.growth, 1/s
  std::vector<TractionReport> tractions;    ///< those on boundary nodes, of an explicit run
  ResultantShare share;                     ///< of a balance alone
  StagesReport stages;                      ///< where particles are removed in stages
  OutflowReport outflow;
  double mass = 0;         ///< of the particles at the end, kg
  std::string left_grid;   ///< how a healthy body left the grid, which ended the run
  std::string state_hash;  ///< of the particles' bits at the end
  std::vector<std::pair<std::string, double>> errors;
  std::vector<std::pair<std::string, double>> compared;  ///< figures of the comparison that are no errors

  /// Of a static solution: per particle and iteration.
  double ns_per_particle_step() const;
};

/// The figures that depend on the scene alone, by name: errors, counts, balance; what a study can expect.
std::vector<std::pair<std::string, double>> named_figures(const Scene& scene, const RunFigures& figures);
/// The names that named_figures will give for the scene.
std::vector<std::string> figure_names(const Scene& scene, Solution solution);
/// Those that a study shows where a scene has no exact solution to be compared with.
std::vector<std::string> default_figures(const Scene& scene, Solution solution);
/// Whether a figure is a count, or says how a run went: nothing that converges as a grid is refined.
bool is_count(const std::string& figure);

/// Errors, counts, times, resultant, memory and provenance as JSON. What is not finite is left out, named by
/// `not_finite`, and warned of.
std::string summary_json(const Scene& scene, const RunFigures& figures);

/// Volumes of bodies with cut lattices, in a line that begins with `prefix`; nothing where there are none.
void print_cut_volume(const CutVolume& volume, const std::string& prefix);

/// What the fit of moments did, in the same way.
void print_moment_fit(const Scene& scene, const MomentFit& fit, const std::string& prefix);

/// Resultant and torque of the tractions beside the exact ones, in lines that begin with `prefix`.
void print_resultant(const Scene& scene, const BalanceReport& balance, const std::string& prefix);

/// The same for people: errors beside the published ones, then cost.
void print_report(const Scene& scene, const RunFigures& figures);

/// How far a ratio lies above 1, in percent for two decimals: what rounds to zero has no sign left.
double percent_above(double ratio);

}  // namespace vsb::app
