// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The cells at the boundary that a traction loads (kernels/readout/loaded_cells.hpp), for particles in cell
/// lanes.
#pragma once

#include <vsb/kernels/lanes/spline_step.hpp>
#include <vsb/kernels/readout/loaded_cells.hpp>

namespace vsb {

namespace kernel {

template <int Dim, class Real, class Device>
struct MasksOfLanes {
  CellLanes<Dim, Real, Device> lanes;
  BoundaryNodes<Device> tractions;
  KOKKOS_FUNCTION TractionMask operator()(int row, int x) const {
    const int node = lanes.node_at(row, x);
    return node < 0 ? 0 : tractions(node);
  }
};

}  // namespace kernel

///@{
/// The cells of one traction, given by its bit. The marks must be up to date. Waits for the device.
template <class Exec, int Dim, class Real, class Device>
LoadedCells count_loaded_cells(const Exec& exec, const LaneState<Dim, Real, Device>& s,
                               TractionMask traction) {
  return detail::count_loaded_cells(
      exec, s.boundary.bits, box_tiling(s.memory.lanes, s.memory.grid.cells),
      kernel::MasksOfLanes<Dim, Real, Device>{s.memory.lanes, s.boundary.tractions}, traction);
}
template <class Exec, int Dim, class Real, class Device>
LoadedCells count_loaded_cells(const Exec& exec, const SplineLaneState<Dim, Real, Device>& s,
                               TractionMask traction) {
  return detail::count_loaded_cells(
      exec, s.boundary.bits, spline_tiling(s.memory.lanes, s.grid.cells, s.memory.walls),
      kernel::MasksOfLanes<Dim, Real, Device>{s.memory.lanes, s.boundary.tractions}, traction);
}
///@}

}  // namespace vsb
