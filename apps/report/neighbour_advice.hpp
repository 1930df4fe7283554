// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What a body's neighbours do to it without being asked: faces of the grid that hold it, and other bodies.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace vsb::app {

/// On bodies that begin beside a face which holds them, or beside another body, nearer than basis functions
/// reach across: they act on each other over the gap.
std::vector<std::string> gap_advice(const Scene& scene);

/// On bodies of other stiffness that touch: the strain jumps between them, and basis functions follow that on
/// lines of the grid alone, B-splines nowhere.
std::vector<std::string> interface_advice(const Scene& scene);

}  // namespace vsb::app
