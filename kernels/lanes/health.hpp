// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Finds the first particle with an invalid field (see kernels/readout/health.hpp), for particles in cell
/// lanes.
#pragma once

#include <cstdint>
#include <vsb/kernels/lanes/build.hpp>
#include <vsb/kernels/readout/health.hpp>

namespace vsb {

namespace kernel {

/// One group: the lowest number of an invalid particle, and its field, as one number.
template <int Dim, class Real, class Device>
struct CheckLanes {
  static constexpr std::int64_t fields = 8;
  CellLanes<Dim, Real, Device> lanes;
  UniformGrid<Dim, Real> grid;

  KOKKOS_FUNCTION void operator()(int g, std::int64_t& lowest) const {
    const auto& group = lanes.groups(g);
    for (size_t e = lanes.begin(group); e < lanes.end(group); ++e) {
      const int p = lanes.id(e);
      if (p < 0) continue;
      Vector<Dim, Real> xi, v;
      SymmetricTensor<Dim, Real> sigma;
      for (int i = 0; i < Dim; ++i) {
        xi[i] = *lanes.at(lanes.xi_column + i, e);
        v[i] = *lanes.at(lanes.velocity_column + i, e);
      }
      for (int c = 0; c < sigma.size; ++c) sigma[c] = *lanes.at(lanes.stress_column + c, e);
      const auto x = grid.map(lanes.cell(group, static_cast<int>(e % lanes.width)), xi).x;
      const auto field = spoilt_field(x, v, sigma, *lanes.at(lanes.volume_column, e));
      if (field != ParticleField::none)
        lowest = math::min(lowest, p * fields + static_cast<std::int64_t>(field));
    }
  }
};

}  // namespace kernel

/// The invalid particle of lowest number. Waits for the device.
template <class Exec, int Dim, class Real, class Device>
Invalid find_invalid(const Exec& exec, const LaneMemory<Dim, Real, Device>& m) {
  using Check = kernel::CheckLanes<Dim, Real, Device>;
  constexpr auto none = std::numeric_limits<std::int64_t>::max();
  std::int64_t lowest = none;
  Kokkos::parallel_reduce("vsb::find_invalid_in_lanes",
                          Kokkos::RangePolicy<Exec>(exec, 0, m.lanes.group_count), Check{m.lanes, m.grid},
                          Kokkos::Min<std::int64_t>(lowest));
  exec.fence();
  if (lowest == none) return {-1, ParticleField::none};
  return {static_cast<int>(lowest / Check::fields), static_cast<ParticleField>(lowest % Check::fields)};
}

}  // namespace vsb
