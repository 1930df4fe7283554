// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// One explicit MUSL step on cell lanes, the fast engine: with linear functions on a LaneState, with
/// quadratic B-splines on a SplineLaneState. Both have pack, prepare_lane_step, lane_step and unpack;
/// add_lane_loads adds the tractions on surface points and those of the original method.
#pragma once

#include <vsb/kernels/lanes/loads.hpp>
#include <vsb/kernels/lanes/spline_step.hpp>
