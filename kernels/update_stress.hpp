// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The end of the step on the particles, with the basis functions at the old positions:
///   L = sum_I v*_I (x) grad N_Ip,   sigma <- material(sigma, L dt),   V <- V det(I + dt L) or V exp(dt tr
///   L), x_p <- x_p + dt sum_I N_Ip v_I   (v_I: before the re-map; v*_I: after it).
///
/// Reads both nodal velocities; writes positions, stresses and volumes.
#pragma once

#include <vector>
#include <vsb/physics/material.hpp>
#include <vsb/views/nodes.hpp>
#include <vsb/views/particles.hpp>

namespace vsb {

namespace kernel {

template <class Basis, class Material, class Volume, int Dim, class Real, class Device>
struct UpdateStress {
  Particles<Dim, Real, Device> particles;
  Nodes<Dim, Real, Device> nodes;
  Basis basis;
  Material material;
  Volume volume;
  Real dt;  ///< s

  KOKKOS_FUNCTION void operator()(int p) const {
    const auto x = particles.position_of(p);
    const auto shape = basis.shape(x);
    const auto L = shape.gradient(nodes.remapped_velocity);
    const auto v = shape.interpolate(nodes.velocity);
    const auto sigma = material.advance(particles.stress_of(p), L, dt);
    for (int c = 0; c < SymmetricTensor<Dim, Real>::size; ++c) particles.cauchy_stress(p, c) = sigma[c];
    particles.volume(p) = volume(particles.volume(p), L, dt);
    for (int i = 0; i < Dim; ++i) particles.position(p, i) = x[i] + dt * v[i];
  }
};

}  // namespace kernel

/// Particles first, ..., last - 1 and what they are made of.
template <class Real>
struct Body {
  int first, last;
  Material<Real> material;
};

/// Updates the particles of all bodies; dt in s.
template <class Exec, class Basis, int Dim, class Real, class Device>
void update_stress(const Exec& exec, const Particles<Dim, Real, Device>& particles,
                   const Nodes<Dim, Real, Device>& nodes, const std::vector<Body<Real>>& bodies,
                   const Basis& basis, const VolumeUpdate& volume_update, Real dt) {
  for (const auto& body : bodies)
    std::visit(
        [&](const auto& material, const auto& volume) {
          using Functor = kernel::UpdateStress<Basis, std::decay_t<decltype(material)>,
                                               std::decay_t<decltype(volume)>, Dim, Real, Device>;
          Kokkos::parallel_for("vsb::update_stress", Kokkos::RangePolicy<Exec>(exec, body.first, body.last),
                               Functor{particles, nodes, basis, material, volume, dt});
        },
        body.material, volume_update);
}

}  // namespace vsb
