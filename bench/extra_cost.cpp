// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What the virtual stress costs on top of a step without it, in percent.
///
/// Rounds of three steps of one and the same state: off, on, and off again for the null test, in an order
/// that changes from round to round. The extra cost is the median of on / off - 1 over the rounds, the null
/// test that of off / off - 1: what the measurement says where there is nothing to be found. Two states
/// instead of one would differ by several percent from their addresses in memory alone.

#include "common_steps.hpp"
#include "registry.hpp"

#include <algorithm>

namespace vsb::bench {
namespace {

double median(std::vector<double> x) {
  const auto middle = x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2);
  std::nth_element(x.begin(), middle, x.end());
  return *middle;
}

enum Variant { on, off, null_test };

/// The seconds of one step of each variant.
struct Round {
  double seconds[3];
  double ratio(Variant v) const { return seconds[v] / seconds[off]; }
  double difference(Variant v) const { return seconds[v] - seconds[off]; }
};

template <int Dim, class Real>
Round measure_round(Scene<Dim, Real>& s, Load load, int number) {
  static constexpr Variant orders[6][3] = {{on, off, null_test}, {null_test, off, on}, {off, null_test, on},
                                           {on, null_test, off}, {null_test, on, off}, {off, on, null_test}};
  Round round;
  const Exec exec;
  for (const Variant v : orders[number % 6]) {
    s.load = v == on ? load : Load::off;
    const double start = now();
    with_field(s, [&](const auto& field) { step(exec, s.state, s.bodies, s.basis, field, s.options); });
    exec.fence();
    round.seconds[v] = now() - start;
  }
  s.load = load;
  return round;
}

template <int Dim, class Real>
void add_extra_cost(const Size& size, Scatter strategy, Load load) {
  auto* added = benchmark::RegisterBenchmark(
      ("vsb_extra" + scene_name<Dim, Real>(size) + name(strategy) + name(load)).c_str(),
      [=](benchmark::State& state) {
        auto s = make_scene<Dim, Real>(size, load, strategy);
        const int particles = s.state.particles.count();
        const auto findings = check_step(s, [&] {
          with_field(s,
                     [&](const auto& field) { step(Exec(), s.state, s.bodies, s.basis, field, s.options); });
        });
        if (!findings.empty()) {
          ++failed_checks();
          state.SkipWithError(findings.c_str());
          return;
        }
        std::vector<double> extra, null, difference, seconds;
        for (auto _ : state) {
          const auto round = measure_round(s, load, static_cast<int>(seconds.size()));
          state.SetIterationTime(round.seconds[on]);
          seconds.push_back(round.seconds[on]);
          extra.push_back(round.ratio(on));
          null.push_back(round.ratio(null_test));
          difference.push_back(round.difference(on));
        }
        state.counters["ns_per_particle_step"] = 1e9 * median(seconds) / particles;
        state.counters["bytes_per_particle"] = Traffic<Dim, Real>(s).step(load);
        state.counters["extra_percent"] = 100 * (median(extra) - 1);
        state.counters["null_percent"] = 100 * (median(null) - 1);
        state.counters["extra_ns"] = 1e9 * median(difference) / particles;
      });
  const int rounds = std::max(30, std::min(1000, 120 * 80000 / particle_count<Dim>(size)));
  added->Unit(benchmark::kMillisecond)->UseManualTime()->Iterations(rounds);
}

}  // namespace

void register_extra_cost() {
  for_each_scene([](auto dimension, auto real, const Size& size) {
    for (const auto load : {Load::end_face, Load::free_faces})
      add_extra_cost<decltype(dimension)::value, decltype(real)>(size, Scatter::gathered, load);
  });
}

}  // namespace vsb::bench
