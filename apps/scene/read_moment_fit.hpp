// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Reads method.moment_fit of a scene whose bodies and basis are known.
#pragma once

#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

/// Refuses the fit where it has nothing to do.
void read_moment_fit(TableReader& method, const BooleanKey& key, Scene& scene);

}  // namespace vsb::app
