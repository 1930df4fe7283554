// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Finds the bin of every particle, and sorts the particles by bin.
///
/// Reads positions of particles, or of another type with count() and position_of(); writes ParticleBins. The
/// sort is a stable counting sort: the order of particles within a bin does not depend on the number of
/// threads.
#pragma once

#include <vsb/kernels/preconditions.hpp>
#include <vsb/views/particle_bins.hpp>

namespace vsb {

/// What locate_particles found.
struct Whereabouts {
  bool changed;  ///< some particle is in another bin than before
  int lost;      ///< lowest number of a particle outside the grid (or at NaN), -1 where there is none
};

namespace kernel {

/// One particle: its bin. The reduction's minimum is p - n for a lost particle p of n, else 0 after a change
/// of bin, else 1.
template <class Basis, class Cloud, class Device>
struct LocateParticle {
  Cloud particles;
  Basis basis;
  typename ParticleBins<Device>::Ints bin;

  KOKKOS_FUNCTION void operator()(int p, int& minimum) const {
    const auto x = particles.position_of(p);
    int found = 1;
    if (!basis.contains(x)) {
      found = p - particles.count();
    } else {
      const int b = basis.bin(x);
      if (b != bin(p)) found = 0;
      bin(p) = b;
    }
    minimum = math::min(minimum, found);
  }
};

/// One particle: the lowest number of those outside a grid, or at NaN.
template <class Grid, class Cloud>
struct FindOutside {
  Cloud particles;
  Grid grid;
  KOKKOS_FUNCTION void operator()(int p, int& lowest) const {
    if (p < lowest && !grid.contains(particles.position_of(p))) lowest = p;
  }
};

template <class Device>
struct CountInBin {
  ParticleBins<Device> bins;
  KOKKOS_FUNCTION void operator()(int p) const { Kokkos::atomic_add(&bins.cursor(bins.bin(p)), 1); }
};

/// Exclusive sum of the bins' counts.
template <class Device>
struct ScanOffsets {
  ParticleBins<Device> bins;
  KOKKOS_FUNCTION void operator()(int b, int& sum, bool final) const {
    const int count = bins.cursor(b);
    if (final) {
      bins.offset(b) = sum;
      bins.cursor(b) = sum;
      if (b + 1 == static_cast<int>(bins.slot.extent(0))) bins.offset(b + 1) = sum + count;
    }
    sum += count;
  }
};

/// Numbers the occupied bins.
template <class Device>
struct ScanOccupied {
  ParticleBins<Device> bins;
  KOKKOS_FUNCTION void operator()(int b, int& sum, bool final) const {
    const bool filled = bins.offset(b + 1) > bins.offset(b);
    if (final) {
      bins.slot(b) = filled ? sum : -1;
      if (filled) bins.occupied(sum) = b;
    }
    if (filled) ++sum;
  }
};

template <class Device>
struct OrderByBin {
  ParticleBins<Device> bins;
  KOKKOS_FUNCTION void operator()(int p) const {
    bins.order(Kokkos::atomic_fetch_add(&bins.cursor(bins.bin(p)), 1)) = p;
  }
};

/// Insertion sort of one bin's particle numbers: short lists, mostly in order already.
template <class Device>
struct SortBin {
  ParticleBins<Device> bins;
  KOKKOS_FUNCTION void operator()(int s) const {
    const int begin = bins.offset(bins.occupied(s)), end = bins.offset(bins.occupied(s) + 1);
    for (int i = begin + 1; i < end; ++i) {
      const int p = bins.order(i);
      int j = i;
      for (; j > begin && bins.order(j - 1) > p; --j) bins.order(j) = bins.order(j - 1);
      bins.order(j) = p;
    }
  }
};

}  // namespace kernel

namespace detail {

/// The result of `look`, a LocateParticle of n particles or a functor that extends it, over `work` items.
template <class Exec, class Look, class Basis, class Device>
Whereabouts whereabouts(const Exec& exec, const Look& look, int work, int n, const ParticleBins<Device>& bins,
                        const Basis& basis) {
  require_accessible<Exec, Device>();
  check_rows("ParticleBins", bins.bin.extent(0), n,
             "after adding or removing particles (or points) call make_state, or allocate_bins, again");
  check_rows("ParticleBins::slot", bins.slot.extent(0), basis.bin_count(),
             "make the state, or the bins, with the basis of the step");
  int minimum = 1;
  Kokkos::parallel_reduce("vsb::locate_particles", Kokkos::RangePolicy<Exec>(exec, 0, work), look,
                          Kokkos::Min<int>(minimum));
  exec.fence();
  return {minimum <= 0, minimum < 0 ? minimum + n : -1};
}

}  // namespace detail

/// Updates bins.bin. Returns on the host, so it waits for the device.
template <class Exec, class Basis, class Cloud, class Device>
Whereabouts locate_particles(const Exec& exec, const Cloud& particles, const ParticleBins<Device>& bins,
                             const Basis& basis) {
  const int n = particles.count();
  return detail::whereabouts(exec, kernel::LocateParticle<Basis, Cloud, Device>{particles, basis, bins.bin},
                             n, n, bins, basis);
}

/// The lowest number of a particle outside a grid (or that of a basis) or at NaN, -1 where there is none.
/// Waits for the device.
template <class Exec, class Cloud, class Grid>
int find_outside(const Exec& exec, const Cloud& particles, const Grid& grid) {
  const int n = particles.count();
  int lowest = n;
  Kokkos::parallel_reduce("vsb::find_outside", Kokkos::RangePolicy<Exec>(exec, 0, n),
                          kernel::FindOutside<Grid, Cloud>{particles, grid}, Kokkos::Min<int>(lowest));
  exec.fence();
  return lowest < n ? lowest : -1;
}

/// Sorts the particles by the bins that locate_particles found. Waits for the device.
template <class Exec, class Device>
void sort_by_bin(const Exec& exec, ParticleBins<Device>& bins) {
  const int particles = static_cast<int>(bins.bin.extent(0)),
            bin_count = static_cast<int>(bins.slot.extent(0));
  const Kokkos::RangePolicy<Exec> over_particles(exec, 0, particles), over_bins(exec, 0, bin_count);
  Kokkos::deep_copy(exec, bins.cursor, 0);
  Kokkos::parallel_for("vsb::count_in_bin", over_particles, kernel::CountInBin<Device>{bins});
  Kokkos::parallel_scan("vsb::scan_offsets", over_bins, kernel::ScanOffsets<Device>{bins});
  Kokkos::parallel_for("vsb::order_by_bin", over_particles, kernel::OrderByBin<Device>{bins});
  int occupied = 0;
  Kokkos::parallel_scan("vsb::scan_occupied", over_bins, kernel::ScanOccupied<Device>{bins}, occupied);
  exec.fence();
  bins.filled() = occupied;
  Kokkos::parallel_for("vsb::sort_bin", Kokkos::RangePolicy<Exec>(exec, 0, occupied),
                       kernel::SortBin<Device>{bins});
}

}  // namespace vsb
