// SPDX-License-Identifier: BSD-3-Clause
#include "run/run_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

#include "engine/kokkos_session.hpp"
#include "engine/waiting_threads.hpp"
#include "report/progress.hpp"
#include "report/scene_advice.hpp"
#include "report/traction_watch.hpp"
#include "run/force_decay.hpp"
#include "run/interrupt.hpp"
#include "run/rest_forecast.hpp"
#include "run/run_balance.hpp"
#include "run/run_parts.hpp"
#include "run/run_static.hpp"
#include "run/stages.hpp"

namespace vsb::app {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

constexpr long long health_interval = 100;  // steps between checks for a diverging run

/// The first step after `step` at which something is due: a check, a frame, or the last step.
long long next_stop(const Scene& scene, long long step, long long last) {
  const auto multiple = [&](long long interval) { return (step / interval + 1) * interval; };
  long long stop = std::min(last, multiple(health_interval));
  if (scene.output.every > 0) stop = std::min(stop, multiple(scene.output.every));
  if (scene.time.until_static) stop = std::min(stop, multiple(scene.time.until_static->check_every));
  return stop;
}

/// When another checkpoint is due: a first one after a minute, later ones at longer intervals.
class CheckpointClock {
 public:
  explicit CheckpointClock(double minutes) : minutes_(minutes) {}

  bool due() const { return minutes_ > 0 && seconds_since(last_) > 60 * (any_ ? minutes_ : first()); }
  void written() {
    last_ = Clock::now();
    any_ = true;
  }

 private:
  double first() const { return std::min(1.0, minutes_); }

