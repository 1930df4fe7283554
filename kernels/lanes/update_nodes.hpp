// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The equation of motion at the nodes of cell lanes, Eq. (9) (see kernels/particles/update_nodes.hpp), a
/// node group each call:
///   first   v_I = p_I / m_I,  f_I <- damped(f_I + m_I g),  a_I = f_I / m_I;  stores dt a_I + eta v_I, eta
///           being the share of PIC, and, for PositionVelocity::grid, dt (v_I + dt a_I) in cells;
///   second  v*_I = p*_I / m_I, with the momentum p*_I of the re-map;  stores dt v*_I in cells.
/// Components prescribed at a node are zero. Node groups without mass are skipped; a moving body has some
/// ahead of it. The sums are set to zero, so that the next sweep can add to them.
#pragma once

#include <vsb/physics/explicit_dynamics.hpp>
#include <vsb/views/cell_lanes.hpp>

namespace vsb {

namespace kernel {

/// Planes: node planes to which a layer of cells adds, 3 with node-centred cells.
template <int Dim, class Real, class Device, int Planes = 2>
struct LaneNodeRows {
  using Nodes = LaneNodes<Dim, Real, Device>;
  using P = typename Lanes<Real>::Pack;
  Nodes nodes;

  /// Lower, middle and upper sums together.
  KOKKOS_FORCEINLINE_FUNCTION P sum(int column, int node) const {
    const P lower = nodes.load(nodes.lower_sums + column, node);
    if constexpr (Dim == 1) return lower;
    const P both = lower + nodes.load(nodes.upper_sums + column, node);
    return Planes == 2 ? both : both + nodes.load(nodes.middle_sums + column, node);
  }
  /// Sets sums to zero; for sums of node-centred cells the sweeps do so themselves.
  KOKKOS_FORCEINLINE_FUNCTION void clear(int column, int node) const {
    if (Planes == 3) return;
    P(Real(0)).store(nodes.at(nodes.lower_sums + column, node));
    if (Dim > 1) P(Real(0)).store(nodes.at(nodes.upper_sums + column, node));
  }
  /// Scales sums; those of node-centred cells are summed anew.
  KOKKOS_FORCEINLINE_FUNCTION void scale(int column, int node, P factor) const {
    if (Planes == 3) return;
    const auto scale_one = [&](int c) {
      const P scaled = factor * nodes.load(c, node);
      scaled.store(nodes.at(c, node));
    };
    scale_one(nodes.lower_sums + column);
    if (Dim > 1) scale_one(nodes.upper_sums + column);
  }
  /// Returns a sum and sets it to zero, while it is in the cache.
  KOKKOS_FORCEINLINE_FUNCTION P take_sum(int column, int node) const {
    const P s = sum(column, node);
    clear(column, node);
    return s;
  }
  /// Zero where component i is prescribed.
  KOKKOS_FORCEINLINE_FUNCTION P free_component(P value, int node_group, int i) const {
    const auto fixed = nodes.fixed(node_group, i);
    return fixed == 0 ? value : keep_lanes(~fixed, value);
  }
};

template <int Dim, class Real, class Device, int Planes = 2>
struct UpdateLaneNodes : LaneNodeRows<Dim, Real, Device, Planes> {
  using Base = LaneNodeRows<Dim, Real, Device, Planes>;
  using Base::nodes;
  using typename Base::P;
  Vector<Dim, Real> gravity;          ///< m/s^2
  Vector<Dim, Real> inverse_spacing;  ///< 1/m
  Real damping, pic, dt;
  bool keep_momentum;                  ///< whether the re-map adds to the share 1 - eta of it
  PositionVelocity position_velocity;  ///< grid: the displacement by v_I is stored too

  KOKKOS_FUNCTION void operator()(int node_group) const {
    const int node = node_group * P::width;
    const P m = this->take_sum(0, node);
    const auto massive = has_mass(m);
    if (!any(massive)) return leave_empty(node);
    const P inverse_mass = math::select(massive, P(Real(1)) / m, P(Real(0)));
    inverse_mass.store(nodes.at(nodes.inverse_mass_column, node));
    static_for<Dim>([&](auto i) VSB_UNROLLED {
      const P v = this->sum(1 + i, node) * inverse_mass;
      if (!keep_momentum)
        this->clear(1 + i, node);
      else if (pic > Real(0))
        this->scale(1 + i, node, P(Real(1) - pic));
      const P f = this->take_sum(1 + Dim + i, node) + m * P(gravity[i]);
      const P dv = cundall_damped(f, v, P(damping)) * inverse_mass * P(dt);
      this->free_component(dv + P(pic) * v, node_group, i).store(nodes.at(nodes.increment_column + i, node));
      if (position_velocity == PositionVelocity::strain) return;
      const P dx = (v + dv) * P(dt * inverse_spacing[i]);
      this->free_component(dx, node_group, i).store(nodes.at(nodes.displacement_column + i, node));
    });
  }
  /// Nodes without mass: clears their sums, since particles on the face of their cell can give such a node a
  /// force. Results are zero, and are written only where they were not zero before.
  KOKKOS_FUNCTION void leave_empty(int node) const {
    for (int c = 1; c < nodes.sum_columns; ++c) this->clear(c, node);
    if (!any(nodes.load(nodes.inverse_mass_column, node) > P(Real(0)))) return;
    for (int c = nodes.increment_column; c < nodes.column_count; ++c) P(Real(0)).store(nodes.at(c, node));
  }
};

template <int Dim, class Real, class Device, int Planes = 2>
struct RemapLaneNodes : LaneNodeRows<Dim, Real, Device, Planes> {
  using Base = LaneNodeRows<Dim, Real, Device, Planes>;
  using Base::nodes;
  using typename Base::P;
  Real factor;  ///< dt / h_0

  KOKKOS_FUNCTION void operator()(int node_group) const {
    const int node = node_group * P::width;
    const P scale = nodes.load(nodes.inverse_mass_column, node) * P(factor);
    static_for<Dim>([&](auto i) VSB_UNROLLED {
      const P p = this->take_sum(1 + i, node);
      this->free_component(p * scale, node_group, i).store(nodes.at(nodes.remapped_column + i, node));
    });
  }
};

}  // namespace kernel

}  // namespace vsb
