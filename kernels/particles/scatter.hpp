// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Sums over particles into nodes, target(I, c) = sum_p contribution_p(I, c), in one of three ways.
///
/// A contribution is a functor with `columns` and operator()(p, sink): for every support node a of particle p
/// it adds to sink(a, node, c), c < columns. It is the same functor in all three ways:
/// - atomic: Kokkos scatter view, one target, atomic additions. Little memory; the last bits vary from run to
///   run.
/// - duplicated: Kokkos scatter view, one target per thread, added up at the end. The last bits vary with the
///   number of threads.
/// - gathered: sums per bin in increasing particle number, then per node in fixed order over its bins. The
///   same bits for any number of threads and any backend. Needs bins sorted by sort_by_bin.
#pragma once

#include <Kokkos_ScatterView.hpp>
#include <vsb/kernels/preconditions.hpp>
#include <vsb/views/particle_bins.hpp>

namespace vsb {

/// How the sums are made; the top of this file compares the three ways.
enum class Scatter { atomic, duplicated, gathered };

/// Memory that scatter keeps between calls; one for each target.
template <class Real, class Device>
struct ScatterWorkspace {
  using Target = Kokkos::View<Real**, Kokkos::LayoutRight, Device>;  ///< [node][column]: where sums go
  /// What Kokkos duplicates per thread.
  using Duplicated =
      Kokkos::Experimental::ScatterView<Real**, Kokkos::LayoutRight, Device, Kokkos::Experimental::ScatterSum,
                                        Kokkos::Experimental::ScatterDuplicated,
                                        Kokkos::Experimental::ScatterNonAtomic>;
  Target bin_sums;        ///< [occupied bin][support node x column], for Scatter::gathered
  Duplicated duplicated;  ///< one copy of the target per thread, for Scatter::duplicated
};

namespace kernel {

template <class Access>
struct ScatterViewSink {
  const Access& access;
  KOKKOS_FUNCTION auto operator()(int, int node, int c) const { return access(node, c); }
};

template <class ScatterView, class Contribution>
struct ScatterParticle {
  ScatterView scatter;
  Contribution contribution;
  KOKKOS_FUNCTION void operator()(int p) const {
    const auto access = scatter.access();
    contribution(p, ScatterViewSink<decltype(access)>{access});
  }
};

template <class Real, int Support, int Columns>
struct BinSink {
  Real (&sums)[Support][Columns];
  KOKKOS_FUNCTION Real& operator()(int a, int, int c) const { return sums[a][c]; }
};

/// One occupied bin: the sums over its particles, per support node.
template <class Contribution, int Support, class Real, class Device>
struct SumBin {
  Contribution contribution;
  ParticleBins<Device> bins;
  typename ScatterWorkspace<Real, Device>::Target bin_sums;

  KOKKOS_FUNCTION void operator()(int slot) const {
    constexpr int columns = Contribution::columns;
    Real sums[Support][columns] = {};
    const int b = bins.occupied(slot), end = bins.offset(b + 1);
    for (int k = bins.offset(b); k < end; ++k)
      contribution(bins.order(k), BinSink<Real, Support, columns>{sums});
    for (int a = 0; a < Support; ++a)
      for (int c = 0; c < columns; ++c) bin_sums(slot, a * columns + c) = sums[a][c];
  }
};

/// One node: the sum over the bins that have it among their support nodes.
template <class Basis, int Columns, class Real, class Device>
struct SumNode {
  Basis basis;
  ParticleBins<Device> bins;
  typename ScatterWorkspace<Real, Device>::Target bin_sums, target;

