// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Steps on cell lanes with particles on the move, and in a grid much larger than the body, against the same
/// steps at rest in a tight grid.
#pragma once

#include "engine_cost.hpp"

namespace vsb::bench {

/// A block of 22^3 cells, 8 particles each, that flies 0.1 cells per step along an axis, against one at rest;
/// both in turns. The mean counts: particles on a lattice change their cells all at once, one step in five,
/// and packing anew comes now and then.
template <class Real>
void measure_translation(int direction, Arrangement arrangement, int steps, Record& record) {
  const std::string name =
      std::string(arrangement == Arrangement::lattice ? "translation along " : "jittered, along ") +
      "xyz"[direction];
  const Size size{"block", 22, 22, 2, steps / 10 + 4, steps / 10 + 4};
  auto velocity = Vector<3, double>::zero();
  auto resting = make_moving_block<3, Real>(size, velocity, arrangement);
  velocity[direction] = 0.1;
  auto moving = make_moving_block<3, Real>(size, velocity, arrangement);
  auto a = make_lanes(resting), b = make_lanes(moving);
  prepare_lane_step(Exec(), a, NoVirtualStress{});
  prepare_lane_step(Exec(), b, NoVirtualStress{});
  double at_rest = 0, on_the_move = 0;
  const auto findings = check_moving(moving, b, steps, [&](int) {
    at_rest += seconds_of([&] { step(resting, a, NoVirtualStress{}); });
    on_the_move += seconds_of([&] { step(moving, b, NoVirtualStress{}); });
  });
  if (!findings.empty()) throw std::runtime_error(name + ": " + findings);
  record.set(name + ": ratio", on_the_move / at_rest);
  record.set(name + ": packed anew", static_cast<double>(b.repacked));
}

/// The column of 80,000 particles in a grid of 30 times its volume against the same in a tight one, in turns.
template <class Real>
void measure_sparse(Record& record) {
  const CostCase tight{"tight", {"tight", 10, 100, 2}, false, {}},
      sparse{"sparse", {"sparse", 10, 100, 2, 20, 20}, false, {}};
  Column<3, Real> in_tight, in_sparse;
  Record memory_tight, memory_sparse;
  auto a = make_measured_lanes(in_tight, tight, 0, memory_tight);
  auto b = make_measured_lanes(in_sparse, sparse, 0, memory_sparse);
  const auto pressure = in_tight.virtual_stress;
  const auto found = measure_in_turns({"tight", [&] { step(in_tight, a, pressure); }},
                                      {{"sparse", [&] { step(in_sparse, b, pressure); }}}, 100);
  record.set("sparse / tight: time", 1 + found.extras[1].percent / 100);
  record.set("sparse / tight: state", memory_sparse["state bytes"] / memory_tight["state bytes"]);
}

/// The memory of one of the two, in a process of its own.
template <class Real>
void measure_sparse_memory(bool is_sparse, Record& record) {
  CostCase what{"80k_ppc8", {"80k_ppc8", 10, 100, 2}, false, {}};
  if (is_sparse) what.size.void_across = what.size.void_along = 20;
  Column<3, Real> column;
  make_measured_lanes(column, what, 0, record);
}

}  // namespace vsb::bench
