// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The scene on cell lanes (kernels/lane_step.hpp).
#pragma once

#include "scene.hpp"

#include <vsb/kernels/lane_step.hpp>

namespace vsb::bench {

template <int Dim, class Real>
using Lane = LaneState<Dim, Real, Device>;

/// Declares the traction of the column's load and marks the nodes where it acts.
template <int Dim, class Real>
void apply_load(const Column<Dim, Real>& column, Lane<Dim, Real>& s) {
  auto& b = s.boundary;
  b.everywhere = column.load == Load::free_faces ? 1 : 0;
  b.declared = {};
  if (column.load == Load::end_face) {
    const BoundaryNodes<Device> declared("vsb::declared", static_cast<size_t>(column.basis.node_count()));
    const auto host = Kokkos::create_mirror_view(declared);
    for (int node = 0; node < column.basis.node_count(); ++node)
      host(static_cast<size_t>(node)) = column.declared_at(column.basis.grid.node_ijk(node)) ? 1 : 0;
    Kokkos::deep_copy(declared, host);
    b.declared = declared;
  }
  mark_packed_lanes(Exec(), s);
}

/// Lanes for the column's particles, which `pack(state)` packs.
template <int Dim, class Real, class Pack>
Lane<Dim, Real> make_lanes(const Column<Dim, Real>& column, const Pack& pack) {
  Lane<Dim, Real> s;
  s.memory.grid = column.basis.grid;
  if (column.options.damping > 0)  // at rest
    s.memory.walls.fixed[column.axis][0] = static_cast<ComponentMask>((1 << Dim) - 1);
  s.boundary.everywhere = column.load == Load::free_faces ? 1 : 0;
  if (pack(s) >= 0) throw std::runtime_error("a particle of the column is outside its grid");
  if (column.load == Load::end_face) apply_load(column, s);
  Kokkos::fence();
  return s;
}
template <int Dim, class Real>
Lane<Dim, Real> make_lanes(const Column<Dim, Real>& column) {
  return make_lanes(column, [&](auto& s) { return pack_lanes(Exec(), column.block.particles, s); });
}
/// The same, and the column is without its particles afterwards.
template <int Dim, class Real>
Lane<Dim, Real> make_lanes_of(Column<Dim, Real>& column) {
  return make_lanes(column, [&](auto& s) { return pack_lanes(Exec(), std::move(column.block), s); });
}

/// One step with a virtual stress field.
template <class Field, int Dim, class Real>
void step(const Column<Dim, Real>& column, Lane<Dim, Real>& s, const Field& field) {
  lane_step(Exec(), s, column.material, DeterminantVolume{}, field, column.options);
}

/// The column without load and support, on its way by so many cells per step in all directions.
template <int Dim, class Real>
Column<Dim, Real> make_moving_block(const Size& size, const Vector<Dim, double>& cells_per_step,
                                    Arrangement arrangement = Arrangement::jittered) {
  auto column = make_column<Dim, Real>(size, Load::off, 0, arrangement);
  column.options.damping = 0;
  column.options.gravity = Vector<Dim, Real>::zero();
  const auto host = host_copy(column.block);
  for (int p = 0; p < host.particles.count(); ++p)
    for (int i = 0; i < Dim; ++i)
      host.particles.velocity(p, i) +=
          static_cast<Real>(cells_per_step[i] * column.spacing()) / column.options.dt;
  copy_to_device(host, column.block);
  return column;
}

/// Bytes that the steps touch: particles with their ghosts, groups, nodes and marks; lists of migrating
/// particles are memory that nobody writes to while particles stay in their cells.
template <int Dim, class Real>
double state_bytes(const Lane<Dim, Real>& s) {
  const auto size = [](const auto& view) {
    return static_cast<double>(view.span() * sizeof(typename std::decay_t<decltype(view)>::value_type));
  };
  const auto& l = s.memory.lanes;
  const auto& n = s.memory.nodes;
  const auto& b = s.boundary;
  const double columns = static_cast<double>(l.slot_count) * l.width * l.columns() * sizeof(Real);
  return columns + size(l.id) + size(l.with_particle) + size(l.mass_matrices) + size(l.groups) +
         size(l.layer_first) + size(l.plane_first) + size(l.group_at) + size(l.node_group_at) + size(n.data) +
         size(n.fixed) + size(b.bits.occupied) + size(b.bits.exterior) + size(b.bits.boundary) +
         size(b.marked) + size(b.active) + size(b.changed) + size(b.tractions) + size(b.declared);
}

}  // namespace vsb::bench
