// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Regions written in TOML: { box = { lower = [0, 0], upper = [1, 2] } }, { difference = [ {...}, {...} ] },
/// ...
#pragma once

#include "scene/region.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

/// Reads the region under `key` of a table; an absent key is an error, or `everywhere` where it is optional.
Region read_region(TableReader& reader, const std::string& key, int dimension, bool optional);

}  // namespace vsb::app
