// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The equation of motion at the nodes, Eq. (9), with Cundall damping and prescribed components:
///   v_I = p_I / m_I,   f_I <- f_I - alpha |f_I| sign(v_I),   a_I = f_I / m_I,   v_I <- v_I + dt a_I;
/// a = v = 0 in a prescribed component; ghost nodes beyond walls follow their images.
///
/// Reads mass, momentum, force and fixed components; writes acceleration and velocity of all nodes.
#pragma once

#include <vsb/kernels/particles/mirror_nodes.hpp>
#include <vsb/physics/explicit_dynamics.hpp>
#include <vsb/views/nodes.hpp>

namespace vsb {

namespace kernel {

template <int Dim, class Real, class Device>
struct UpdateNode {
  Nodes<Dim, Real, Device> nodes;
  Real alpha;  ///< Cundall damping
  Real dt;     ///< s

  KOKKOS_FUNCTION void operator()(int I) const {
    const Real m = nodes.mass(I);
    for (int i = 0; i < Dim; ++i) {
      const bool fixed = nodes.fixed_components(I) >> i & 1;
      Real a = 0, v = 0;
      if (has_mass(m) && !fixed) {
        v = nodes.momentum(I, i) / m;
        a = cundall_damped(nodes.force(I, i), v, alpha) / m;
        v += dt * a;
      }
      nodes.acceleration(I, i) = a;
      nodes.velocity(I, i) = v;
    }
  }
};

}  // namespace kernel

/// One explicit step of all nodes. damping: alpha, dimensionless, 0 for none; dt in s.
template <class Exec, class Basis, int Dim, class Real, class Device>
void update_nodes(const Exec& exec, const Nodes<Dim, Real, Device>& nodes, const Basis& basis, Real damping,
                  Real dt) {
  Kokkos::parallel_for("vsb::update_nodes", Kokkos::RangePolicy<Exec>(exec, 0, nodes.count()),
                       kernel::UpdateNode<Dim, Real, Device>{nodes, damping, dt});
  mirror_vectors(exec, basis, nodes.acceleration);
  mirror_vectors(exec, basis, nodes.velocity);
}

}  // namespace vsb
