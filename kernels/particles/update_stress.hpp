// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The end of the step on the particles, with the basis functions at the old positions:
///   L = sum_I v*_I (x) grad N_Ip,   sigma <- material(sigma, L dt),
///   V <- V det(I + dt L) or V exp(dt tr L),   x_p <- x_p + dt sum_I N_Ip v*_I,
/// v*_I being the re-mapped velocity; PositionVelocity::grid moves by v_I, the velocity before the re-map.
/// Against volumetric locking a mean replaces the divergence of L (physics/mean_divergence.hpp).
///
/// Reads both nodal velocities and the mean divergence; writes positions, stresses and volumes, and the state
/// of a material that has one.
#pragma once

#include <algorithm>
#include <vector>
#include <vsb/kernels/particles/average_divergence.hpp>
#include <vsb/kernels/preconditions.hpp>
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
  PositionVelocity position_velocity;
  Real dt;                                                   ///< s
  int state_offset = 0;                                      ///< of Body
  typename MeanDivergence<Real, Device>::Numbers mean = {};  ///< [particle]: thetabar, where beta is not 0
  Real beta = 0;

  KOKKOS_FUNCTION void operator()(int p) const {
    const auto x = particles.position_of(p);
    const auto shape = basis.shape(x);
    auto L = shape.gradient(nodes.remapped_velocity);
    if (beta > Real(0)) L = with_mean_divergence(L, mean(p), beta);
    const auto v = shape.interpolate(nodes.velocity_for(position_velocity));
    const auto sigma = advance(p, L);
    for (int c = 0; c < SymmetricTensor<Dim, Real>::size; ++c) particles.cauchy_stress(p, c) = sigma[c];
    particles.volume(p) = volume(particles.volume(p), L, dt);
    for (int i = 0; i < Dim; ++i) particles.position(p, i) = x[i] + dt * v[i];
  }

  KOKKOS_FORCEINLINE_FUNCTION SymmetricTensor<Dim, Real> advance(int p, const Matrix<Dim, Real>& L) const {
    constexpr int remembered = Material::template state_size<Dim>();
    if constexpr (remembered == 0) {
      return material.advance(particles.stress_of(p), L, dt);
    } else {
      auto state = particles.template row<remembered>(particles.material_state, p + state_offset);
      const auto sigma = material.advance(particles.stress_of(p), state, L, dt);
      for (int c = 0; c < remembered; ++c) particles.material_state(p + state_offset, c) = state[c];
      return sigma;
    }
  }
};

}  // namespace kernel

/// Numbers that a material remembers per particle.
template <int Dim, class Real>
int state_size(const Material<Real>& material) {
  return std::visit([](const auto& m) { return m.template state_size<Dim>(); }, material);
}

/// Throws std::invalid_argument where the particles lack the state that a body's material remembers.
template <int Dim, class Real, class Device>
void check_material_state(const Particles<Dim, Real, Device>& particles, const Body<Real>& body) {
  check_material_state(particles, body.first + body.state_offset, body.last + body.state_offset,
                       state_size<Dim>(body.material));
}

/// Refuses a material whose stiffness is not a number, such as one that was never set.
template <class Material>
void check_material(const Material& material) {
  if (const double M = material.constrained_modulus(); !(M >= 0) || std::isinf(M))
    detail::refuse("the constrained modulus of a material is ", M,
                   " Pa: make materials by their functions from(...) and from_young(...)");
}

/// Refuses bodies where a particle is in none, so that it would not move, or in several, so that it would
/// advance twice.
template <class Real>
void check_bodies(const std::vector<Body<Real>>& bodies, int particles) {
  std::vector<std::pair<int, int>> ranges;
  int next = 0;  // the particle after those of the bodies so far, as long as these follow each other
  for (const auto& body : bodies) {
    std::visit([](const auto& material) { check_material(material); }, body.material);
    if (body.first < 0 || body.first > body.last || body.last > particles)
      detail::refuse("a body has the particles ", body.first, ", ..., last - 1 with last = ", body.last,
                     ", but there are ", particles, ": set Body::first and Body::last");
    if (body.first == next && ranges.empty())
      next = body.last;
    else if (body.first < body.last)
      ranges.emplace_back(body.first, body.last);
  }
  std::sort(ranges.begin(), ranges.end());
  for (const auto& [first, last] : ranges) {
    if (first < next)
      detail::refuse("particle ", first, " is in two bodies: Body::last is one past the last");
    if (first > next) break;
    next = last;
  }
  if (next < particles)
    detail::refuse(
        "particle ", next, " of ", particles,
        " is in no body, so that it would not move: pass a Body for it (Body::last is one past the "
        "last particle)");
}

/// Updates the particles of all bodies; dt in s. `mean` is what average_divergence made of the re-mapped
/// velocity; without it particles strain by their own divergence. Throws as check_material_state does.
template <class Exec, class Basis, int Dim, class Real, class Device>
void update_stress(const Exec& exec, const Particles<Dim, Real, Device>& particles,
                   const Nodes<Dim, Real, Device>& nodes, const std::vector<Body<Real>>& bodies,
                   const Basis& basis, const VolumeUpdate& volume_update, PositionVelocity position_velocity,
                   Real dt, const MeanDivergence<Real, Device>& mean = {}) {
  for (const auto& body : bodies) {
    check_material_state(particles, body);
    std::visit(
        [&](const auto& material, const auto& volume) {
          using Functor = kernel::UpdateStress<Basis, std::decay_t<decltype(material)>,
                                               std::decay_t<decltype(volume)>, Dim, Real, Device>;
          Kokkos::parallel_for("vsb::update_stress", Kokkos::RangePolicy<Exec>(exec, body.first, body.last),
                               Functor{particles, nodes, basis, material, volume, position_velocity, dt,
                                       body.state_offset, mean.of_particle, share_of<Dim>(mean, material)});
        },
        body.material, volume_update);
  }
}

}  // namespace vsb