  double minutes_;
  bool any_ = false;
  Clock::time_point last_ = Clock::now();
};

/// Refuses to go on from a step behind the last one.
void refuse_end_before(const Scene& scene, long long step, long long last) {
  if (step > last)
    throw SetupError(fmt::format("the checkpoint is of step {}, and {} = {} ends the run before it", step,
                                 scene.time.until_static ? "time.until_static.max_steps" : "time.steps",
                                 scene.time.steps));
}

bool is_static(const StaticCriterion& c, const BalanceReport& b) {
  return b.force_ratio <= c.force_ratio && b.energy_ratio <= c.energy_ratio;
}

/// Since when the force ratio stands, and what helps; empty where it does not.
std::string standing_text(const Scene& scene, const std::optional<ForceDecay::Level>& level) {
  if (!level) return "";
  bool may_yield = false, whole = false;
  for (const auto& body : scene.bodies) {
    may_yield = may_yield || is_plastic(body.material.law);
    whole = whole || (body.boundary == BoundaryBoxes::keep && !is_irregular(body));
  }
  return fmt::format(
      ": the force ratio stands at {:.2e} since about step {}, so that more steps will hardly help; what "
      "may: "
      "{}{}a larger time.until_static.force_ratio",
      level->ratio, level->since,
      may_yield || scene.single_precision ? "" : "the static solver (--static), which takes no steps; ",
      whole ? "body.boundary = \"cut\"; " : "");
}

/// Prints the last stage, and after the last of all how they ended.
void print_stage(const Scene& scene, const Stages& stages) {
  const auto& [reports, outcome, reason] = stages.report();
  fmt::print("{}\n",
             stage_text(reports.back(), static_cast<int>(reports.size()), scene.removal->hole.has_value()));
  if (!outcome.empty()) fmt::print("{}: {}\n", outcome, reason);
}

RunResult run(const Scene& scene, const RunOptions& options) {
  const auto simulation = make_simulation(scene, options.placed);
  std::optional<Stages> stages;
  if (scene.removal) stages.emplace(scene, *simulation);
  TractionWatch watch(scene, *simulation);
  const auto last_step = [&] { return (stages ? stages->first_step() : 0) + scene.time.steps; };
  Results results(options.directory, scene);
  results.claim();
  auto& checkpoints = results.checkpoints();
  long long resumed_step = -1;
  if (options.resume) {
    if (const auto saved = checkpoints.read()) {
      simulation->restore(*saved, *checkpoints.read_particles());
      if (stages) stages->restore(saved->staged);
      watch.restore(checkpoints.watched());
      resumed_step = saved->step;
      refuse_end_before(scene, resumed_step, last_step());
    } else if (!options.progress_only) {
      fmt::print(stderr, "vsb: no checkpoint in {}; starting from step 0\n", options.directory);
    }
  }
  const InterruptGuard guard;  // from the first file on
  results.begin(resumed_step, !options.progress_only);
  const bool reports = !options.quiet && !options.progress_only;
  if (!options.progress_only) {
    print_advice(scene, *simulation);
    print_warnings(short_run_advice(scene));
  }
  if (reports) {
    fmt::print("{}: {} particles, {} boundary nodes, dt {:.6g} s, {} {} steps, results in {}\n", scene.name,
               simulation->particle_count(), simulation->boundary_nodes(), scene.time.dt,
               scene.time.until_static ? "at most" : "exactly", scene.time.steps, options.directory);
    if (!options.threads.empty()) fmt::print("{}\n", options.threads);
    if (resumed_step >= 0) fmt::print("resumed at step {}\n", resumed_step);
    std::fflush(stdout);  // who reads a pipe sees that the run has begun
  }
  long long framed_step = -1;
  const auto write_frame = [&] {
    write_frames(results, scene, *simulation);
    framed_step = simulation->step();
  };
  if (resumed_step < 0) write_frame();

  Progress progress(options.quiet, simulation->particle_count());
  const auto& criterion = scene.time.until_static;
  ForceDecay decay;
  const long long first_step = simulation->step();
  const double settled = loads_settled_at(scene);
  RunFigures figures;
  CheckpointClock clock(scene.output.checkpoint_minutes);
  bool found_static = false, diverged = false, done = false;
  std::optional<LeftGrid> left;
  double seconds_before_stage = 0;
  const auto stage_seconds = [&] { return figures.seconds - seconds_before_stage; };
  const auto write_checkpoint = [&] {
    auto saved = simulation->saved_state();
    if (stages) saved = stages->with_stages(std::move(saved), stage_seconds());
    checkpoints.write(saved, watch.saved(), *simulation);
    clock.written();
  };
  const auto expected_end = [&]() -> ExpectedEnd {
    if (!criterion) return {scene.time.steps, ExpectedEnd::known};
    const auto end = decay.reaches(criterion->force_ratio);
    if (end && *end <= last_step()) return {*end, ExpectedEnd::foreseen};
    return {last_step(), decay.stands() ? ExpectedEnd::not_foreseen : ExpectedEnd::at_most};
  };
  // Whether the run, or its stage, is over at this step; called where checks are due.
  const auto ends_here = [&] {
    const long long step = simulation->step();
    bool failed = false;
    if (criterion && step % criterion->check_every == 0) {
      const bool constant_loads = simulation->load_time() >= settled;
      if (constant_loads) {
        const auto balance = simulation->balance();
        found_static = is_static(*criterion, balance);
        decay.observe(step, balance.force_ratio);
      }
      if (stages) {
        const auto signs = stages->look(constant_loads);
        found_static = found_static || signs == Stages::Signs::settled;
        failed = signs == Stages::Signs::failed;
      }
    }
    return found_static || failed || step >= last_step();
  };
  const auto tell = [&](const std::vector<std::string>& losses) {
    if (!losses.empty()) progress.finish();
    if (!options.progress_only) print_warnings(losses);
  };
  // Ends a stage of a run that removes particles, and sets out on the next one.
  const auto end_stage = [&] {
    simulation->check_health();
    write_frames(results, scene, *simulation);
    const double force_ratio = simulation->balance().force_ratio;
    const bool another = stages->end(found_static, force_ratio, stage_seconds());
    progress.finish();
    if (reports) print_stage(scene, *stages);
    if (!another) return true;
    seconds_before_stage = figures.seconds;
    found_static = false;
    decay = ForceDecay();
    tell(watch.begin());
    write_checkpoint();
    return false;
  };
  double processor = 0;
  bool threads_looked_at = false;
  const auto look_at_threads = [&] {
    const auto waiting = waiting_threads(threads_at_hand(), processor, figures.seconds);
    if (waiting.empty()) return;
    progress.finish();
    if (reports) fmt::print("{}\n", waiting);
  };
  try {
    // A run that was over may go on if its end has changed since; one that was interrupted was not over.
    if (resumed_step >= 0 && !(stages && resumed_step == stages->first_step())) done = ends_here();
    if (done && stages) done = end_stage();
    while (!done) {
      const auto begin = Clock::now();
      const double processor_before = processor_seconds();
      const long long stop = next_stop(scene, simulation->step(), last_step());
      while (simulation->step() < stop && !interrupt_requested()) {
        const auto steps = std::min<long long>(stop - simulation->step(),
                                               std::max(1, 100'000 / simulation->particle_count()));
        simulation->advance(steps);
        figures.particle_steps += static_cast<double>(steps) * simulation->particle_count();
      }
      figures.seconds += seconds_since(begin);
      processor += processor_seconds() - processor_before;
      if (!threads_looked_at && figures.seconds >= seconds_to_look_at_threads) {
        threads_looked_at = true;
        look_at_threads();
      }
      const long long step = simulation->step();
      if (step % health_interval == 0 || interrupt_requested()) simulation->check_health();
      if (step % health_interval == 0 || step >= last_step()) tell(watch.look());
      done = ends_here();
      if (scene.output.every > 0 && step % scene.output.every == 0) write_frame();
      if (!done && clock.due()) {
        simulation->check_health();
        write_checkpoint();
      }
      if (progress.due())
        progress.report(step, step - first_step, figures.seconds, expected_end(),
                        simulation->balance().force_ratio);
      if (done && stages) done = end_stage();
      // What is due at this step has been done by now: the run that goes on begins with the next one.
      if (!done && interrupt_requested()) {
        progress.finish();
        write_checkpoint();
        if (!options.progress_only) {
          fmt::print("interrupted at step {}; the same command with --resume (and the same --set) goes on\n",
                     step);
        }
        figures.steps = step;
        figures.steps_timed = step - first_step;
        return {exit_interrupted, figures};
      }
    }
    simulation->check_health();
    if (found_static && !stages) tell(watch.look(true));
    figures.balance = simulation->balance();
  } catch (const Diverged& error) {
    if (!stages || !stages->end_diverged(error.what(), stage_seconds())) throw;
    diverged = true;
    progress.finish();
    if (reports) print_stage(scene, *stages);
  } catch (const LeftGrid& error) {
    progress.finish();
    if (stages && stages->end_diverged(error.what(), stage_seconds())) {
      diverged = true;
      if (reports) print_stage(scene, *stages);
    } else {
      left = error;
      if (reports && left->all) fmt::print("{}; the run ends here\n", left->what());
    }
  }
  if (left) figures.balance = simulation->balance();
  progress.report(simulation->step(), simulation->step() - first_step, figures.seconds,
                  {simulation->step(), ExpectedEnd::known}, figures.balance.force_ratio);
  progress.finish();

  figures.steps = simulation->step();
  figures.steps_timed = simulation->step() - first_step;
  figures.found_static = found_static;
  figures.tractions = watch.report();
  if (stages) figures.stages = stages->report();
  if (!diverged) {
    if (left || (!stages && framed_step != simulation->step())) write_frame();
    take_state(figures, scene, *simulation);
  } else {
    figures.particles = simulation->particle_count();
    figures.volumes = simulation->body_volumes();
  }
  if (left && left->all) figures.particles = 0;
  if (left && left->all) figures.mass = 0;
  figures.left_grid = left ? left->what() : "";
  if (found_static && !stages && !options.progress_only)
    print_warnings(crossing_advice(scene, figures.state.largest_displacement));
  results.write_summary(summary_json(scene, figures));
  if (left && !left->all)
    throw LeftGrid(fmt::format("{}; the last frame is the state of this step", left->what()), false);
  if (options.progress_only)
    checkpoints.remove();  // a study has done with the case
  else if (!diverged && !left && !(figures.steps == resumed_step && checkpoints.last_is_whole()))
    write_checkpoint();
  if (reports) print_report(scene, figures);
  if (left) return {exit_done, figures};
  if (!scene.time.until_static || found_static || stages) return {exit_done, figures};
  if (!options.progress_only)
    fmt::print(stderr, "vsb: not static after max_steps = {} (force ratio {:.2e}, energy ratio {:.2e}){}\n",
               scene.time.steps, figures.balance.force_ratio, figures.balance.energy_ratio,
               standing_text(scene, decay.stands()));
  return {exit_not_static, figures};
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

RunResult run_scene(const Scene& scene, const RunOptions& options) {
  try {
    switch (options.solution) {
      case Solution::static_state:
        return run_static(scene, options);
      case Solution::balance:
        return run_balance(scene, options);
      case Solution::steps:
        break;
    }
    return run(scene, options);
  } catch (const Diverged& error) {
    const auto hint = units_hint(scene);
    if (hint.empty()) throw;
    throw Diverged(fmt::format("{}; {}", error.what(), hint));
  }
}

void check_scene(const Scene& scene, PlacedParticles* placed) {
  const auto simulation = make_simulation(scene, placed);
  print_advice(scene, *simulation);
  print_warnings(short_run_advice(scene));
  fmt::print("# {} particles, {} boundary nodes, {:.3g} MB of state\n", simulation->particle_count(),
             simulation->boundary_nodes(), static_cast<double>(simulation->state_bytes()) / 1e6);
  const auto reason = simulation->particle_kernels_because();
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
  // The rate is measured: a few steps of the scene itself, the first one (which sorts) left out. Not more
  // than a hundred: what a scene does in the long run, such as fly away, is not the question here.
  const double extent = longest_extent(*simulation);
  const int particles = simulation->particle_count();
  simulation->advance(1);
  const auto begin = Clock::now();
  long long made = 0;
  do {
    simulation->advance(1);
    ++made;
  } while (made < 100 && seconds_since(begin) < 0.2);
  const double per_step = seconds_since(begin) / static_cast<double>(made);
  fmt::print("# {:.3g} s per 1000 steps ({:.3g} ns per particle and step)\n", 1000 * per_step,
             1e9 * per_step / particles);
  print_end(scene, extent, per_step);
  fmt::print("\n{}", scene.resolved);
}

}  // namespace vsb::app
