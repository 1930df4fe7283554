// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Grid to particles, FLIP with a share eta of PIC, v_I being the velocity at the end of the step:
///   v_p <- (1 - eta) (v_p + dt sum_I N_Ip a_I) + eta sum_I N_Ip v_I.
///
/// Reads positions, nodal accelerations and, where eta is not 0, velocities; writes velocities. update_stress
/// moves the particles later, since the re-map needs the basis functions at the old positions.
#pragma once

#include <vsb/views/nodes.hpp>
#include <vsb/views/particles.hpp>

namespace vsb {

namespace kernel {

template <class Basis, int Dim, class Real, class Device>
struct GridToParticles {
  Particles<Dim, Real, Device> particles;
  Nodes<Dim, Real, Device> nodes;
  Basis basis;
  Real pic;  ///< eta
  Real dt;   ///< s

  KOKKOS_FUNCTION void operator()(int p) const {
    const auto shape = basis.shape(particles.position_of(p));
    const auto a = shape.interpolate(nodes.acceleration);
    for (int i = 0; i < Dim; ++i) particles.velocity(p, i) += dt * a[i];
    if (pic == Real(0)) return;
    const auto v = shape.interpolate(nodes.velocity);
    for (int i = 0; i < Dim; ++i) particles.velocity(p, i) += pic * (v[i] - particles.velocity(p, i));
  }
};

}  // namespace kernel

/// Updates particle velocities; pic: eta, dimensionless, 0 for FLIP; dt in s.
template <class Exec, class Basis, int Dim, class Real, class Device>
void grid_to_particles(const Exec& exec, const Particles<Dim, Real, Device>& particles,
                       const Nodes<Dim, Real, Device>& nodes, const Basis& basis, Real pic, Real dt) {
  Kokkos::parallel_for("vsb::grid_to_particles", Kokkos::RangePolicy<Exec>(exec, 0, particles.count()),
                       kernel::GridToParticles<Basis, Dim, Real, Device>{particles, nodes, basis, pic, dt});
}

}  // namespace vsb
