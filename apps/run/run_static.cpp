// SPDX-License-Identifier: BSD-3-Clause
#include "run/run_static.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "report/progress.hpp"
#include "report/static_advice.hpp"
#include "report/traction_watch.hpp"
#include "run/interrupt.hpp"
#include "run/run_parts.hpp"

namespace vsb::app {

namespace {

/// Refuses what only an explicit run can do.
void refuse_moving_scenes(const Scene& scene) {
  const auto refuse = [](const std::string& why, const std::string& where = {}) {
    throw SetupError(where, "--static: " + why);
  };
  if (scene.single_precision) refuse("needs precision = \"double\"");
  refuse_unsettled_loads(scene, "--static");
  for (const auto& body : scene.bodies)
    if (is_plastic(body.material.law))
      refuse(
          fmt::format(
              "body '{}' may yield (its material.law), and a static solution is that of elastic bodies; run "
              "without --static, with time.until_static",
              body.name),
          body.where);
  for (const auto& body : scene.bodies)
    if (body.velocity.value != Point{} || body.velocity.gradient != std::array<Point, 3>{})
      refuse(
          fmt::format("body '{}' has an initial velocity, of which a static state knows nothing", body.name),
          body.where);
}

}  // namespace

RunResult run_static(const Scene& scene, const RunOptions& options) {
  using Clock = std::chrono::steady_clock;
  refuse_moving_scenes(scene);
  const auto simulation = make_simulation(scene, options.placed);
  if (const auto idle = idle_tractions(scene, simulation->traction_states()); !idle.empty())
    throw SetupError("--static: the solution would be without a load of the scene: " + idle);
  Results results(options.directory, scene);
  const InterruptGuard guard;
  const bool reports = !options.quiet && !options.progress_only;
  Scene without_steps = scene;
  without_steps.time.until_static.reset();  // what the way there would need is of no concern here
  if (!options.progress_only) print_advice(without_steps, *simulation);
  if (reports)
    fmt::print(
        "{}: {} particles, {} boundary nodes, static solution under the loads at {:.6g} s, results in {}\n",
        scene.name, simulation->particle_count(), simulation->boundary_nodes(), loads_settled_at(scene),
        options.directory);
  if (reports && !options.threads.empty()) fmt::print("{}\n", options.threads);

  Progress progress(options.quiet, simulation->particle_count());
  RunFigures figures;
  figures.solution = Solution::static_state;
  const auto begin = Clock::now();
  const auto solution =
      simulation->solve_static(loads_settled_at(scene), [&](int iteration, double residual) {
        if (progress.due()) progress.report_iteration(iteration, residual);
        return !(residual > regular_residual) && !interrupt_requested();
      });
  figures.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  figures.iterations = solution.iterations;
  progress.report_iteration(solution.iterations, solution.residual);
  progress.finish();
  if (!solution.converged && interrupt_requested()) {
    if (!options.progress_only)
      fmt::print("interrupted at iteration {}; a static solution begins anew\n", solution.iterations);
    return {exit_interrupted, figures};
  }
  if (solution.residual > regular_residual)
    throw NotStatic(fmt::format(
        "no static state: some motion strains no particle, and the loads drive it (the relative residual has "
        "grown to {:.2g} by iteration {}): too few particles hold their cells' shape (2 per cell and "
        "direction at least, and 3 across a body of one cell with B-splines)",
        solution.residual, solution.iterations));
  if (!solution.converged)
    throw NotStatic(fmt::format(
        "not static after {} iterations of at most {} (relative residual {:.2e}, wanted {:.2e}): raise "
        "static.max_iterations; or the particles are too few to hold their cells' shape (2 per cell and "
        "direction at least)",
        solution.iterations, scene.static_solution.max_iterations, solution.residual,
        scene.static_solution.residual));
  if (!options.progress_only)
    print_warnings(static_advice(scene, *simulation->read_particles(), solution.largest_strain));

  results.begin(-1, !options.progress_only);
  write_frames(results, scene, *simulation);
  figures.found_static = true;
  figures.balance = solution.balance;
  take_state(figures, scene, *simulation);
  results.write_summary(summary_json(scene, figures));
  if (reports) print_report(scene, figures);
  return {exit_done, figures};
}

}  // namespace vsb::app
