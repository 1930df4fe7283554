// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// In words: a load of a body that no support takes up, and what to do about it.
#pragma once

#include <string>

#include "scene/scene.hpp"

namespace vsb::app {

/// UnsupportedLoad (kernels/statics/unsupported_load.hpp) in the coordinates of the scene.
struct LooseLoad {
  double share = 0;  ///< of the sum of the nodal forces on the body
  Point middle{};    ///< of the body's nodes, m
  Point force{};     ///< N
  Point torque{};    ///< about the middle, N m
};

std::string support_text(const Scene& scene, const LooseLoad& load);

}  // namespace vsb::app
