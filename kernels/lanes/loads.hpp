// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Loads with kernels of their own beside the sweeps over cell lanes: tractions on surface points, and those
/// of the original virtual stress boundary method.
#pragma once

#include <vsb/kernels/lanes/linear_step.hpp>
#include <vsb/kernels/lanes/original_virtual_stress.hpp>

namespace vsb {

/// Adds the loads of the step to come on s.surface and those of s.original to the nodal sums of
/// prepare_lane_step or lane_step. `virtual_stress` is the field of all these tractions at the end of that
/// step. Returns -1, or the lowest number of a surface point outside the grid.
template <class Exec, class Field, int Dim, class Real, class Device>
int add_lane_loads(const Exec& exec, LaneState<Dim, Real, Device>& s, const Field& virtual_stress) {
  if (s.original == 0 && s.surface.count() == 0) return -1;
  if (!s.prepared || !s.loads_due)
    detail::refuse(
        "add_lane_loads has added the loads of the step to come, or none is prepared: call it once "
        "after prepare_lane_step and after every lane_step");
  check_load(virtual_stress, 0, true);
  add_cell_virtual_stress(exec, s.memory.lanes, s.memory.nodes, s.memory.grid, s.boundary, virtual_stress,
                          s.original, s.gauss_points);
  const int lost = add_surface_tractions(exec, s.memory, s.surface, virtual_stress);
  s.loads_due = lost >= 0;
  return lost;
}

}  // namespace vsb
