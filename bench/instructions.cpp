// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// vsb_instructions: a few steps of small fixed scenes, for instructions.py to count the instructions of
/// every kernel under callgrind. Prints what the counts depend on.

#include "lane_checks.hpp"
#include "spline_scene.hpp"

#include <cstdio>
#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#define VSB_COUNTS_INSTRUCTIONS 1
#endif

namespace vsb::bench {
namespace {

namespace tools = Kokkos::Tools::Experimental;

std::string scene_name;  ///< empty: do not count
std::string part_name;

/// Every kernel's own part of callgrind's output, named scene and kernel.
void begin(const char* name, uint32_t, uint64_t*) {
  part_name = scene_name + " " + name;
#if defined(VSB_COUNTS_INSTRUCTIONS)
  if (!scene_name.empty()) CALLGRIND_ZERO_STATS;
#endif
}
void end(uint64_t) {
#if defined(VSB_COUNTS_INSTRUCTIONS)
  if (!scene_name.empty()) CALLGRIND_DUMP_STATS_AT(part_name.c_str());
#endif
}

void listen() {
  tools::set_begin_parallel_for_callback(begin);
  tools::set_begin_parallel_reduce_callback(begin);
  tools::set_end_parallel_for_callback(end);
  tools::set_end_parallel_reduce_callback(end);
}

/// Warms up, checks, and counts a last step with marking.
template <int Dim, class Real>
bool run(const char* name, const Size& size, Load load, int axis) {
  auto column = make_column<Dim, Real>(size, load, axis);
  auto s = make_lanes(column);
  const auto with = [&](const auto& work) {
    if (load == Load::off)
      work(NoVirtualStress{});
    else
      work(column.virtual_stress);
  };
  std::string findings;
  with([&](const auto& field) {
    prepare_lane_step(Exec(), s, field);
    for (int n = 0; n < 18; ++n) step(column, s, field);
    findings = check_lane_step(column, s, [&] { step(column, s, field); });
    scene_name = name;
    step(column, s, field);
    if (load != Load::off) {
      update_occupied(Exec(), s.memory.lanes, s.boundary);
      mark_lanes(Exec(), s.memory.lanes, s.memory.grid.cells, s.boundary, true);
    }
    scene_name.clear();
  });
  if (!findings.empty()) std::fprintf(stderr, "vsb_instructions: %s: %s\n", name, findings.c_str());
  return findings.empty();
}

/// Particles change their cells: packing, leaving, arriving, and packing anew.
template <int Dim, class Real>
bool run_moving(const char* name, const Size& size) {
  auto column = make_moving_block<Dim, Real>(size, {{0.1, 0.05, 0.1}});
  scene_name = name;
  auto s = make_lanes(column);
  scene_name.clear();
  prepare_lane_step(Exec(), s, NoVirtualStress{});
  const auto findings = check_moving(column, s, 17, [&](int n) {
    if (n == 14) scene_name = name;
    step(column, s, NoVirtualStress{});
  });
  scene_name.clear();
  if (!findings.empty()) std::fprintf(stderr, "vsb_instructions: %s: %s\n", name, findings.c_str());
  return findings.empty();
}

/// B-splines, with the divergence of every particle its own, and with its mean.
void run_splines(const char* full, const char* averaged, const Size& size) {
  SplineColumn<3, double> scene(size, Load::off);
  scene.pack();
  for (const char* name : {full, averaged}) {
    if (name == averaged) scene.column.options.volumetric = Volumetric::averaged;
    scene.step_lanes();
    scene_name = name;
    scene.step_lanes();
    scene_name.clear();
  }
}

bool run_all() {
  const Size small3{"small", 5, 12, 2}, dense3{"dense", 3, 6, 4}, small2{"small", 12, 40, 2},
      small1{"small", 1, 200, 2};
  bool good = run<3, double>("3d_double", small3, Load::off, 0);
  good = run<3, double>("3d_double_loaded", small3, Load::free_faces, 0) && good;
  good = run<3, float>("3d_float", small3, Load::off, 0) && good;
  good = run<3, float>("3d_float_loaded", small3, Load::free_faces, 0) && good;
  good = run<3, double>("3d_double_64_per_cell", dense3, Load::off, 0) && good;
  good = run<2, double>("2d_double_loaded", small2, Load::free_faces, 0) && good;
  good = run<2, float>("2d_float", small2, Load::off, 0) && good;
  good = run_moving<3, double>("3d_double_moving", {"block", 6, 6, 2, 9, 9}) && good;
  run_splines("3d_double_splines", "3d_double_splines_averaged", {"small", 5, 12, 2});
  return run<1, double>("1d_double_loaded", small1, Load::free_faces, 0) && good;
}

}  // namespace
}  // namespace vsb::bench

int main() {
  using namespace vsb::bench;
  setenv("OMP_PROC_BIND", "false", 0);
  Kokkos::initialize();
  std::printf("compiler: %s\n", __VERSION__);
  std::printf("flags: %s\n", VSB_COUNTED_FLAGS);
  std::printf("Kokkos: %d, %s\n", KOKKOS_VERSION, Exec::name());
  std::fflush(stdout);
  listen();
  const bool good = run_all();
  Kokkos::finalize();
#if !defined(VSB_COUNTS_INSTRUCTIONS)
  std::fprintf(stderr, "vsb_instructions: built without valgrind/callgrind.h\n");
  return 77;
#endif
  return good ? 0 : 1;
}
