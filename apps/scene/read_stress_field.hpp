// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Reads the stress field of a traction.
#pragma once

#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

/// The keys of a traction of which one says what its stress is.
extern const std::vector<std::string> stress_field_keys;
/// The keys of an ellipse with a pressurised hole.
extern const std::vector<std::string> ellipse_keys;
EllipseSpec read_ellipse(TableReader& r);

/// The one stress field that a traction has. `scene` has its grid and bodies already.
StressFieldSpec read_stress_field(TableReader& traction, const Scene& scene);

}  // namespace vsb::app
