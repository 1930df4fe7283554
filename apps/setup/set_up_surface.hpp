// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The points of the tractions that are not imposed through boundary nodes.
#pragma once

#include <vsb/views/surface_points.hpp>
#include "setup/loads.hpp"
#include "setup/scene_grid.hpp"

namespace vsb::app {

template <int Dim, class Real, class Device>
struct PlacedSurface {
  SurfacePoints<Dim, Real, Device> points;  ///< none, unless a traction is imposed on points
  TractionMask tractions = 0;               ///< of the points
};

template <class Real, class Device, class Basis>
PlacedSurface<Basis::dimension, Real, Device> place_surface_points(const Scene& scene, const Basis& basis,
                                                                   const PlacedParticles& placed) {
  constexpr int Dim = Basis::dimension;
  PlacedSurface<Dim, Real, Device> surface;
  auto points = loaded_points(scene, placed);
  const auto conforming =
      conforming_points<Dim>(scene, basis.grid, occupied_cells(scene, basis, placed).occupied);
  points.insert(points.end(), conforming.begin(), conforming.end());
  if (points.empty()) return surface;
  auto& s = surface.points;
  s = allocate_surface_points<Dim, Real, Device>(static_cast<int>(points.size()), basis.node_count(),
                                                 basis.bin_count());
  const auto position = Kokkos::create_mirror_view(s.position), area = Kokkos::create_mirror_view(s.area);
  const auto tractions = Kokkos::create_mirror_view(s.tractions);
  const auto carrier = Kokkos::create_mirror_view(s.carrier);
  const Point origin = local_origin(scene);
  for (size_t b = 0; b < points.size(); ++b) {
    for (size_t i = 0; i < Dim; ++i) {
      position(b, i) = static_cast<Real>(points[b].position[i] - origin[i]);
      area(b, i) = static_cast<Real>(points[b].area[i]);
    }
    tractions(b) = points[b].tractions;
    carrier(b) = points[b].carrier;
    surface.tractions |= points[b].tractions;
  }
  Kokkos::deep_copy(s.position, position);
  Kokkos::deep_copy(s.area, area);
  Kokkos::deep_copy(s.tractions, tractions);
  Kokkos::deep_copy(s.carrier, carrier);
  return surface;
}

}  // namespace vsb::app
