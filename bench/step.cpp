// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The whole step, with every scatter strategy and load.

#include "common_steps.hpp"
#include "registry.hpp"

namespace vsb::bench {
namespace {

template <int Dim, class Real>
void add_step(const Size& size, Scatter strategy, Load load) {
  add("step" + scene_name<Dim, Real>(size) + name(strategy) + name(load), [=](benchmark::State& state) {
    auto s = make_scene<Dim, Real>(size, load, strategy);
    const auto run = [&] {
      with_field(s, [&](const auto& field) { step(Exec(), s.state, s.bodies, s.basis, field, s.options); });
    };
    time(state, check_step(s, run), s.state.particles.count(), Traffic<Dim, Real>(s).step(load), run);
    state.counters["state_bytes_per_particle"] = state_bytes(s);
  });
}

}  // namespace

void register_steps() {
  for_each_scene([](auto dimension, auto real, const Size& size) {
    for (const auto strategy : strategies())
      for (const auto load : {Load::off, Load::end_face, Load::free_faces})
        add_step<decltype(dimension)::value, decltype(real)>(size, strategy, load);
  });
}

}  // namespace vsb::bench
