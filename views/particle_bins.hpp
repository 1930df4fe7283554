// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Which particles share their support nodes.
#pragma once

#include <vsb/views/kokkos_compat.hpp>

namespace vsb {

/// Particles sorted by bin (see physics/linear_basis.hpp): those of occupied bin number s are
/// order(offset(occupied(s))), ..., order(offset(occupied(s) + 1) - 1), in increasing particle number, so
/// that a sum over a bin is the same whatever ran in parallel.
template <class Device>
struct ParticleBins {
  using Ints = Kokkos::View<int*, Device>;  ///< numbers of particles and bins
  Ints bin;       ///< [particle]: its bin, -1 before the first call of locate_particles
  Ints order;     ///< [particle]: particle numbers, sorted by bin
  Ints offset;    ///< [bins + 1]: where a bin starts in `order`
  Ints cursor;    ///< [bins]: scratch of the sort
  Ints slot;      ///< [bins]: number of the bin among the occupied ones, -1 where it is empty
  Ints occupied;  ///< [bins]: the occupied bins, in increasing order
  Kokkos::View<int, Kokkos::HostSpace> filled;  ///< how many are occupied; shared by copies, as the rest is

  /// How many bins hold a particle; 0 before the bins are allocated.
  int occupied_count() const { return filled.data() == nullptr ? 0 : filled(); }
};

/// Allocates bins in which no particle has been located yet.
template <class Device>
ParticleBins<Device> allocate_bins(int particles, int bins) {
  using Ints = typename ParticleBins<Device>::Ints;
  const auto n = static_cast<size_t>(particles), b = static_cast<size_t>(bins);
  ParticleBins<Device> result;
  result.bin = Ints("vsb::particle_bin", n);
  result.order = Ints("vsb::bin_order", n);
  result.offset = Ints("vsb::bin_offset", b + 1);
  result.cursor = Ints("vsb::bin_cursor", b);
  result.slot = Ints("vsb::bin_slot", b);
  result.occupied = Ints("vsb::bin_occupied", b);
  result.filled = decltype(result.filled)("vsb::bins_filled");
  Kokkos::deep_copy(result.bin, -1);
  return result;
}

}  // namespace vsb
