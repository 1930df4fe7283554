// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What can be known of the end of a run until static before it runs.
#pragma once

#include <optional>

#include "scene/scene.hpp"

namespace vsb::app {

/// Steps at which a run until static may find rest.
struct RestForecast {
  double earliest, latest;
};

/// Of bodies that are `extent` m long and come to rest under loads that are constant from step `loaded` on.
///
/// Cundall's damping takes 4 alpha of a vibration's energy in every period, so that its force falls from that
/// of the load to the ratio r in n = ln(1 / r) / (2 alpha) periods. The slowest vibration of a compact body
/// has a period between 2 L / c_p (a free bar) and 4 L / c_s (a layer in shear on a fixed base). Loads that
/// grow slowly leave less to damp: scenes were observed at rest after 0.18 (yield-cylinder) to 1.4 (ellipse)
/// times n of the shorter periods, so the range begins at an eighth. Bodies that bend have longer periods.
/// Nothing without damping.
std::optional<RestForecast> forecast_rest(const Scene& scene, double extent, double loaded);

}  // namespace vsb::app
