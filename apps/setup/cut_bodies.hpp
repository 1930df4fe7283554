// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Bodies that the grid would cut off where nobody asked for it.
#pragma once

#include "scene/scene.hpp"

namespace vsb::app {

/// Throws SetupError where a body has lattice points beyond an open face of the grid, within a cell of it:
/// the cut would be a surface that the scene does not speak of. At a face with a condition the cut is a
/// symmetry plane or a support, and a shape without an end of its own (a half-space) ends where the grid
/// does.
void refuse_cut_bodies(const Scene& scene);

}  // namespace vsb::app