  KOKKOS_FUNCTION void operator()(int node) const {
    Real total[Columns] = {};
    for (int a = 0; a < Basis::support; ++a) {
      const int b = basis.bin_of_node(node, a);
      const int slot = b < 0 ? -1 : bins.slot(b);
      if (slot < 0) continue;
      for (int c = 0; c < Columns; ++c) total[c] += bin_sums(slot, a * Columns + c);
    }
    for (int c = 0; c < Columns; ++c) target(node, c) = total[c];
  }
};

template <class Exec, class ScatterView, class Contribution>
void scatter_through_view(const Exec& exec, const std::string& label, int particles, const ScatterView& view,
                          const Contribution& contribution) {
  Kokkos::parallel_for(label, Kokkos::RangePolicy<Exec>(exec, 0, particles),
                       ScatterParticle<ScatterView, Contribution>{view, contribution});
}

}  // namespace kernel

/// Overwrites target [node][columns] with the sums of the contributions of `particles` particles. `label`
/// names the kernel. Throws std::invalid_argument for Scatter::duplicated on a device.
template <class Exec, class Basis, class Contribution, class Real, class Device>
void scatter(const Exec& exec, const std::string& label, Scatter strategy, int particles, const Basis& basis,
             const ParticleBins<Device>& bins, ScatterWorkspace<Real, Device>& workspace,
             const Contribution& contribution,
             const typename ScatterWorkspace<Real, Device>::Target& target) {
  namespace ke = Kokkos::Experimental;
  constexpr int columns = Contribution::columns;
  require_accessible<Exec, Device>();
  detail::check_rows("the target of a sum over particles", target.extent(0), basis.node_count(),
                     "allocate it with the basis of the sum");
  if (strategy == Scatter::gathered) {
    detail::check_rows("ParticleBins::order", bins.order.extent(0), particles,
                       "after adding or removing particles call make_state, or allocate_bins, again");
    if (bins.occupied_count() == 0 && particles > 0)
      detail::refuse(
          "the particles are not sorted by bin: call update_occupancy, or locate_particles and "
          "sort_by_bin, before a sum over them");
    const auto slots = static_cast<size_t>(bins.occupied_count());
    const size_t width = static_cast<size_t>(Basis::support * columns);
    auto& sums = workspace.bin_sums;
    if (sums.extent(0) < slots || sums.extent(1) != width)
      sums = typename ScatterWorkspace<Real, Device>::Target(
          Kokkos::view_alloc("vsb::bin_sums", Kokkos::WithoutInitializing), slots + slots / 8, width);
    Kokkos::parallel_for(
        label, Kokkos::RangePolicy<Exec>(exec, 0, bins.occupied_count()),
        kernel::SumBin<Contribution, Basis::support, Real, Device>{contribution, bins, sums});
    Kokkos::parallel_for(label + "/nodes", Kokkos::RangePolicy<Exec>(exec, 0, basis.node_count()),
                         kernel::SumNode<Basis, columns, Real, Device>{basis, bins, sums, target});
  } else if (strategy == Scatter::atomic) {
    Kokkos::deep_copy(exec, target, Real(0));
    using View = ke::ScatterView<Real**, Kokkos::LayoutRight, Device, ke::ScatterSum,
                                 ke::ScatterNonDuplicated, ke::ScatterAtomic>;
    kernel::scatter_through_view(exec, label, particles, View(target), contribution);
  } else {
    if constexpr (Kokkos::SpaceAccessibility<Kokkos::HostSpace, typename Device::memory_space>::accessible) {
      auto& copies = workspace.duplicated;
      if (copies.is_allocated())
        copies.reset(exec);
      else
        copies = typename ScatterWorkspace<Real, Device>::Duplicated(
            Kokkos::view_alloc(exec, "vsb::duplicated_sums"), target.extent(0), target.extent(1));
      kernel::scatter_through_view(exec, label, particles, copies, contribution);
      Kokkos::deep_copy(exec, target, Real(0));
      copies.contribute_into(exec, target);
    } else {
      throw std::invalid_argument("vsb::scatter: Scatter::duplicated is for hosts; use gathered or atomic");
    }
  }
}

}  // namespace vsb
