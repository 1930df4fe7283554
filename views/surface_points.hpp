// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Points that carry a piece of a loaded surface.
#pragma once

#include <vsb/views/masks.hpp>
#include <vsb/views/particle_bins.hpp>
#include <vsb/views/tensor.hpp>

namespace vsb {

/// What moves a surface point: the number of its particle (a loaded material point), or one of these.
enum SurfaceCarrier : int {
  carried_by_grid = -1,  ///< a massless boundary particle, moved with the velocity of the grid
  carried_by_none = -2,  ///< a conforming load at a node: position and area are constant
};

/// Surface points, one row each, with the nodal sums of their forces. Without points nothing is allocated.
template <int Dim, class Real, class Device>
struct SurfacePoints {
  using Fields = Kokkos::View<Real**, Kokkos::LayoutRight, Device>;  ///< one row per point or node
  Fields position;                                                   ///< [point][Dim], m
  Fields area;  ///< [point][Dim]: area times outward unit normal of the deformed surface, m^2 (1 in 1D, m
                ///< in 2D)
  Kokkos::View<TractionMask*, Device> tractions;  ///< [point]: the tractions that act on it
  Kokkos::View<int*, Device> carrier;             ///< [point]: see SurfaceCarrier
  Fields force;                                   ///< [point][Dim]: traction times area, N
  ParticleBins<Device> bins;                      ///< which points share their support nodes
  Fields node_force;                              ///< [node][Dim], N

  /// Number of surface points.
  KOKKOS_FUNCTION int count() const { return static_cast<int>(position.extent(0)); }
  /// The position of a point, m.
  KOKKOS_FUNCTION Vector<Dim, Real> position_of(int b) const { return row(position, b); }
  /// Area times outward unit normal of a point; m^2 (1 in 1D, m in 2D).
  KOKKOS_FUNCTION Vector<Dim, Real> area_of(int b) const { return row(area, b); }
  /// Traction times area of a point, N.
  KOKKOS_FUNCTION Vector<Dim, Real> force_of(int b) const { return row(force, b); }

 private:
  KOKKOS_FUNCTION static Vector<Dim, Real> row(const Fields& field, int b) {
    Vector<Dim, Real> v;
    for (int i = 0; i < Dim; ++i) v[i] = field(b, i);
    return v;
  }
};

/// Allocates points at rest in the origin, without area, tractions or carrier.
template <int Dim, class Real, class Device>
SurfacePoints<Dim, Real, Device> allocate_surface_points(int points, int nodes, int bins) {
  using Points = SurfacePoints<Dim, Real, Device>;
  const auto n = static_cast<size_t>(points);
  Points s;
  s.position = typename Points::Fields("vsb::surface_position", n, Dim);
  s.area = typename Points::Fields("vsb::surface_area", n, Dim);
  s.tractions = decltype(s.tractions)("vsb::surface_tractions", n);
  s.carrier = decltype(s.carrier)("vsb::surface_carrier", n);
  s.force = typename Points::Fields("vsb::surface_force", n, Dim);
  s.bins = allocate_bins<Device>(points, bins);
  s.node_force = typename Points::Fields("vsb::surface_node_force", static_cast<size_t>(nodes), Dim);
  return s;
}

}  // namespace vsb
