// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Particles to grid, with the virtual stress fused in, Eq. (10), Eq. (11), Eq. (27), Eq. (28):
///   m_I = sum_p N_Ip m_p,   p_I = sum_p N_Ip m_p v_p,
///   f_I = sum_p -V_p (sigma_p - chi_I sbar) . grad N_Ip + N_Ip (m_p b + chi_I V_p fbar),
/// chi_I = 1 at the boundary nodes N1 of Algorithm 1. Sums at a boundary node run over all particles of its
/// support.
///
/// Reads particles and the traction masks of the nodes; writes mass, momentum and force of all nodes.
#pragma once

#include <vsb/kernels/particles/scatter.hpp>
#include <vsb/physics/virtual_stress.hpp>
#include <vsb/views/nodes.hpp>
#include <vsb/views/particles.hpp>

namespace vsb {

namespace kernel {

/// Adds the terms of one particle at its support nodes to sink(a, node, column), with the columns of
/// Nodes::sums.
template <class Shape, class Field, class Boundary, int Dim, class Real, class Sink>
KOKKOS_FORCEINLINE_FUNCTION void add_particle(const Shape& shape, const Vector<Dim, Real>& x,
                                              const Vector<Dim, Real>& v,
                                              const SymmetricTensor<Dim, Real>& sigma, Real m, Real V,
                                              const Field& virtual_stress, const Boundary& boundary,
                                              const Vector<Dim, Real>& gravity, const Sink& sink) {
  // Adds the terms at node a: `stress` is sigma - chi sbar, `body_force` is m b + chi V fbar.
  const auto add = [&](int a, const auto& stress, const auto& body_force) {
    const auto f = shape.N[a] * body_force - V * (stress * shape.dN[a]);
    const Real Nm = shape.N[a] * m;
    sink(a, shape.node[a], 0) += Nm;
    for (int i = 0; i < Dim; ++i) sink(a, shape.node[a], 1 + i) += Nm * v[i];
    for (int i = 0; i < Dim; ++i) sink(a, shape.node[a], 1 + Dim + i) += f[i];
  };
  if constexpr (Field::loaded) {
    // Most particles have no node of N1: they skip the virtual stress.
    TractionMask any = 0;
    for (int a = 0; a < Shape::support; ++a) any |= boundary(shape.node[a]);
    if (any != 0) {
      const TractionMask acting = virtual_stress.acting_at(x);
      auto stress = sigma;
      auto body_force = m * gravity;
      TractionMask chi = 0;
      for (int a = 0; a < Shape::support; ++a) {
        if ((boundary(shape.node[a]) & acting) != chi) {
          chi = boundary(shape.node[a]) & acting;
          const auto bar = virtual_stress.at(x, chi);
          stress = sigma - bar.stress;
          body_force = m * gravity + V * bar.divergence;
        }
        add(a, stress, body_force);
      }
      return;
    }
  }
  for (int a = 0; a < Shape::support; ++a) add(a, sigma, m * gravity);
}

template <class Basis, class Field, int Dim, class Real, class Device>
struct ParticlesToGrid {
  static constexpr int columns = Nodes<Dim, Real, Device>::sum_columns;
  Particles<Dim, Real, Device> particles;
  Basis basis;
  Field virtual_stress;
  BoundaryNodes<Device> boundary;
  Vector<Dim, Real> gravity;  ///< b, m/s^2

  template <class Sink>
  KOKKOS_FUNCTION void operator()(int p, const Sink& sink) const {
    const auto x = particles.position_of(p);
    add_particle(basis.shape(x), x, particles.velocity_of(p), particles.stress_of(p), particles.mass(p),
                 particles.volume(p), virtual_stress, boundary, gravity, sink);
  }
};

}  // namespace kernel

/// Overwrites nodes.sums. `boundary` is read only where `virtual_stress` is a loaded field.
template <class Exec, class Basis, class Field, int Dim, class Real, class Device>
void particles_to_grid(const Exec& exec, const Particles<Dim, Real, Device>& particles,
                       const ParticleBins<Device>& bins, const Nodes<Dim, Real, Device>& nodes,
                       const BoundaryNodes<Device>& boundary, ScatterWorkspace<Real, Device>& workspace,
                       const Basis& basis, const Field& virtual_stress, const Vector<Dim, Real>& gravity,
                       Scatter strategy) {
  const auto sum = [&](const auto& field) {
    scatter(exec, "vsb::particles_to_grid", strategy, particles.count(), basis, bins, workspace,
            kernel::ParticlesToGrid<Basis, std::decay_t<decltype(field)>, Dim, Real, Device>{
                particles, basis, field, boundary, gravity},
            nodes.sums);
  };
  if constexpr (Field::loaded)
    sum(virtual_stress);
  else
    sum(NoVirtualStress{});  // one kernel for all fields that do not act on particles
}

}  // namespace vsb
