// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The re-map of MUSL: v*_I = sum_p N_Ip m_p v_p / m_I, with the updated particle velocities, the basis
/// functions at the old positions, and prescribed components zero.
///
/// Reads particles and nodal masses; writes the re-mapped velocity of all nodes.
#pragma once

#include <vsb/kernels/particles/mirror_nodes.hpp>
#include <vsb/kernels/particles/scatter.hpp>
#include <vsb/physics/explicit_dynamics.hpp>
#include <vsb/views/nodes.hpp>
#include <vsb/views/particles.hpp>

namespace vsb {

namespace kernel {

template <class Basis, int Dim, class Real, class Device>
struct RemapMomentum {
  static constexpr int columns = Dim;
  Particles<Dim, Real, Device> particles;
  Basis basis;

  template <class Sink>
  KOKKOS_FUNCTION void operator()(int p, const Sink& sink) const {
    const auto v = particles.velocity_of(p);
    const Real m = particles.mass(p);
    const auto shape = basis.shape(particles.position_of(p));
    for (int a = 0; a < Basis::support; ++a) {
      const Real Nm = shape.N[a] * m;
      for (int i = 0; i < Dim; ++i) sink(a, shape.node[a], i) += Nm * v[i];
    }
  }
};

/// Turns the re-mapped momentum into a velocity, in place.
template <int Dim, class Real, class Device>
struct RemapNode {
  Nodes<Dim, Real, Device> nodes;

  KOKKOS_FUNCTION void operator()(int I) const {
    const Real m = nodes.mass(I);
    for (int i = 0; i < Dim; ++i) {
      const bool fixed = nodes.fixed_components(I) >> i & 1;
      Real& v = nodes.remapped_velocity(I, i);
      v = has_mass(m) && !fixed ? v / m : Real(0);
    }
  }
};

}  // namespace kernel

/// Overwrites nodes.remapped_velocity.
template <class Exec, class Basis, int Dim, class Real, class Device>
void remap_velocity(const Exec& exec, const Particles<Dim, Real, Device>& particles,
                    const ParticleBins<Device>& bins, const Nodes<Dim, Real, Device>& nodes,
                    ScatterWorkspace<Real, Device>& workspace, const Basis& basis, Scatter strategy) {
  scatter(exec, "vsb::remap_momentum", strategy, particles.count(), basis, bins, workspace,
          kernel::RemapMomentum<Basis, Dim, Real, Device>{particles, basis}, nodes.remapped_velocity);
  fold_ghost_nodes(exec, basis, nodes.remapped_velocity, 0);
  Kokkos::parallel_for("vsb::remap_velocity", Kokkos::RangePolicy<Exec>(exec, 0, nodes.count()),
                       kernel::RemapNode<Dim, Real, Device>{nodes});
  mirror_vectors(exec, basis, nodes.remapped_velocity);
}

}  // namespace vsb
