// SPDX-License-Identifier: BSD-3-Clause
#include "run/run_balance.hpp"

#include "run/run_parts.hpp"

namespace vsb::app {

RunResult run_balance(const Scene& scene, const RunOptions& options) {
  refuse_unsettled_loads(scene, "a balance under the final loads");
  const auto simulation = make_simulation(scene, options.placed);
  Results results(options.directory, scene);
  results.begin(-1, !options.progress_only);
  RunFigures figures;
  figures.solution = Solution::balance;
  const double settled = loads_settled_at(scene);
  figures.balance = simulation->balance_under_loads_at(settled);
  figures.share = resultant_share(scene, figures.balance, *simulation->read_particles(), settled);
  take_state(figures, scene, *simulation);
  results.write_summary(summary_json(scene, figures));
  return {exit_done, figures};
}

}  // namespace vsb::app
