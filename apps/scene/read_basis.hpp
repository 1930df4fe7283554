// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The basis of a scene, out of its table `method`.
#pragma once

#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

/// Reads the keys `basis` and `gimp_half_width` into scene.method, whose other keys need not be known; grid,
/// bodies and tractions must. Refuses what the basis cannot do.
void read_basis(TableReader& method_table, Scene& scene);

}  // namespace vsb::app
