// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The volume of a region, however its shapes are combined.
///
/// Boxes that the surface may cross are halved, each along its longest edge; Region::overlap is certain about
/// all others. In those that are left, four lines per transverse direction along every axis are halved in the
/// same way down to a millionth: no wall is too thin to be met by a line that crosses it. Each line counts
/// with the share of what it meets that is its own (class Chords). When there are enough boxes, the volume is
/// taken, and again with their halves, until two such figures agree to 1.5e-4 (or there are 8 times as many).
/// The error is what the surface does between two lines: 1e-5 of the volume of a ball, a disc or a shell of
/// either, however thin; 1e-3, at most 3e-3, of walls with a free edge. Where walls meet, their edge is
/// counted twice until boxes are as small as the wall is thick: twice the thickness over the length at most.
#pragma once

#include "scene/scene.hpp"

namespace vsb::app {

struct Volume {
  double value = 0;  ///< m^3 (area in 2D, length in 1D)
  double error = 0;  ///< what it may be off, about: the difference to an estimate with fewer boxes
};

/// Of the part of a region in a box. `enough_boxes`: of those that the surface crosses.
Volume volume_within(const Region& region, const AxisBox& limits, int dimension, size_t enough_boxes);

/// Of the parts of a scene's bodies that lie in the grid, body by body.
std::vector<Volume> shape_volumes(const Scene& scene);

}  // namespace vsb::app
