// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Sums of N quantities over an index range, with the same bits for any number of threads: parts of fixed
/// size are summed in index order, then the parts in index order on the host.
#pragma once

#include <vsb/views/tensor.hpp>

namespace vsb {

namespace kernel {

template <int N, class Term, class Device>
struct SumChunk {
  static constexpr int size = 1024;
  Term term;
  int count;
  Kokkos::View<double**, Kokkos::LayoutRight, Device> partial;  ///< [part][N]

  KOKKOS_FUNCTION void operator()(int part) const {
    auto sum = Vector<N, double>::zero();
    const int end = math::min((part + 1) * size, count);
    for (int i = part * size; i < end; ++i) term(i, sum);
    for (int c = 0; c < N; ++c) partial(part, c) = sum[c];
  }
};

}  // namespace kernel

/// sum_i term(i), 0 <= i < count; term(i, sum) adds to a Vector<N, double>. Waits for the device.
template <int N, class Device, class Exec, class Term>
Vector<N, double> ordered_sum(const Exec& exec, const std::string& label, int count, const Term& term) {
  using PartialSum = kernel::SumChunk<N, Term, Device>;
  const int parts = (count + PartialSum::size - 1) / PartialSum::size;
  const Kokkos::View<double**, Kokkos::LayoutRight, Device> partial("vsb::partial_sums",
                                                                    static_cast<size_t>(parts), N);
  Kokkos::parallel_for(label, Kokkos::RangePolicy<Exec>(exec, 0, parts), PartialSum{term, count, partial});
  exec.fence();
  const auto host =
      Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), partial, "vsb::partial_sums on host");
  auto total = Vector<N, double>::zero();
  for (int part = 0; part < parts; ++part)
    for (int c = 0; c < N; ++c) total[c] += host(part, c);
  return total;
}

}  // namespace vsb
