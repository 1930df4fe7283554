// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What a step of the particle kernels costs, beside one on cell lanes, and what the four ways of imposing a
/// traction add to it.
#pragma once

#include "engine_cost.hpp"
#include "surface_scene.hpp"

namespace vsb::bench {

/// One step of the particle kernels.
template <class Field, class Real>
void step(Scene<3, Real>& s, const Field& field) {
  vsb::step(Exec(), s.state, s.bodies, s.basis, field, s.options);
}

template <class Real>
Rounds measure_impositions(Scene<3, Real>& s, int rounds) {
  const auto material = make_surface(s, Points::material), boundary = make_surface(s, Points::boundary);
  const SurfacePoints<3, Real, Device> none;
  const OnSurfacePoints<UniformVirtualStress<3, Real>> on_points{s.virtual_stress};
  const OriginalVirtualStress<UniformVirtualStress<3, Real>, UniformGrid<3, Real>, Device> original{
      s.virtual_stress, s.basis.grid, s.state.occupancy.cells, 1, 2};
  const auto with_points = [&](const SurfacePoints<3, Real, Device>& points) {
    return [&s, &none, on_points, points] {
      s.state.surface = points;
      step(s, on_points);
      s.state.surface = none;
    };
  };
  return measure_in_turns({"base", [&] { step(s, NoVirtualStress{}); }},
                          {{"MP", with_points(material)},
                           {"BP", with_points(boundary)},
                           {"ORIG", [&] { step(s, original); }},
                           {"MOD", [&] { step(s, s.virtual_stress); }}},
                          rounds);
}

/// How many times as long as a step on cell lanes one of the particle kernels takes.
template <class Real>
void compare_engines(Scene<3, Real>& scene, int rounds, Record& record) {
  auto lanes = make_lanes(scene);
  for (const bool loaded : {false, true}) {
    std::vector<double> ratio;
    const auto run = [&](const auto& field) {
      prepare_lane_step(Exec(), lanes, field);
      for (int round = 0; round < rounds; ++round) {
        const double naive = seconds_of([&] { step(scene, field); });
        ratio.push_back(naive / seconds_of([&] { step(scene, lanes, field); }));
      }
    };
    if (loaded)
      run(scene.virtual_stress);
    else
      run(NoVirtualStress{});
    record.set(loaded ? "particle kernels / engine, MOD" : "particle kernels / engine, base", median(ratio));
  }
}

template <class Real>
void measure_kernels(const CostCase& what, int axis, int repeats, Record& record) {
  auto scene = make_scene<3, Real>(what.size, Load::free_faces, Scatter::gathered, axis);
  const int particles = particle_count<3>(what.size),
            rounds = std::max(5, rounds_for(what.size, repeats) / 4);
  const auto findings = check_step(scene, [&] { step(scene, scene.virtual_stress); });
  if (!findings.empty()) throw std::runtime_error(what.name + ", particle kernels: " + findings);
  if constexpr (runs_on_host) compare_engines(scene, rounds, record);
  std::vector<double> base;
  for (const Load load : {Load::end_face, Load::free_faces}) {
    apply_load(scene, load);
    const auto found = measure_impositions(scene, rounds);
    add_extras(record, load == Load::end_face ? "kernels, end face" : "kernels, all faces", found, particles);
    base.insert(base.end(), found.base.begin(), found.base.end());
  }
  record.set("kernels base ns", 1e9 * median(base) / particles);
  record.set("kernels base 10 % ns", 1e9 * quantile(base, 0.1) / particles);
}

}  // namespace vsb::bench
