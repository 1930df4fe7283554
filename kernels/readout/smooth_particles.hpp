// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Smooths a scalar q of the particles by a map to the nodes and back:
///   q_I = sum_p N_Ip m_p q_p / sum_p N_Ip m_p,   q_p <- sum_I N_Ip q_I.
/// The sum of m_p q_p does not change, nor does a uniform q.
///
/// Reads positions, masses and the sorted bins; overwrites q.
#pragma once

#include <vsb/kernels/particles/scatter.hpp>
#include <vsb/views/particles.hpp>

namespace vsb {

namespace kernel {

/// One particle into its nodes: N m, N m q.
template <class Basis, int Dim, class Real, class Device>
struct WeightedByMass {
  static constexpr int columns = 2;
  Particles<Dim, Real, Device> particles;
  Basis basis;
  Kokkos::View<const Real*, Device> q;

  template <class Sink>
  KOKKOS_FUNCTION void operator()(int p, const Sink& sink) const {
    const auto shape = basis.shape(particles.position_of(p));
    for (int a = 0; a < Basis::support; ++a) {
      const Real Nm = shape.N[a] * particles.mass(p);
      sink(a, shape.node[a], 0) += Nm;
      sink(a, shape.node[a], 1) += Nm * q(p);
    }
  }
};

template <class Basis, int Dim, class Real, class Device>
struct InterpolateMean {
  Particles<Dim, Real, Device> particles;
  Basis basis;
  typename ScatterWorkspace<Real, Device>::Target sums;
  Kokkos::View<Real*, Device> q;

  KOKKOS_FUNCTION void operator()(int p) const {
    const auto shape = basis.shape(particles.position_of(p));
    Real mean = 0;
    for (int a = 0; a < Basis::support; ++a) {
      const int node = shape.node[a];
      if (sums(node, 0) > Real(0)) mean += shape.N[a] * (sums(node, 1) / sums(node, 0));
    }
    q(p) = mean;
  }
};

}  // namespace kernel

/// Overwrites q [particle] with its smoothed values.
template <class Exec, class Basis, int Dim, class Real, class Device>
void smooth_particles(const Exec& exec, const Particles<Dim, Real, Device>& particles,
                      const ParticleBins<Device>& bins, const Basis& basis,
                      const Kokkos::View<Real*, Device>& q, Scatter strategy) {
  using Target = typename ScatterWorkspace<Real, Device>::Target;
  const Target sums("vsb::smoothing_sums", static_cast<size_t>(basis.node_count()), 2);
  ScatterWorkspace<Real, Device> workspace;
  scatter(exec, "vsb::sum_weighted_by_mass", strategy, particles.count(), basis, bins, workspace,
          kernel::WeightedByMass<Basis, Dim, Real, Device>{particles, basis, q}, sums);
  Kokkos::parallel_for("vsb::interpolate_mean", Kokkos::RangePolicy<Exec>(exec, 0, particles.count()),
                       kernel::InterpolateMean<Basis, Dim, Real, Device>{particles, basis, sums, q});
}

}  // namespace vsb
