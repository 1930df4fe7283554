// SPDX-License-Identifier: BSD-3-Clause
#include "run/stages.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "run/cut_through.hpp"

namespace vsb::app {

namespace {

/// Where a run diverged, the share of failed particles from which on this counts as collapse.
constexpr double most = 0.5;

/// The share of the failed particles that may change while they count as settled: fewer than one in a slice.
constexpr double few = 1e-3;

/// The flags of StagedState::present.
constexpr unsigned char left = 1, had_failed = 2;

/// The particles beyond the threshold, NaN among them.
std::vector<unsigned char> beyond(const std::vector<double>& measure, double threshold) {
  std::vector<unsigned char> failed(measure.size());
  std::transform(measure.begin(), measure.end(), failed.begin(),
                 [&](double q) -> unsigned char { return q <= threshold ? 0 : 1; });
  return failed;
}

/// How many particles failed in one of two states alone.
int differences(const std::vector<unsigned char>& a, const std::vector<unsigned char>& b) {
  if (a.size() != b.size()) return static_cast<int>(a.size());
  int n = 0;
  for (size_t p = 0; p < a.size(); ++p) n += a[p] != b[p];
  return n;
}

int count(const std::vector<unsigned char>& failed) {
  return static_cast<int>(std::count(failed.begin(), failed.end(), 1));
}

}  // namespace

Stages::Stages(const Scene& scene, Simulation& simulation)
    : scene_(scene), removal_(*scene.removal), simulation_(simulation) {
  present_.assign(static_cast<size_t>(simulation.particle_count()), 1);
}

void Stages::restore(const StagedState& saved) {
  for (size_t id = 0; id < present_.size(); ++id) {
    present_[id] = saved.present[id] & left;
    if (present_[id] != 0) settled_.push_back((saved.present[id] & had_failed) != 0);
  }
  report_ = stages_of_toml(saved.stages);
  if (report_.stages.empty()) throw SetupError("the checkpoint is damaged: it has no stage");
  // The last one is the stage that was under way; see with_stages.
  first_step_ = report_.stages.back().first_step;
  settled_step_ = report_.stages.back().last_step;
  last_count_ = report_.stages.back().failed;
  seconds_before_ = report_.stages.back().seconds;
  report_.stages.pop_back();
  if (settled_step_ == first_step_) settled_.clear();  // nobody has looked at the particles yet
}

SavedState Stages::with_stages(SavedState saved, double seconds) const {
  auto report = report_;
  if (!report.outcome.empty()) {  // the last stage: with another end, the run goes on in it
    report.stages.pop_back();
    report.outcome.clear();
    report.reason.clear();
  }
  auto under_way = present_stage(seconds);
  under_way.last_step = settled_step_;
  under_way.failed = last_count_;
  report.stages.push_back(under_way);
  saved.staged.stages = to_toml(report);
  if (settled_.empty()) return saved;
  size_t n = 0;
  for (auto& flag : saved.staged.present)
    if (flag != 0 && settled_[n++] != 0) flag = left | had_failed;
  return saved;
}

StageReport Stages::present_stage(double seconds) const {
  StageReport stage;
  stage.first_step = first_step_;
  stage.last_step = simulation_.step();
  stage.particles = simulation_.particle_count();
  stage.seconds = seconds_before_ + seconds;
  return stage;
}

Stages::Signs Stages::look(bool constant_loads) {
  const auto failed = beyond(simulation_.equivalent_plastic_strain(removal_.remap), removal_.threshold);
  last_count_ = count(failed);
  if (!constant_loads || differences(failed, settled_) > few * last_count_) {
    settled_ = failed;
    settled_step_ = simulation_.step();
  }
  if (!collapse_of(failed).empty()) return Signs::failed;
  const bool settled = removal_.settled > 0 && simulation_.step() - settled_step_ >= removal_.settled;
  return settled ? Signs::settled : Signs::none;
}

bool Stages::end(bool at_rest, double force_ratio, double seconds) {
  auto stage = present_stage(seconds);
  stage.at_rest = at_rest;
  stage.force_ratio = force_ratio;
  stage.yielded = simulation_.yielded_volume();
  const auto measure = simulation_.equivalent_plastic_strain(removal_.remap);
  const auto failed = beyond(measure, removal_.threshold);
  stage.failed = count(failed);
  stage.largest = *std::max_element(measure.begin(), measure.end());
  if (removal_.hole) stage.zone = zone_of(failed);

  auto& outcome = report_.outcome;
  if (const auto collapse = collapse_of(failed); !collapse.empty()) {
    outcome = "collapse";
    report_.reason = collapse;
  } else if (!at_rest) {
    outcome = "collapse";
    report_.reason = fmt::format(
        "stage {} found no rest within max_steps = {} (force ratio {:.2e}; {:.3g} % of the particles are "
        "beyond the threshold)",
        number(), scene_.time.steps, force_ratio, 100 * stage.share());
  } else if (stage.failed == 0) {
    outcome = "steady";
    report_.reason = "no particle is beyond the threshold";
  } else if (number() == removal_.max_stages) {
    outcome = "max_stages";
    report_.reason = fmt::format("particles are beyond the threshold after max_stages = {}", number());
  } else {
    stage.removed = true;
  }
  report_.stages.push_back(stage);
  if (!stage.removed) return false;

  size_t n = 0;
  for (auto& present : present_)
    if (present != 0) present = failed[n++] == 0;
  Restart restart;
  restart.reset = removal_.reset;
  if (!removal_.reset) restart.damping = removal_.damping;
  simulation_.remove(failed, restart);
  first_step_ = simulation_.step();
  seconds_before_ = 0;
  last_count_ = 0;
  settled_.clear();
  settled_step_ = first_step_;
  return true;
}

bool Stages::end_diverged(const std::string& message, double seconds) {
  auto stage = present_stage(seconds);
  stage.failed = last_count_;
  if (stage.share() < most) return false;
  report_.stages.push_back(stage);
  report_.outcome = "collapse";
  report_.reason = fmt::format("the run diverged, {:.3g} % of the particles beyond the threshold: {}",
                               100 * stage.share(), message);
  return true;
}

std::string Stages::collapse_of(const std::vector<unsigned char>& failed) const {
  const double share = static_cast<double>(count(failed)) / static_cast<double>(failed.size());
  if (share >= removal_.collapse)
    return fmt::format("{:.3g} % of the particles that were left are beyond the threshold", 100 * share);
  if (removal_.hole && !scene_.grid.mapped() &&
      hole_meets_outside(scene_, *removal_.hole, simulation_.cell_contents(failed)))
    return fmt::format(
        "the body is cut through: failed cells join the hole and the outside ({:.3g} % of the particles that "
        "were left are beyond the threshold)",
        100 * share);
  return {};
}

FailedZone Stages::zone_of(const std::vector<unsigned char>& failed) const {
  std::vector<Fate> fate(present_.size(), Fate::gone);
  size_t n = 0;
  for (size_t id = 0; id < present_.size(); ++id)
    if (present_[id] != 0) fate[id] = failed[n++] != 0 ? Fate::failed : Fate::present;
  return measure_failed_zone(*removal_.hole, scene_.dimension, place_particles(scene_).position, fate);
}

}  // namespace vsb::app
