// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// One explicit MUSL step on cell lanes, the fast engine: with linear functions on a LaneState, with
/// quadratic B-splines on a SplineLaneState. Particles are packed by pack_lanes and unpacked by
/// unpack_particles; prepare_lane_step comes before the first lane_step. add_lane_loads adds the tractions on
/// surface points and those of the original method, which LaneState alone takes.
#pragma once

#include <vsb/kernels/lanes/loads.hpp>
#include <vsb/kernels/lanes/spline_step.hpp>
