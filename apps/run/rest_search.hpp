// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The search of a run for a static state (time.until_static): when it looks, whether the state is static,
/// and when it will be.
#pragma once

#include <string>

#include "engine/simulation.hpp"
#include "report/progress.hpp"
#include "run/force_decay.hpp"

namespace vsb::app {

class RestSearch {
 public:
  explicit RestSearch(const Scene& scene);

  /// Whether the run looks for a static state at this step; never, where the scene wants none.
  bool due(long long step) const;
  /// A state is static only under loads that have become constant.
  bool loads_are_constant(const Simulation& simulation) const;
  /// Whether the present state is static; call it at steps that are due, under constant loads.
  bool is_static(Simulation& simulation);
  /// Forgets the force ratios seen so far.
  void begin_anew() { decay_ = ForceDecay(); }

  /// Where the run will end, whose last step is `last`.
  ExpectedEnd expected_end(long long last) const;
  /// Since when the force ratio does not fall, and what helps; empty where it falls.
  std::string standing_text() const;

 private:
  const Scene& scene_;
  double settled_;  ///< the time from which on the loads are constant, s
  ForceDecay decay_;
};

}  // namespace vsb::app
