// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Reads the table 'removal' of a scene.
#pragma once

#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

/// The removal of failed particles in stages; none where the scene has no such table. Everything else of the
/// scene must have been read.
std::optional<RemovalSpec> read_removal(TableReader& document, const Scene& scene);

}  // namespace vsb::app
