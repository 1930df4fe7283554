// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The fields of particles in cell lanes, read where they are.
#pragma once

#include <vsb/kernels/lane_step.hpp>
#include <vsb/kernels/lanes/read.hpp>
#include "engine/particle_reader.hpp"
#include "engine/read_rows.hpp"

namespace vsb::app {

template <int Dim, class Real>
class LaneFields final : public FieldSource {
 public:
  using Device = ExecutionSpace::device_type;

  LaneFields(const ExecutionSpace& exec, const LaneState<Dim, Real, Device>& state)
      : exec_(exec), state_(state), index_(index_lanes(exec, state.memory.lanes)) {}

  void read(unsigned field, size_t first, std::vector<double>& to) override {
    const auto& lanes = state_.memory.lanes;
    const int begin = static_cast<int>(first);
    if (field == field::position) {
      read_rows(
          exec_, "vsb::read_lane_positions", 3,
          [&](const Rows& rows) {
            return kernel::ReadLanePositions<Dim, Real, Device>{lanes, index_, state_.memory.grid, begin,
                                                                rows};
          },
          to);
      return;
    }
    const auto [column, count, columns] = columns_of(field);
    read_rows(
        exec_, "vsb::read_lane_columns", columns,
        [&, column = column, count = count](const Rows& rows) {
          return kernel::ReadLaneColumns<Dim, Real, Device>{lanes, index_, begin, column, count, rows};
        },
        to);
  }

  void read_flags(size_t first, std::vector<unsigned char>& to) override {
    const Flags flags("vsb::boundary_particles", to.size());
    Kokkos::parallel_for(
        "vsb::flag_lane_particles",
        Kokkos::RangePolicy<ExecutionSpace>(exec_, 0, static_cast<int>(to.size())),
        kernel::FlagLaneParticle<Dim, Real, Device>{state_.memory.lanes, index_, state_.boundary.tractions,
                                                    static_cast<int>(first), flags});
    exec_.fence();
    const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), flags);
    std::copy_n(host.data(), to.size(), to.begin());
  }

 private:
  struct Columns {
    int column, count;  ///< in the lanes
    size_t columns;     ///< for the reader
  };
  static Columns columns_of(unsigned field) {
    using Cells = CellLanes<Dim, Real, Device>;
    switch (field) {
      case field::velocity:
        return {Cells::velocity_column, Dim, 3};
      case field::cauchy_stress:
        return {Cells::stress_column, Cells::stress_size, 6};
      case field::plastic_strain:
        return {Cells::state_column, Cells::stress_size, 6};
      case field::volume:
        return {Cells::volume_column, 1, 1};
      default:
        return {Cells::mass_column, 1, 1};
    }
  }

  ExecutionSpace exec_;
  const LaneState<Dim, Real, Device>& state_;
  LaneIndex<Device> index_;
};

}  // namespace vsb::app
