// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Reads the tables [grid] and [faces] of a scene.
#pragma once

#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

GridSpec read_grid(TableReader r, int dimension);
FaceSpec read_faces(TableReader r, int dimension, const GridSpec& grid);

}  // namespace vsb::app
