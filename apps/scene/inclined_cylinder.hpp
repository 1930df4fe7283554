// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A cylinder along any direction.
#pragma once

#include "scene/region.hpp"

namespace vsb::app {

/// Within `radius` of the axis through `center`, and lower <= x . axis / |axis| <= upper: along x, y or z the
/// cylinder of scene/region.hpp.
Region inclined_cylinder(const Point& axis, const Point& center, double radius, double lower, double upper);

}  // namespace vsb::app
