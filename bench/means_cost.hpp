// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Steps on cell lanes whose divergence gives way to its mean (physics/mean_divergence.hpp) against the same
/// steps without.
#pragma once

#include "lane_scene.hpp"
#include "rounds.hpp"
#include "spline_scene.hpp"

namespace vsb::bench {

/// step(options) takes one step.
template <class Real, class Step>
void measure_mean_divergence(const std::string& basis, const StepOptions<3, Real>& full, const Step& step,
                             Record& record) {
  auto averaged = full;
  averaged.volumetric = Volumetric::averaged;
  const auto found =
      measure_in_turns({"full", [&] { step(full); }}, {{"averaged", [&] { step(averaged); }}}, 100);
  record.set("averaged / full, " + basis, 1 + found.extras[1].percent / 100);
}

/// 80,000 particles, linear functions and B-splines.
template <class Real>
void measure_means(Record& record) {
  const Size size{"80k_ppc8", 10, 100, 2};
  const auto column = make_column<3, Real>(size, Load::off, 0);
  auto lanes = make_lanes(column);
  prepare_lane_step(Exec(), lanes, NoVirtualStress{});
  measure_mean_divergence(
      "linear", column.options,
      [&](const auto& options) {
        lane_step(Exec(), lanes, column.material, DeterminantVolume{}, NoVirtualStress{}, options);
      },
      record);
  SplineColumn<3, Real> splines(size, Load::off);
  splines.pack();
  measure_mean_divergence(
      "B-splines", splines.column.options,
      [&](const auto& options) {
        lane_step(Exec(), splines.lanes, splines.column.material, DeterminantVolume{}, NoVirtualStress{},
                  options);
      },
      record);
}

}  // namespace vsb::bench
