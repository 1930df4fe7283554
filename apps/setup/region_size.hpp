// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// How large a region is, before anything is placed in it: from what it says of boxes, without visiting
/// points.
#pragma once

#include "scene/region.hpp"

namespace vsb::app {

/// The box around what lies of a region in a box, to round-off where Region::overlap is exact, as for one
/// shape; an empty region has the box itself.
AxisBox bounds_of(const Region& region, const AxisBox& box, int dimension);

/// A volume that the region has in the box at least.
double least_volume(const Region& region, const AxisBox& box, int dimension);

}  // namespace vsb::app
