// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Advice for scenes that say nothing of the setting they are for.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace vsb::app {

/// A sentence on setting = "accurate" where a scene, as read from the file with the overrides, chooses
/// neither a setting nor one of the things that a setting stands for, and could have the accurate one; else
/// empty.
std::string open_setting_advice(const Scene& scene, const std::string& path,
                                std::vector<std::string> overrides);

}  // namespace vsb::app
