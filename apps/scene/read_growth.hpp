// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Reads the table [growth] of a scene.
#pragma once

#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

struct GrowthKeys : KeyTable {
  GrowthKeys()
      : KeyTable(
            "growth",
            "At the end of the run, which should be at rest: how fast a small disturbance grows from there "
            "(`growth_rate` of the summary, 1/s). It costs twice its time in steps.") {}
  NumberKey time{*this,    "time", Range::in_words("> 0, from 192 time steps to 1e7"),
                 required, "s",    "for which the disturbance is followed"};
  NumberKey damping{*this, "damping", {0, 1, false, true}, 0.0, "", "method.damping meanwhile"};
};
inline const GrowthKeys growth_keys;

/// The scene but for output and comparison must be known.
std::optional<GrowthSpec> read_growth(TableReader& document, const SubtableKey& key, const Scene& scene);

}  // namespace vsb::app
