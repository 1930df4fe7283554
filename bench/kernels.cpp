// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Every kernel of the step alone.

#include "registry.hpp"

namespace vsb::bench {
namespace {

/// A scene whose nodes carry what the particles scattered to them, so that every kernel finds its input.
template <int Dim, class Real>
Scene<Dim, Real> make_started_scene(const Size& size, Load load = Load::off,
                                    Scatter strategy = Scatter::gathered) {
  auto s = make_scene<Dim, Real>(size, load, strategy);
  auto& state = s.state;
  particles_to_grid(Exec(), state.particles, state.occupancy.bins, state.nodes, state.occupancy.boundary,
                    state.sums_workspace.particles, s.basis, NoVirtualStress{}, s.options.gravity, strategy);
  update_nodes(Exec(), state.nodes, s.basis, s.options.damping, s.options.dt);
  remap_velocity(Exec(), state.particles, state.occupancy.bins, state.nodes, state.remap_workspace, s.basis,
                 strategy);
  return s;
}

template <int Dim, class Real>
void add_particles_to_grid(const Size& size, Scatter strategy, Load load) {
  add("particles_to_grid" + scene_name<Dim, Real>(size) + name(strategy) + name(load),
      [=](benchmark::State& state) {
        auto s = make_started_scene<Dim, Real>(size, load, strategy);
        const auto run = [&] {
          with_field(s, [&](const auto& field) {
            particles_to_grid(Exec(), s.state.particles, s.state.occupancy.bins, s.state.nodes,
                              s.state.occupancy.boundary, s.state.sums_workspace.particles, s.basis, field,
                              s.options.gravity, strategy);
          });
        };
        time(state, check_particles_to_grid(s, run), s.state.particles.count(),
             Traffic<Dim, Real>(s).particles_to_grid(load), run);
      });
}

template <int Dim, class Real>
void add_remap_velocity(const Size& size, Scatter strategy) {
  add("remap_velocity" + scene_name<Dim, Real>(size) + name(strategy), [=](benchmark::State& state) {
    auto s = make_started_scene<Dim, Real>(size, Load::off, strategy);
    const auto run = [&] {
      remap_velocity(Exec(), s.state.particles, s.state.occupancy.bins, s.state.nodes,
                     s.state.remap_workspace, s.basis, strategy);
    };
    time(state, check_remap_velocity(s, run), s.state.particles.count(),
         Traffic<Dim, Real>(s).remap_velocity(), run);
  });
}

template <int Dim, class Real>
void add_node_and_particle_updates(const Size& size) {
  const auto scene = scene_name<Dim, Real>(size);
  add("update_nodes" + scene, [=](benchmark::State& state) {
    auto s = make_started_scene<Dim, Real>(size);
    const auto run = [&] { update_nodes(Exec(), s.state.nodes, s.basis, s.options.damping, s.options.dt); };
    time(state, check_update_nodes(s, run), s.state.particles.count(), Traffic<Dim, Real>(s).update_nodes(),
         run);
  });
  add("grid_to_particles" + scene, [=](benchmark::State& state) {
    auto s = make_started_scene<Dim, Real>(size);
    const auto run = [&] {
      grid_to_particles(Exec(), s.state.particles, s.state.nodes, s.basis, s.options.pic, s.options.dt);
    };
    time(state, check_velocity_gain(s, run), s.state.particles.count(),
         Traffic<Dim, Real>(s).grid_to_particles(), run);
  });
  add("update_stress" + scene, [=](benchmark::State& state) {
    auto s = make_started_scene<Dim, Real>(size);
    const auto run = [&] {
      update_stress(Exec(), s.state.particles, s.state.nodes, s.bodies, s.basis, s.options.volume_update,
                    s.options.position_velocity, s.options.dt);
    };
    const auto findings = check_update_stress(s, run);
    s = make_started_scene<Dim, Real>(size);
    time(state, findings, s.state.particles.count(), Traffic<Dim, Real>(s).update_stress(), run);
  });
}

template <int Dim, class Real>
void add_occupancy(const Size& size) {
  const auto scene = scene_name<Dim, Real>(size);
  add("update_occupancy" + scene, [=](benchmark::State& state) {
    auto s = make_scene<Dim, Real>(size, Load::free_faces, Scatter::gathered);
    const auto run = [&] { return update_occupancy(Exec(), s.state.particles, s.state.occupancy, s.basis); };
    time(state, check_bins(s, run), s.state.particles.count(), Traffic<Dim, Real>(s).update_occupancy(), run);
  });
  add("sort_by_bin" + scene, [=](benchmark::State& state) {
    auto s = make_scene<Dim, Real>(size, Load::free_faces, Scatter::gathered);
    const auto run = [&] { sort_by_bin(Exec(), s.state.occupancy.bins); };
    time(state, check_bins(s, run), s.state.particles.count(), Traffic<Dim, Real>(s).sort_by_bin(), run);
  });
  add("mark_boundary_nodes" + scene, [=](benchmark::State& state) {
    auto s = make_scene<Dim, Real>(size, Load::free_faces, Scatter::gathered);
    auto& o = s.state.occupancy;
    const auto run = [&] {
      return mark_boundary_of_located(Exec(), s.state.particles, o.cells, s.basis, o.tractions, o.boundary);
    };
    time(state, check_boundary_nodes(s, run), s.state.particles.count(),
         Traffic<Dim, Real>(s).mark_boundary_nodes(), run);
  });
}

}  // namespace

void register_kernels() {
  for_each_scene([](auto dimension, auto real, const Size& size) {
    constexpr int Dim = decltype(dimension)::value;
    using Real = decltype(real);
    for (const auto strategy : strategies())
      for (const auto load : {Load::off, Load::free_faces})
        add_particles_to_grid<Dim, Real>(size, strategy, load);
    for (const auto strategy : strategies()) add_remap_velocity<Dim, Real>(size, strategy);
    add_node_and_particle_updates<Dim, Real>(size);
    add_occupancy<Dim, Real>(size);
  });
}

}  // namespace vsb::bench
