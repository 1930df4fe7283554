// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The mean divergence thetabar_p of particles, with the functions M_c of physics/mean_divergence.hpp:
///   theta_p = sum_I v_I . grad N_Ip,   theta_c = sum_p V_p M_c(x_p) theta_p / sum_p V_p M_c(x_p),
///   thetabar_p = sum_c M_c(x_p) theta_c.
/// Sums run over the particles of one stiffness. A mean over particles of two stiffnesses in a cell would
/// make the stiffness matrix unsymmetric.
///
/// Reads positions, volumes, sorted bins and a nodal field; writes one number per particle.
#pragma once

#include <tuple>
#include <vector>
#include <vsb/kernels/body.hpp>
#include <vsb/kernels/particles/scatter.hpp>
#include <vsb/physics/mean_divergence.hpp>
#include <vsb/views/nodes.hpp>
#include <vsb/views/particles.hpp>

namespace vsb {

/// The mean divergence of the particles, with scratch memory; empty until average_divergence is called.
template <class Real, class Device>
struct MeanDivergence {
  using Numbers = Kokkos::View<Real*, Device>;  ///< one number per particle or function
  Numbers of_particle;  ///< [particle]: thetabar, 1/s (1 for displacements); not read where it is empty
  Numbers of_function;  ///< [function]: theta_c of one body
  typename ScatterWorkspace<Real, Device>::Target sums;  ///< [function][2]: V M_c, V M_c theta of one body
  ScatterWorkspace<Real, Device> workspace;              ///< of these sums
};

/// beta of a material, and 0 without a mean divergence.
template <int Dim, class Material, class Real, class Device>
Real share_of(const MeanDivergence<Real, Device>& mean, const Material& material) {
  return mean.of_particle.size() > 0 ? averaged_share<Dim>(material) : Real(0);
}

namespace kernel {

/// One particle into its functions: V M, V M theta.
template <class Basis, class Means, int Dim, class Real, class Device>
struct WeightedByVolume {
  static constexpr int columns = 2;
  Particles<Dim, Real, Device> particles;
  typename Nodes<Dim, Real, Device>::Fields velocity;
  Basis basis;
  Means means;
  typename ParticleBins<Device>::Ints bin;
  int first, last;

  template <class Sink>
  KOKKOS_FUNCTION void operator()(int p, const Sink& sink) const {
    if (p < first || p >= last) return;
    const auto x = particles.position_of(p);
    const auto shape = basis.shape(x);
    Real theta = 0;
    for (int a = 0; a < Basis::support; ++a)
      for (int i = 0; i < Dim; ++i) theta += velocity(shape.node[a], i) * shape.dN[a][i];
    const auto mean = means.at(x, bin(p));
    for (int a = 0; a < Means::support; ++a) {
      const Real MV = mean.M[a] * particles.volume(p);
      sink(a, mean.function[a], 0) += MV;
      sink(a, mean.function[a], 1) += MV * theta;
    }
  }
};

template <class Means, class Real, class Device>
struct DivideByVolume {
  Means means;
  typename ScatterWorkspace<Real, Device>::Target sums;
  typename MeanDivergence<Real, Device>::Numbers of_function;
  KOKKOS_FUNCTION void operator()(int c) const { of_function(c) = means.mean(c, sums); }
};

template <class Means, int Dim, class Real, class Device>
struct InterpolateDivergence {
  Particles<Dim, Real, Device> particles;
  Means means;
  typename ParticleBins<Device>::Ints bin;
  typename MeanDivergence<Real, Device>::Numbers of_function, of_particle;

  KOKKOS_FUNCTION void operator()(int p) const {
    const auto mean = means.at(particles.position_of(p), bin(p));
    Real theta = 0;
    for (int a = 0; a < Means::support; ++a) theta += mean.M[a] * of_function(mean.function[a]);
    of_particle(p) = theta;
  }
};

}  // namespace kernel

/// The constants in which bodies must agree to share one mean divergence: lambda, mu, and whether they are
/// plastic.
template <class Real>
std::tuple<Real, Real, bool> stiffness_of(const Material<Real>& material) {
  return std::visit(
      [](const auto& m) {
        const auto elastic = m.small_strain_law();
        return std::tuple<Real, Real, bool>(elastic.lambda, elastic.shear_modulus, m.plastic);
      },
      material);
}

/// Overwrites mean.of_particle with the mean divergence of the nodal field [node][Dim]. Bodies of one
/// stiffness that follow each other count as one.
template <class Exec, class Basis, int Dim, class Real, class Device>
void average_divergence(const Exec& exec, const Particles<Dim, Real, Device>& particles,
                        const ParticleBins<Device>& bins,
                        const typename Nodes<Dim, Real, Device>::Fields& velocity,
                        const std::vector<Body<Real>>& bodies, const Basis& basis,
                        MeanDivergence<Real, Device>& mean, Scatter strategy) {
  const auto means = means_of(basis);
  using Means = std::decay_t<decltype(means)>;
  const auto count = static_cast<size_t>(particles.count()),
             functions = static_cast<size_t>(means.node_count());
  if (mean.of_particle.extent(0) != count)
    mean.of_particle = typename MeanDivergence<Real, Device>::Numbers("vsb::mean_divergence", count);
  if (mean.sums.extent(0) != functions) {
    mean.sums = typename ScatterWorkspace<Real, Device>::Target("vsb::divergence_sums", functions, 2);
    mean.of_function = typename MeanDivergence<Real, Device>::Numbers("vsb::divergence_means", functions);
  }
  for (size_t b = 0; b < bodies.size();) {
    const int first = bodies[b].first;
    int last = bodies[b].last;
    const auto stiffness = stiffness_of(bodies[b].material);
    while (++b < bodies.size() && bodies[b].first == last && stiffness_of(bodies[b].material) == stiffness)
      last = bodies[b].last;
    scatter(exec, "vsb::sum_divergence", strategy, particles.count(), means, bins, mean.workspace,
            kernel::WeightedByVolume<Basis, Means, Dim, Real, Device>{particles, velocity, basis, means,
                                                                      bins.bin, first, last},
            mean.sums);
    Kokkos::parallel_for("vsb::divide_by_volume",
                         Kokkos::RangePolicy<Exec>(exec, 0, static_cast<int>(functions)),
                         kernel::DivideByVolume<Means, Real, Device>{means, mean.sums, mean.of_function});
    Kokkos::parallel_for("vsb::interpolate_divergence", Kokkos::RangePolicy<Exec>(exec, first, last),
                         kernel::InterpolateDivergence<Means, Dim, Real, Device>{
                             particles, means, bins.bin, mean.of_function, mean.of_particle});
  }
}

}  // namespace vsb
