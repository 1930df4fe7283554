// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Whether failure has cut through the wall around a hole.
#pragma once

#include <vector>

#include "engine/simulation.hpp"

namespace vsb::app {

/// Whether a way over faces of cells leads from the axis of the hole to a face of the grid where nothing is
/// prescribed, through void cells and those in which most particles are marked. `contents` of a uniform
/// grid's cells, along x first.
bool hole_meets_outside(const Scene& scene, const HoleSpec& hole, const std::vector<CellContent>& contents);

}  // namespace vsb::app
