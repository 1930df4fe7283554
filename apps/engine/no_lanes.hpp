// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Stands for LaneEngine where there is none: for bases without cell lanes, and on devices. Nobody makes one.
#pragma once

#include "engine/lane_engine.hpp"

namespace vsb::app {

template <int Dim, class Real>
struct NoLanes {
  using Device = ExecutionSpace::device_type;
  using Setup = typename LaneEngine<Dim, Real>::Setup;
  static constexpr bool on_cells = false;

  void unpack(const Particles<Dim, Real, Device>&, const SurfacePoints<Dim, Real, Device>&) const {}
  Particles<Dim, Real, Device> mass_points() const { return {}; }
  int boundary_nodes() const { return 0; }
  size_t bytes() const { return 0; }
  Invalid find_invalid() const { return {}; }
  bool loaded_by_sweeps() const { return false; }
  Balance<Dim> balance(const Loads<Dim, Real>&) const { return {}; }
  TractionResultant<Dim> resultant(const Loads<Dim, Real>&, TractionMask) const { return {}; }
  LoadedCells loaded_cells(TractionMask) const { return {}; }
  void equivalent_plastic_strain(const Kokkos::View<Real*, Device>&) const {}
  void for_each_cell(const std::function<void(int, const Vector<Dim, int>&)>&) const {}
  std::unique_ptr<FieldSource> fields() const { return nullptr; }
};

}  // namespace vsb::app
