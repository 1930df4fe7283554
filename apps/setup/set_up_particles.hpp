// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The bodies of a scene and the state in which their particles begin.
#pragma once

#include <algorithm>
#include <vsb/kernels/lanes/build.hpp>
#include <vsb/kernels/particles/update_stress.hpp>
#include <vsb/views/particles.hpp>
#include "setup/face_cover.hpp"
#include "setup/local_origin.hpp"
#include "setup/material_of.hpp"
#include "setup/place_particles.hpp"

namespace vsb::app {

/// Where the rows of material state of each body begin, body after body. Returns their number.
template <int Dim, class Real>
int number_states(std::vector<Body<Real>>& bodies) {
  int rows = 0;
  for (auto& body : bodies) {
    const bool has_state = state_size<Dim>(body.material) > 0;
    body.state_offset = has_state ? rows - body.first : 0;
    if (has_state) rows += body.last - body.first;
  }
  return rows;
}

template <int Dim, class Real>
std::vector<Body<Real>> bodies_of(const Scene& scene, const PlacedParticles& placed) {
  std::vector<Body<Real>> bodies;
  for (size_t b = 0; b < scene.bodies.size(); ++b)
    bodies.push_back(
        {placed.bodies[b].first, placed.bodies[b].last, material_of<Real>(scene.bodies[b].material)});
  number_states<Dim>(bodies);
  return bodies;
}

/// Zero-filled particles of these bodies, with the material state that they need; `to_pack`: to become those
/// of cell lanes.
template <int Dim, class Real, class Device>
ParticleBlock<Dim, Real, Device> allocate_bodies(std::vector<Body<Real>> bodies, bool to_pack) {
  int columns = 0;
  for (const auto& body : bodies) columns = std::max(columns, state_size<Dim>(body.material));
  const int count = bodies.back().last;
  auto block = to_pack ? allocate_particles_to_pack<Dim, Real, Device>(count, columns)
                       : allocate_particles<Dim, Real, Device>(count);
  if (const int rows = number_states<Dim>(bodies); rows > 0) allocate_material_state(block, rows, columns);
  return block;
}

/// The state of the start but for the material state. `ids`: the numbers at the start of the particles that
/// are left; empty where all are.
template <int Dim, class Real, class Device>
void fill_particles(const Scene& scene, const PlacedParticles& placed, const std::vector<int>& ids,
                    const std::vector<Body<Real>>& bodies, const ParticleBlock<Dim, Real, Device>& block) {
  const auto host = host_copy(block);
  const auto& p = host.particles;
  const Point origin = local_origin(scene);
  for (size_t b = 0; b < bodies.size(); ++b) {
    const auto& body = scene.bodies[b];
    const double filling = cell_filling(scene, body);
    for (int n = bodies[b].first; n < bodies[b].last; ++n) {
      const auto i = static_cast<size_t>(n), id = ids.empty() ? i : static_cast<size_t>(ids[i]);
      const Point& x = placed.position[id];
      const auto stress = body.stress.at(x);
      const auto velocity = body.velocity.at(x);
      for (size_t d = 0; d < Dim; ++d) {
        p.position(i, d) = static_cast<Real>(x[d] - origin[d]);
        p.velocity(i, d) = static_cast<Real>(velocity[d]);
      }
      for (size_t c = 0; c < SymmetricTensor<Dim, Real>::size; ++c)
        p.cauchy_stress(i, c) = static_cast<Real>(stress[c]);
      p.volume(i) = static_cast<Real>(filling * placed.volume[id]);
      p.mass(i) = static_cast<Real>(body.density * placed.volume[id]);
    }
  }
  Kokkos::deep_copy(block.block, host.block);
}

}  // namespace vsb::app
