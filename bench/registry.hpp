// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Names, registration and the timed loop of the benchmarks. A name reads
///   what / dimension / number type / size / [scatter strategy] / [load],
/// for example step/3d/double/80k_ppc8/gathered/vsb_off.
#pragma once

#include "checks.hpp"
#include "clock.hpp"
#include "traffic.hpp"

#include <benchmark/benchmark.h>

namespace vsb::bench {

/// What runs without arguments: the column of 80,000 particles, 8 per cell, in 3D.
constexpr const char* default_filter = "/3d/.*/80k_ppc8";

template <int Dim>
std::vector<Size> sizes() {
  if constexpr (Dim == 1) return {{"76_ppc2", 1, 38, 2}, {"80k_ppc2", 1, 40000, 2}};
  if constexpr (Dim == 2) return {{"100k_ppc4", 50, 500, 2}, {"80k_ppc16", 22, 227, 4}};
  if constexpr (Dim == 3)
    return {{"10k_ppc8", 5, 50, 2},
            {"80k_ppc8", 10, 100, 2},
            {"640k_ppc8", 20, 200, 2},
            {"80k_ppc64", 5, 50, 4},
            {"640k_ppc64", 10, 100, 4}};
}

/// Calls work(dimension, real, size) for all scenes; the first two arguments carry a constant and a type.
template <class Work>
void for_each_scene(const Work& work) {
  const auto with_size = [&](auto dimension, auto real) {
    for (const auto& size : sizes<decltype(dimension)::value>()) work(dimension, real, size);
  };
  with_size(std::integral_constant<int, 1>(), double());
  with_size(std::integral_constant<int, 2>(), double());
  with_size(std::integral_constant<int, 3>(), double());
  with_size(std::integral_constant<int, 3>(), float());
}

inline std::vector<Scatter> strategies() {
  if (runs_on_host) return {Scatter::gathered, Scatter::duplicated, Scatter::atomic};
  return {Scatter::gathered, Scatter::atomic};
}

inline std::string name(Scatter s) {
  return s == Scatter::gathered ? "/gathered" : s == Scatter::duplicated ? "/duplicated" : "/atomic";
}
inline std::string name(Load load) {
  return load == Load::off ? "/vsb_off" : load == Load::end_face ? "/vsb_end" : "/vsb_all";
}
template <int Dim, class Real>
std::string scene_name(const Size& size) {
  return "/" + std::to_string(Dim) + "d/" + (sizeof(Real) == 4 ? "float/" : "double/") + size.name;
}

template <class Function>
benchmark::internal::Benchmark* add(const std::string& full_name, const Function& function) {
  auto* added = benchmark::RegisterBenchmark(full_name.c_str(), function)->Unit(benchmark::kMillisecond);
  return works_elsewhere() ? added->UseRealTime() : added;
}

/// What no time is counted for.
struct Nothing {
  void operator()() const {}
};

/// How many benchmarks were not timed because of what their check found.
inline int& failed_checks() {
  static int count = 0;
  return count;
}

/// The timed loop: `run` and a fence, unless `findings` says what is wrong. `before` comes before every call
/// and is not timed.
template <class Run, class Before = Nothing>
void time(benchmark::State& state, const std::string& findings, int particles, double bytes_per_particle,
          const Run& run, const Before& before = {}) {
  if (!findings.empty()) {
    ++failed_checks();
    state.SkipWithError(findings.c_str());
    return;
  }
  constexpr bool apart = !std::is_same_v<Before, Nothing>;
  const Exec exec;
  double start = now(), seconds = 0;
  for (auto _ : state) {
    if constexpr (apart) {
      state.PauseTiming();
      before();
      exec.fence();
      state.ResumeTiming();
      start = now();
    }
    run();
    exec.fence();
    if constexpr (apart) seconds += now() - start;
  }
  if constexpr (!apart) seconds = now() - start;
  state.counters["ns_per_particle_step"] =
      1e9 * seconds / static_cast<double>(state.iterations()) / particles;
  state.counters["bytes_per_particle"] = bytes_per_particle;
}

void register_kernels();
void register_steps();
void register_extra_cost();
void register_lanes();
void register_spline_lanes();

}  // namespace vsb::bench
