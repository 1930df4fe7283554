// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The particles that contribute to a node at which a traction acts: flag_p = 1 if chi_I != 0 at a support
/// node of p.
#pragma once

#include <vsb/views/nodes.hpp>
#include <vsb/views/particles.hpp>

namespace vsb {

namespace kernel {

template <class Basis, int Dim, class Real, class Device>
struct FlagBoundaryParticle {
  Particles<Dim, Real, Device> particles;
  BoundaryNodes<Device> boundary;
  Basis basis;
  Kokkos::View<unsigned char*, Device> flag;

  KOKKOS_FUNCTION void operator()(int p) const {
    const auto shape = basis.shape(particles.position_of(p));
    TractionMask any = 0;
    for (int a = 0; a < Basis::support; ++a) any |= boundary(shape.node[a]);
    flag(p) = any != 0;
  }
};

}  // namespace kernel

/// Overwrites flag[particle] with 0 or 1.
template <class Exec, class Basis, int Dim, class Real, class Device>
void flag_boundary_particles(const Exec& exec, const Particles<Dim, Real, Device>& particles,
                             const BoundaryNodes<Device>& boundary, const Basis& basis,
                             const Kokkos::View<unsigned char*, Device>& flag) {
  Kokkos::parallel_for(
      "vsb::flag_boundary_particles", Kokkos::RangePolicy<Exec>(exec, 0, particles.count()),
      kernel::FlagBoundaryParticle<Basis, Dim, Real, Device>{particles, boundary, basis, flag});
}

}  // namespace vsb
