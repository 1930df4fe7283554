// SPDX-License-Identifier: BSD-3-Clause
#include "run/time_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "report/scene_advice.hpp"
#include "run/growth.hpp"
#include "run/interrupt.hpp"
#include "run/run_parts.hpp"

namespace vsb::app {

namespace {

constexpr long long health_interval = 100;  // steps between checks for a diverging run

/// The first step after `step` at which something is due: a check, a frame, or the last step.
long long next_stop(const Scene& scene, long long step, long long last) {
  const auto multiple = [&](long long interval) { return (step / interval + 1) * interval; };
  long long stop = std::min(last, multiple(health_interval));
  if (scene.output.every > 0) stop = std::min(stop, multiple(scene.output.every));
  if (scene.time.until_static) stop = std::min(stop, multiple(scene.time.until_static->check_every));
  return stop;
}

}  // namespace

TimeLoop::TimeLoop(const Scene& scene, const RunOptions& options, RunState& state)
    : scene_(scene),
      options_(options),
      state_(state),
      simulation_(*state.simulation),
      reports_(!options.quiet && !options.progress_only),
      first_step_(simulation_.step()),
      progress_(options.quiet, simulation_.particle_count()),
      rest_(scene),
      clock_(scene.output.checkpoint_minutes) {}

RunResult TimeLoop::run() {
  begin();
  try {
    bool over = over_when_resumed();
    while (!over) {
      advance();
      over = look();
      if (!over && interrupt_requested()) return interrupted();
    }
    conclude();
  } catch (const Diverged& error) {
    if (!collapsed(error.what())) throw;
  } catch (const LeftGrid& error) {
    left_grid(error);
  }
  return end();
}

void TimeLoop::begin() {
  const long long resumed = state_.resumed_step();
  state_.results.begin(resumed, !options_.progress_only);
  if (!options_.progress_only) {
    print_advice(scene_, simulation_);
    print_warnings(short_run_advice(scene_));
  }
  if (reports_) {
    fmt::print("{}: {} particles, {} boundary nodes, dt {:.6g} s, {} {} steps, results in {}\n", scene_.name,
               simulation_.particle_count(), simulation_.boundary_nodes(), scene_.time.dt,
               scene_.time.until_static ? "at most" : "exactly", scene_.time.steps, options_.directory);
    if (!options_.threads.empty()) fmt::print("{}\n", options_.threads);
    if (resumed >= 0) fmt::print("resumed at step {}\n", resumed);
    std::fflush(stdout);  // who reads a pipe sees that the run has begun
  }
  if (resumed < 0) state_.write_frame();
}

bool TimeLoop::over_when_resumed() {
  if (state_.resumed_step() < 0 || state_.resumed_between_stages() || !ends_here()) return false;
  return !state_.stages || end_stage();
}

void TimeLoop::advance() {
  timer_.time([&] {
    const long long stop = next_stop(scene_, simulation_.step(), state_.last_step());
    while (simulation_.step() < stop && !interrupt_requested()) {
      const auto steps =
          std::min<long long>(stop - simulation_.step(), std::max(1, 100'000 / simulation_.particle_count()));
      simulation_.advance(steps);
      figures_.particle_steps += static_cast<double>(steps) * simulation_.particle_count();
    }
  });
}

bool TimeLoop::look() {
  if (const auto waiting = timer_.waiting_threads_once(); !waiting.empty()) {
    progress_.finish();
    if (reports_) fmt::print("{}\n", waiting);
  }
  const long long step = simulation_.step();
  const bool health_due = step % health_interval == 0;
  if (health_due || interrupt_requested()) simulation_.check_health();
  if (health_due || step >= state_.last_step()) tell(state_.watch.look());
  const bool over = ends_here();
  if (scene_.output.every > 0 && step % scene_.output.every == 0) state_.write_frame();
  if (!over && clock_.due()) {
    simulation_.check_health();
    write_checkpoint();
  }
  if (progress_.due())
    progress_.report(step, steps_made(), timer_.seconds(), rest_.expected_end(state_.last_step()),
                     simulation_.balance().force_ratio);
  return over && (!state_.stages || end_stage());
}

bool TimeLoop::ends_here() {
  const long long step = simulation_.step();
  bool failed = false;
  if (rest_.due(step)) {
    const bool constant_loads = rest_.loads_are_constant(simulation_);
    if (constant_loads) found_static_ = rest_.is_static(simulation_);
    if (state_.stages) {
      const auto signs = state_.stages->look(constant_loads);
      found_static_ = found_static_ || signs == Stages::Signs::settled;
      failed = signs == Stages::Signs::failed;
    }
  }
  return found_static_ || failed || step >= state_.last_step();
}

bool TimeLoop::end_stage() {
  simulation_.check_health();
  write_frames(state_.results, scene_, simulation_);
  const double force_ratio = simulation_.balance().force_ratio;
  const bool another = state_.stages->end(found_static_, force_ratio, timer_.stage_seconds());
  print_stage();
  if (!another) return true;
  timer_.begin_stage();
  found_static_ = false;
  rest_.begin_anew();
  tell(state_.watch.begin());
  write_checkpoint();
  return false;
}

void TimeLoop::write_checkpoint() {
  state_.write_checkpoint(timer_.stage_seconds());
  clock_.written();
}

RunResult TimeLoop::interrupted() {
  // What is due at this step has been done by now: the run that goes on begins with the next one.
  progress_.finish();
  write_checkpoint();
  count_steps();
  if (!options_.progress_only)
    fmt::print("interrupted at step {}; the same command with --resume (and the same --set) goes on\n",
               figures_.steps);
  return {exit_interrupted, figures_};
}

void TimeLoop::conclude() {
  simulation_.check_health();
  if (found_static_ && !state_.stages) tell(state_.watch.look(true));
  figures_.balance = simulation_.balance();
  if (scene_.growth) figures_.growth_rate = growth_rate(scene_, simulation_);
}

bool TimeLoop::collapsed(const std::string& message) {
  collapsed_ = state_.stages && state_.stages->end_diverged(message, timer_.stage_seconds());
  if (collapsed_) print_stage();
  return collapsed_;
}

void TimeLoop::left_grid(const LeftGrid& error) {
  progress_.finish();
  if (collapsed(error.what())) return;
  left_ = error;
  if (reports_ && left_->all) fmt::print("{}; the run ends here\n", left_->what());
  if (!left_->all) figures_.balance = simulation_.balance();
}

RunResult TimeLoop::end() {
  progress_.report(simulation_.step(), steps_made(), timer_.seconds(),
                   {simulation_.step(), ExpectedEnd::known}, figures_.balance.force_ratio);
  progress_.finish();
  count_steps();
  enter_state();
  const bool whole_stages = state_.stages.has_value();
  if (found_static_ && !whole_stages && !options_.progress_only)
    print_warnings(crossing_advice(scene_, figures_.state.largest_displacement));
  state_.results.write_summary(summary_json(scene_, figures_));
  if (left_ && !left_->all)
    throw LeftGrid(fmt::format("{}; the last frame is the state of this step", left_->what()), false);
  auto& checkpoints = state_.results.checkpoints();
  if (options_.progress_only)
    checkpoints.remove();  // a study has done with the case
  else if (!collapsed_ && !left_ && !(figures_.steps == state_.resumed_step() && checkpoints.last_is_whole()))
    write_checkpoint();
  if (reports_) print_report(scene_, figures_);
  if (found_static_ && !whole_stages)
    if (const auto idle = idle_tractions(scene_, simulation_.traction_states()); !idle.empty()) {
      if (!options_.progress_only) fmt::print(stderr, "vsb: at rest without its load: {}\n", idle);
      return {exit_not_static, figures_};
    }
  if (left_ || !scene_.time.until_static || found_static_ || whole_stages) return {exit_done, figures_};
  if (!options_.progress_only)
    fmt::print(stderr, "vsb: not static after max_steps = {} (force ratio {:.2e}, energy ratio {:.2e}){}\n",
               scene_.time.steps, figures_.balance.force_ratio, figures_.balance.energy_ratio,
               rest_.standing_text());
  return {exit_not_static, figures_};
}

void TimeLoop::count_steps() {
  figures_.steps = simulation_.step();
  figures_.steps_timed = steps_made();
  figures_.seconds = timer_.seconds();
}

void TimeLoop::enter_state() {
  figures_.found_static = found_static_;
  figures_.tractions = state_.watch.report();
  if (state_.stages) figures_.stages = state_.stages->report();
  if (!collapsed_) {
    if (left_ || (!state_.stages && !state_.frame_is_written())) state_.write_frame();
    take_state(figures_, scene_, simulation_);
  } else {
    figures_.particles = simulation_.particle_count();
    figures_.volumes = simulation_.body_volumes();
  }
  if (!left_) return;
  figures_.left_grid = left_->what();
  if (!left_->all) return;
  figures_.particles = 0;  // what was taken are figures of particles that are gone
  figures_.mass = 0;
  figures_.state = {};
}

void TimeLoop::tell(const std::vector<std::string>& warnings) {
  if (!warnings.empty()) progress_.finish();
  if (!options_.progress_only) print_warnings(warnings);
}

void TimeLoop::print_stage() {
  progress_.finish();
  if (!reports_) return;
  const auto& [reports, outcome, reason] = state_.stages->report();
  fmt::print("{}\n",
             stage_text(reports.back(), static_cast<int>(reports.size()), scene_.removal->hole.has_value()));
  if (!outcome.empty()) fmt::print("{}: {}\n", outcome, reason);
}

}  // namespace vsb::app
