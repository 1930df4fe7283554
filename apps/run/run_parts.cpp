// SPDX-License-Identifier: BSD-3-Clause
#include "run/run_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "report/comparison.hpp"
#include "report/recovered_stress.hpp"
#include "report/scene_advice.hpp"
#include "report/traction_watch.hpp"

namespace vsb::app {

namespace {

/// With the recovered stress where a field or a norm needs it.
std::unique_ptr<ParticleReader> read_particles(const Scene& scene, Simulation& simulation) {
  const auto& fields = scene.output.fields;
  auto particles = simulation.read_particles();
  if (scene.more_norms.recovered || std::count(fields.begin(), fields.end(), "recovered_stress") > 0)
    particles->recovered_stress =
        recovered_stress(scene, particles->all(field::position | field::cauchy_stress | field::volume));
  return particles;
}

/// A run until a static state whose loads nothing takes up at the start.
std::vector<std::string> support_advice(const Scene& scene, Simulation& simulation) {
  const double settled = loads_settled_at(scene);
  if (!scene.time.until_static || !std::isfinite(settled)) return {};
  const auto unsupported = simulation.unsupported_load(settled);
  if (unsupported.empty()) return {};
  return {fmt::format(
      "at the start, and at full load, {}; else the body moves until something stops it, and what is then "
      "called static is not the state at its present position",
      unsupported)};
}

}  // namespace

void refuse_unsettled_loads(const Scene& scene, const std::string& who) {
  for (const auto& load : loads_in_time(scene))
    if (!std::isfinite(load.time.settled_at()))
      throw SetupError(
          load.where,
          fmt::format("{}: {} is a sine, which never settles, so there is no final load", who, load.name));
}

void print_warnings(const std::vector<std::string>& warnings) {
  for (const auto& warning : warnings) fmt::print(stderr, "vsb: warning: {}\n", warning);
}

void print_advice(const Scene& scene, Simulation& simulation) {
  print_warnings(scene_advice(scene));
  print_warnings(volume_advice(scene, simulation.body_volumes()));
  print_warnings(simulation.advice());
  if (simulation.step() != 0) return;  // resumed
  print_warnings(resultant_advice(scene, simulation));
  print_warnings(support_advice(scene, simulation));
}

void write_frames(Results& results, const Scene& scene, Simulation& simulation) {
  simulation.check_health();
  results.write_frame(*read_particles(scene, simulation));
  if (scene.output.grid)
    results.write_grid_frame(simulation.grid_snapshot(), simulation.step(), simulation.time());
}

void take_state(RunFigures& figures, const Scene& scene, Simulation& simulation) {
  const auto comparison = compare_with_exact(scene, *read_particles(scene, simulation));
  figures.errors = comparison.errors;
  figures.compared = comparison.figures;
  figures.state = state_figures(scene, *simulation.read_particles());
  figures.cut = simulation.cut_volume();
  figures.volumes = simulation.body_volumes();
  figures.moment_fit = simulation.moment_fit();
  figures.particles = simulation.particle_count();
  figures.outflow = simulation.outflow();
  simulation.read_particles()->for_each_range(field::mass, [&](const Snapshot& s) {
    for (const double m : s.mass) figures.mass += m;
  });
  figures.boundary_nodes = simulation.boundary_nodes();
  figures.void_filter = simulation.void_filter();
  figures.state_hash = state_hash(simulation);
  figures.state_bytes = simulation.state_bytes();
}

}  // namespace vsb::app
