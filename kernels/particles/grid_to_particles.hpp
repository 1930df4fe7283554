// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Grid to particles, FLIP: v_p <- v_p + dt sum_I N_Ip a_I.
///
/// Reads positions and nodal accelerations; writes velocities. update_stress moves the particles later, since
/// the re-map needs the basis functions at the old positions.
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
  Real dt;  ///< s

  KOKKOS_FUNCTION void operator()(int p) const {
    const auto shape = basis.shape(particles.position_of(p));
    const auto a = shape.interpolate(nodes.acceleration);
    for (int i = 0; i < Dim; ++i) particles.velocity(p, i) += dt * a[i];
  }
};

}  // namespace kernel

/// Updates particle velocities; dt in s.
template <class Exec, class Basis, int Dim, class Real, class Device>
void grid_to_particles(const Exec& exec, const Particles<Dim, Real, Device>& particles,
                       const Nodes<Dim, Real, Device>& nodes, const Basis& basis, Real dt) {
  Kokkos::parallel_for("vsb::grid_to_particles", Kokkos::RangePolicy<Exec>(exec, 0, particles.count()),
                       kernel::GridToParticles<Basis, Dim, Real, Device>{particles, nodes, basis, dt});
}

}  // namespace vsb
