// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What both engines take of a scene: its bodies, loads and options as the kernels take them, and which of
/// the particles of the start are left.
#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include <vsb/kernels/readout/resultant.hpp>
#include "engine/keep_particles.hpp"
#include "setup/loads.hpp"
#include "setup/set_up_particles.hpp"
#include "setup/step_options.hpp"

namespace vsb::app {

template <int Dim, class Real>
class ParticleEngine;

template <int Dim, class Real>
struct Model {
  using Device = ExecutionSpace::device_type;

  explicit Model(const Scene& s) : scene(s), origin(local_origin(s)), loads(s, origin) {}

  /// Enters the particles that were placed.
  void place(const PlacedParticles& placed) {
    near = to_local<Vector<Dim, Real>>(placed.position.front(), origin);
    bodies = bodies_of<Dim, Real>(scene, placed);
    carried_at_start = carried_by_particles(scene, placed);
    covers_at_start = placed.covers;
    carried.particle = carried_view();
    carried.tractions = carried_tractions(scene);
    cover = cover_view();
    options = step_options<Dim, Real>(scene);
  }

  int particle_count() const { return bodies.back().last; }
  /// The number that a particle had at the start.
  int id_of(int p) const { return ids.empty() ? p : ids[static_cast<size_t>(p)]; }

  /// Takes the particles with a 1 out of the bodies, and out of all that is told per particle here. Returns
  /// the others, for the engine that holds them.
  Kept keep(const std::vector<unsigned char>& removed, const std::vector<CutStarts>& starts) {
    auto kept = keep_in_bodies<Dim>(bodies, removed);
    std::vector<int> left;
    for (const int p : kept.particles) left.push_back(id_of(p));
    const bool first_goes = left.front() != id_of(0);
    ids = std::move(left);
    carried.particle = carried_view();
    cover = cover_view();
    int id = 0;
    if (first_goes)
      for_each_start(scene, starts, [&](const Point& x) {
        if (id++ == ids.front()) near = to_local<Vector<Dim, Real>>(x, origin);
      });
    return kept;
  }

  Scene scene;
  Point origin;  ///< from where positions are counted
  Loads<Dim, Real> loads;
  StepOptions<Dim, Real> options{};
  std::vector<Body<Real>> bodies;
  std::vector<int> ids;                      ///< of the particles that are left; empty before a removal
  Vector<Dim, Real> near;                    ///< where the first particle began
  BoundaryNodes<Device> declared;            ///< [node of the basis' grid]: the tractions declared there
  CarriedTractions<Device> carried;          ///< those that the particles carry
  FaceCover<Device> cover;                   ///< what the particles cover of the faces of the grid
  SurfacePoints<Dim, Real, Device> surface;  ///< none, unless a traction is imposed on points
  bool for_lanes = false;                    ///< whether cell lanes make the steps
  /// Called where particles are found outside the grid: `lost` is one of them, or the number of particles
  /// plus that of a surface point. Lets the particles go, or throws LeftGrid or Diverged.
  std::function<void(ParticleEngine<Dim, Real>& engine, int lost)> let_go;

  std::vector<TractionMask> carried_at_start;  ///< [particle at the start]; empty where none carries any
  std::vector<PlacedCover> covers_at_start;

 private:
  Kokkos::View<TractionMask*, Device> carried_view() const {
    const auto count = carried_at_start.empty() ? 0 : static_cast<size_t>(particle_count());
    const Kokkos::View<TractionMask*, Device> view("vsb::carried_tractions", count);
    const auto host = Kokkos::create_mirror_view(view);
    for (size_t p = 0; p < count; ++p)
      host(p) = carried_at_start[static_cast<size_t>(id_of(static_cast<int>(p)))];
    Kokkos::deep_copy(view, host);
    return view;
  }
  FaceCover<Device> cover_view() const {
    if (covers_at_start.empty()) return {};
    const Kokkos::View<float**, Device> view("vsb::face_cover", static_cast<size_t>(particle_count()), Dim);
    const auto host = Kokkos::create_mirror_view(view);
    Kokkos::deep_copy(host, -1.0f);
    auto next = covers_at_start.begin();  // in order of the particles, as ids are
    for (int p = 0; p < particle_count(); ++p) {
      while (next != covers_at_start.end() && next->particle < id_of(p)) ++next;
      for (; next != covers_at_start.end() && next->particle == id_of(p); ++next)
        host(static_cast<size_t>(p), next->axis) = static_cast<float>(next->cover);
    }
    Kokkos::deep_copy(view, host);
    return view;
  }
};

}  // namespace vsb::app
