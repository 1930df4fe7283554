// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The column's load on surface points, with which the paper compares: on the material points of the
/// outermost layer, or on massless boundary particles on the faces beside them.
#pragma once

#include "scene.hpp"

#include <vsb/kernels/particles/assemble_forces.hpp>

namespace vsb::bench {

enum class Points { material, boundary };

/// Calls work(particle, direction, side) for every particle of the outermost layer at a loaded face.
template <int Dim, class Real, class Work>
void for_each_loaded(const Column<Dim, Real>& column, const Work& work) {
  const int across = column.size.cells_across * column.size.per_direction,
            along = column.size.cells_along * column.size.per_direction;
  for (int n = 0; n < column.block.particles.count(); ++n) {
    int k = n;
    for (int i = 0; i < Dim; ++i) {
      const bool is_axis = i == column.axis;
      const int extent = is_axis ? along : across, number = k % extent;
      k /= extent;
      if (!is_axis && column.load == Load::end_face) continue;
      if (number == extent - 1) work(n, i, 1);
      if (number == 0 && !is_axis) work(n, i, -1);
    }
  }
}

template <int Dim, class Real>
SurfacePoints<Dim, Real, Device> make_surface(const Column<Dim, Real>& column, Points kind) {
  int count = 0;
  for_each_loaded(column, [&](int, int, int) { ++count; });
  const auto points =
      allocate_surface_points<Dim, Real, Device>(count, column.basis.node_count(), column.basis.bin_count());
  const auto x = Kokkos::create_mirror_view(points.position), a = Kokkos::create_mirror_view(points.area);
  const auto tractions = Kokkos::create_mirror_view(points.tractions);
  const auto carrier = Kokkos::create_mirror_view(points.carrier);
  const auto host = host_copy(column.block);
  double area = 1;
  for (int i = 1; i < Dim; ++i) area *= column.spacing() / column.size.per_direction;
  size_t b = 0;
  for_each_loaded(column, [&](int n, int direction, int side) {
    for (int i = 0; i < Dim; ++i) {
      x(b, i) = host.particles.position(n, i);
      a(b, i) = i == direction ? static_cast<Real>(side * area) : Real(0);
    }
    const int cells = direction == column.axis ? column.size.cells_along : column.size.cells_across;
    if (kind == Points::boundary)
      x(b, direction) = side > 0 ? static_cast<Real>(cells * column.spacing()) : Real(0);
    carrier(b) = kind == Points::boundary ? static_cast<int>(carried_by_grid) : n;
    tractions(b) = 1;
    ++b;
  });
  Kokkos::deep_copy(points.position, x);
  Kokkos::deep_copy(points.area, a);
  Kokkos::deep_copy(points.tractions, tractions);
  Kokkos::deep_copy(points.carrier, carrier);
  return points;
}

}  // namespace vsb::bench
