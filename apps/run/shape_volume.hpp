// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The volume of a region, however its shapes are combined.
///
/// Boxes that the surface may cross are halved, each along its longest edge; Region::overlap is certain about
/// all others. In a box that is left, two lines per transverse direction, at the places of Gauss's
/// quadrature, are halved in the same way down to a millionth: no wall is too thin to be met by a line that
/// crosses it. The lines run along the direction with the most crossings. When there are enough boxes, the
/// volume is taken, and again with their halves, until two such figures agree to 3e-4 (or there are 16 times
/// as many). The error is what the surface does between two lines: of a ball some 3e-5 of its volume, of a
/// disc less than 1e-6; boxes whose faces follow the axes have hardly any. Of an oblique or round wall
/// in space that is far thinner than the boxes it is more: 3e-3 at a two-hundredth of the body, some 1e-2 at a
/// two-thousandth.
#pragma once

#include "scene/scene.hpp"

namespace vsb::app {

/// Of the part of a region in a box, m^3 (area in 2D, length in 1D). `enough_boxes`: of those that the
/// surface crosses.
double volume_within(const Region& region, const AxisBox& limits, int dimension, size_t enough_boxes);

/// Of the parts of a scene's bodies that lie in the grid, body by body.
std::vector<double> shape_volumes(const Scene& scene);

}  // namespace vsb::app
