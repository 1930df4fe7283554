// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Whether the numbers of a scene can be computed with once they are put together.
#pragma once

#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

/// Throws SceneError where a modulus, the volume or mass of a particle, the time step, a velocity, a stress
/// or a coordinate is neither 0 nor a normal number of the scene's precision.
void check_magnitudes(const Scene& scene, const TableReader& document);

/// The same of the exact solution, of whose numbers errors take squares.
void check_comparison(const Scene& scene, const TableReader& document);

}  // namespace vsb::app
