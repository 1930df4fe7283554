// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The loads of a scene that vary in time: its tractions and its gravity.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace vsb::app {

struct LoadInTime {
  std::string name;          ///< for messages: "traction 'top'", "gravity"
  std::string key;           ///< of its time: "traction[0].time", "gravity_time"
  std::string where;         ///< file:line:column of its table; empty: the scene as a whole
  const TimeFunction& time;  ///< of the scene, which must outlive this
};

/// The tractions, then gravity where there is any.
std::vector<LoadInTime> loads_in_time(const Scene& scene);

/// The time from which on all loads are constant, s; infinite where one never is.
double loads_settled_at(const Scene& scene);

}  // namespace vsb::app
