// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The step with quadratic B-splines: on cell lanes, and by the particle kernels beside it.

#include "common_steps.hpp"
#include "registry.hpp"
#include "spline_scene.hpp"

namespace vsb::bench {
namespace {

/// Ten steps without load on cell lanes and by the particle kernels: what differs.
template <int Dim, class Real>
std::string check_spline_lanes(const Size& size) {
  SplineColumn<Dim, Real> s(size, Load::off);
  s.column.options.damping = 0;  // its sign at nodes at rest is round-off
  s.pack();
  s.make_particle_state();
  for (int n = 0; n < 10; ++n) {
    s.step_lanes();
    s.step_particles();
  }
  const auto theirs = host_copy(s.column.block);
  unpack_particles(Exec(), s.lanes.memory, s.column.block.particles);
  Kokkos::fence();
  const auto mine = host_copy(s.column.block);
  double most = 0, scale = 0;
  for (int p = 0; p < mine.particles.count(); ++p)
    for (int c = 0; c < mine.particles.stress_size; ++c) {
      const double a = mine.particles.cauchy_stress(p, c), b = theirs.particles.cauchy_stress(p, c);
      most = std::abs(a - b) <= most ? most : std::abs(a - b);
      scale = std::max(scale, std::abs(b));
    }
  const double tolerance = sizeof(Real) == 8 ? 1e-11 : 1e-2;  // float positions are rounded in the grid
  return most <= tolerance * scale
             ? ""
             : "stresses of cell lanes and particle kernels differ by " + std::to_string(most / scale);
}

template <int Dim, class Real>
void add_spline_steps(const Size& size) {
  const int n = particle_count<Dim>(size);
  for (const Load load : {Load::off, Load::free_faces})
    add("spline_lane_step" + scene_name<Dim, Real>(size) + name(load), [=](benchmark::State& state) {
      const auto findings = check_spline_lanes<Dim, Real>(size);
      SplineColumn<Dim, Real> s(size, load);
      s.pack();
      time(state, findings, n, 0, [&] { s.step_lanes(); });
    });
  add("spline_step" + scene_name<Dim, Real>(size) + name(Scatter::gathered) + name(Load::off),
      [=](benchmark::State& state) {
        SplineColumn<Dim, Real> s(size, Load::off);
        s.make_particle_state();
        time(state, "", n, 0, [&] { s.step_particles(); });
      });
}

}  // namespace

void register_spline_lanes() {
  for (const auto& size : sizes<3>()) {
    if (particle_count<3>(size) > 100000) continue;  // the particle kernels take their time
    add_spline_steps<3, double>(size);
    add_spline_steps<3, float>(size);
  }
}

}  // namespace vsb::bench
