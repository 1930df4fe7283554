// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Particles outside the grid on the host: which they are, whether the state looks unstable, how an error
/// tells of them, and how they are kept readable.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "engine/leaving.hpp"
#include "engine/particle_engine.hpp"

namespace vsb::app {

/// Positions in the scene, by particle.
using OutsidePlaces = std::map<int, Point>;

/// The face that lets a particle at x outside the grid go.
inline std::optional<GridFace> outflow_face(const Scene& scene, const Point& x) {
  for (const auto& face : faces_passed(scene, x))
    if (scene.faces.outflow[face.axis][face.side]) return face;
  return {};
}

namespace detail {

template <class HostParticles>
double speed_of(const HostParticles& particles, int p) {
  const auto v = particles.velocity_of(p);
  double square = 0;
  for (int i = 0; i < v.size; ++i) square += static_cast<double>(v[i]) * static_cast<double>(v[i]);
  return std::sqrt(square);
}

}  // namespace detail

/// Throws Diverged where a particle has what only an unstable step gives. `when` is where messages begin.
template <int Dim, class Real, class HostParticles>
void refuse_unstable(const Model<Dim, Real>& model, const HostParticles& particles, const std::string& when) {
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const auto& body = model.bodies[b];
    const double modulus =
        std::visit([](const auto& m) { return double(m.constrained_modulus()); }, body.material);
    const double wave_speed = std::sqrt(modulus / model.scene.bodies[b].density);
    for (int p = body.first; p < body.last; ++p) {
      const double speed = detail::speed_of(particles, p);
      double stress = 0;
      const auto sigma = particles.stress_of(p);
      for (int c = 0; c < sigma.size; ++c) stress = std::max(stress, std::abs(static_cast<double>(sigma[c])));
      if (looks_unstable(speed, wave_speed, stress, modulus))
        throw Diverged(fmt::format(
            "{}: particles leave the grid, and particle {} moves at {:.3g} of the wave speed under {:.3g} of "
            "its modulus",
            when, model.id_of(p), speed / wave_speed, stress / modulus));
    }
  }
}

/// How the first particle that nothing lets go left the grid.
template <int Dim, class Real, class HostParticles>
std::string leave_text(const Model<Dim, Real>& model, const HostParticles& particles,
                       const OutsidePlaces& outside) {
  const auto& scene = model.scene;
  auto first = outside.begin();
  for (auto other = outside.begin(); other != outside.end(); ++other)
    if (!outflow_face(scene, other->second)) {
      first = other;
      break;
    }
  const auto& [p, x] = *first;
  const auto face = faces_passed(scene, x).front();
  const bool fixed = scene.faces.fixed[face.axis][face.side] != 0;
  const auto name = face_name(scene, face);
  return fmt::format(
      "particle {} left the grid at the {} face {}, at {}, moving at {:.3g} m/s{}; {}", model.id_of(p),
      fixed ? "fixed" : "open", name, position_text(scene, x), detail::speed_of(particles, p),
      outside.size() > 1 ? fmt::format(", and {} others in this step", outside.size() - 1) : "",
      fixed ? "a shorter time step may keep it inside"
            : fmt::format("make the grid larger, or let such particles go: faces.{} = \"outflow\"", name));
}

/// Particles and surface points outside go to a position in the grid, so that the engine can tell of them.
/// `host`: the engine's particles.
template <int Dim, class Real, class HostBlock>
void stand_in_grid(const Model<Dim, Real>& model, ParticleEngine<Dim, Real>& engine, const HostBlock& host,
                   const OutsidePlaces& outside) {
  const auto move_inside = [&](const auto& position, int n, const Point& x) {
    const auto inside = to_local<Vector<Dim, Real>>(nearest_inside(model.scene, x), model.origin);
    for (int i = 0; i < Dim; ++i) position(static_cast<size_t>(n), static_cast<size_t>(i)) = inside[i];
  };
  for (const auto& [p, x] : outside) move_inside(host.particles.position, p, x);
  copy_to_device(host, engine.block());
  const auto& points = engine.surface();
  if (points.count() == 0) return;
  const auto on_host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), points.position);
  for (int b = 0; b < points.count(); ++b) {
    Vector<Dim, Real> x;
    for (int i = 0; i < Dim; ++i) x[i] = on_host(static_cast<size_t>(b), static_cast<size_t>(i));
    if (!engine.contains(x)) move_inside(on_host, b, to_scene(x, model.origin));
  }
  Kokkos::deep_copy(points.position, on_host);
}

}  // namespace vsb::app
