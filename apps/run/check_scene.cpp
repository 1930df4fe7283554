// SPDX-License-Identifier: BSD-3-Clause
#include "run/check_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "report/progress.hpp"
#include "report/scene_advice.hpp"
#include "run/rest_forecast.hpp"
#include "run/run_parts.hpp"

namespace vsb::app {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Steps of the scene itself.
struct TrialSteps {
  long long steps = 0;  ///< those that were timed
  double per_step = 0;  ///< s
  std::string end;      ///< why there were no more, where the run itself would end there
};
/// The first one, which sorts, is not timed. Not more than a hundred: what a scene does in the long run, such
/// as fly away, is not the question here.
TrialSteps make_trial_steps(Simulation& simulation) {
  TrialSteps trial;
  const auto ends = [&](const std::string& why, const std::string& how) {
    trial.end = why;
    print_warnings({fmt::format("{}: the run ends there, {}", why, how)});
  };
  auto begin = Clock::now();
  try {
    simulation.advance(1);
    begin = Clock::now();
    do {
      simulation.advance(1);
      ++trial.steps;
    } while (trial.steps < 100 && seconds_since(begin) < 0.2);
  } catch (const LeftGrid& error) {
    ends(error.what(), error.all ? "without a particle" : "with exit code 8");
  } catch (const Diverged& error) {
    ends(fmt::format("diverged {}", error.what()), "with exit code 3");
  }
  if (trial.steps > 0) trial.per_step = seconds_since(begin) / static_cast<double>(trial.steps);
  return trial;
}

/// Of all particles together, along an axis.
double longest_extent(Simulation& simulation) {
  Point low, high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  simulation.read_particles()->for_each_range(field::position, [&](const Snapshot& s) {
    for (size_t i = 0; i < s.position.size(); ++i) {
      low[i % 3] = std::min(low[i % 3], s.position[i]);
      high[i % 3] = std::max(high[i % 3], s.position[i]);
    }
  });
  double extent = 0;
  for (size_t i = 0; i < 3; ++i) extent = std::max(extent, high[i] - low[i]);
  return extent;
}

/// What can be known of the end of a run that takes `per_step` s a step.
void print_end(const Scene& scene, double extent, double per_step) {
  const auto wall = [&](double steps) {
    const double s = steps * per_step;
    return s < 10 ? fmt::format("{:.2g} s", s) : duration_text(s);
  };
  const auto steps = static_cast<double>(scene.time.steps);
  if (!scene.time.until_static) {
    fmt::print("# estimated time {}\n", wall(steps));
    return;
  }
  const double loaded = std::ceil(loads_settled_at(scene) / scene.time.dt);
  const char* whose = scene.removal ? "every stage" : "the run";
  fmt::print("# estimated time {} to step {:.0f}, from which on the loads are constant\n", wall(loaded),
             loaded);
  const auto rest = forecast_rest(scene, extent, loaded);
  if (loaded >= steps || (rest && rest->earliest >= steps))
    fmt::print("# rest is not expected by step {}: {}\n", scene.time.steps,
               loaded >= steps
                   ? "the loads are not constant before"
                   : fmt::format("from step {:.2g} on at the earliest, by method.damping", rest->earliest));
  else if (rest)
    fmt::print(
        "# rest is expected from step {:.2g} to {:.2g} ({} to {}), by method.damping and the vibrations of a "
        "compact body of {:.3g} m; slender ones take longer\n",
        rest->earliest, std::min(rest->latest, steps), wall(rest->earliest),
        wall(std::min(rest->latest, steps)), extent);
  else
    fmt::print("# when it comes to rest cannot be known: method.damping = 0\n");
  fmt::print("# time.until_static.max_steps = {} ends {} in any case ({})\n", scene.time.steps, whose,
             wall(steps));
}

}  // namespace

void check_scene(const Scene& scene, PlacedParticles* placed) {
  const auto simulation = make_simulation(scene, placed);
  print_advice(scene, *simulation);
  print_warnings(short_run_advice(scene));
  fmt::print("# {} particles, {} boundary nodes, {:.3g} MB of state\n", simulation->particle_count(),
             simulation->boundary_nodes(), static_cast<double>(simulation->state_bytes()) / 1e6);
  const auto reason = simulation->why_not_lanes();
  fmt::print("# steps on {}\n", reason.empty() ? "cell lanes" : "particle kernels: " + reason);
  print_body_volumes(scene, simulation->body_volumes(), "# ");
  print_cut_volume(simulation->cut_volume(), "# ");
  print_moment_fit(scene, simulation->moment_fit(), "# ");
  const double settled = loads_settled_at(scene);
  fmt::print("# dt = {:.6g} s (kappa {:.4g}), {} {} steps, loads {}\n", scene.time.dt, scene.time.kappa,
             scene.time.until_static ? "at most" : "exactly", scene.time.steps,
             std::isfinite(settled) ? fmt::format("constant from {:.6g} s on", settled) : "never constant");
  const double loaded = std::isfinite(settled) ? settled : 0.0;
  if (!scene.tractions.empty()) fmt::print("# initial state under the loads at {:.6g} s:\n", loaded);
  print_resultant(scene, simulation->balance_under_loads_at(loaded), "#   ");
  const double extent = longest_extent(*simulation);
  const int particles = simulation->particle_count();
  const auto trial = make_trial_steps(*simulation);
  if (trial.steps > 0)
    fmt::print("# {:.3g} s per 1000 steps ({:.3g} ns per particle and step)\n", 1000 * trial.per_step,
               1e9 * trial.per_step / particles);
  if (trial.end.empty())
    print_end(scene, extent, trial.per_step);
  else
    fmt::print("# the run ends early: {}\n", trial.end);
  fmt::print("\n{}", scene.resolved);
}

}  // namespace vsb::app
