// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Lattices written in TOML: particles_per_cell = 4, lattice.uniform = { spacing = 0.1 },
/// lattice.concentric = { ... }.
#pragma once

#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

/// Reads the keys particles_per_cell or lattice, boundary, jitter and seed of a body's table. Grid, dimension
/// and setting of the scene must be known.
void read_lattice(TableReader& body_table, const Scene& scene, BodySpec& body);

}  // namespace vsb::app
