// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Numbers of consecutive particles, computed where the particles are, on the host.
#pragma once

#include <vector>
#include <vsb/views/tensor.hpp>
#include "setup/execution_space.hpp"

namespace vsb::app {

/// [particle of the range][number].
using Rows = Kokkos::View<double**, Kokkos::LayoutRight, ExecutionSpace::device_type>;
using Flags = Kokkos::View<unsigned char*, ExecutionSpace::device_type>;

/// Runs functor(rows) for every row; `to` has `columns` numbers in each, and keeps those that are not
/// written.
template <class MakeFunctor>
void read_rows(const ExecutionSpace& exec, const std::string& label, size_t columns, const MakeFunctor& make,
               std::vector<double>& to) {
  const size_t count = to.size() / columns;
  const Rows rows("vsb::rows", count, columns);
  const auto host = Kokkos::create_mirror_view(rows);
  std::copy(to.begin(), to.end(), host.data());
  Kokkos::deep_copy(rows, host);
  Kokkos::parallel_for(label, Kokkos::RangePolicy<ExecutionSpace>(exec, 0, static_cast<int>(count)),
                       make(rows));
  exec.fence();
  Kokkos::deep_copy(host, rows);
  std::copy_n(host.data(), to.size(), to.begin());
}

}  // namespace vsb::app
