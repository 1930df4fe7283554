// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Watches whether the tractions on boundary nodes still act as they did at the start: their resultants, and
/// the cells at the boundary that they load, both at full load, so that time functions are no matter.
#pragma once

#include <string>
#include <vector>

#include "engine/simulation.hpp"

namespace vsb::app {

/// What became of a traction.
struct TractionReport {
  std::string name;
  Point force_at_start{}, force{};  ///< resultants at full load, at the start and when last looked at, N
  int part_cells_at_start = 0, part_cells = 0;  ///< loaded in part; see kernels/readout/loaded_cells.hpp
  long long lost_at = -1;                       ///< the step at which a loss was seen; -1: none was
  std::string loss;                             ///< a sentence on it; empty without one
};

class TractionWatch {
 public:
  /// The present state of the simulation counts as the start.
  TractionWatch(const Scene& scene, Simulation& simulation);

  /// Makes the present state the start, and forgets nothing that was reported. Returns what look() does, of
  /// what was lost since the start before, as particles were removed.
  std::vector<std::string> begin();
  /// All that it has seen, as TOML.
  std::string saved() const;
  /// Goes on from there. Throws SetupError where that does not fit this scene.
  void restore(const std::string& saved);
  /// A sentence for each traction of which a loss is seen for the first time. at_rest: nothing moves any
  /// more, so that a resultant tells by itself.
  std::vector<std::string> look(bool at_rest = false);
  const std::vector<TractionReport>& report() const { return reports_; }

 private:
  std::string loss_of(const TractionState& now, const TractionState& start, bool at_rest) const;

  const Scene& scene_;
  Simulation& simulation_;
  std::vector<TractionState> start_;
  std::vector<TractionReport> reports_;
};

/// A sentence for each traction whose resultant at the start is not that of the surface where it is declared:
/// its region ends beside an edge of a body, or within one.
std::vector<std::string> resultant_advice(const Scene& scene, Simulation& simulation);

/// The tractions of which nothing acts, though the scene has them act in the end, in words; empty where there
/// is none. states: of the state that is to be judged.
std::string idle_tractions(const Scene& scene, const std::vector<TractionState>& states);

}  // namespace vsb::app
