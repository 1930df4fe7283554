// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Reading of a body's material.
#pragma once

#include "scene/material_spec.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

MaterialSpec read_material(TableReader r);

}  // namespace vsb::app
