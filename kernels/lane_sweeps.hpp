// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The sweeps over cell lanes of one MUSL step, a layer each call:
///   A  mass, momentum and force of the nodes (kernels/lane_sums.hpp);
///   B  v_p <- v_p + dt sum_I N_Ip a_I (FLIP), and the momentum of the re-map, sum_p N_Ip m_p v_p;
///   C  L = sum_I v*_I (x) grad N_Ip,  sigma <- material(sigma, L dt),  V <- V det(I + dt L) or V exp(dt tr
///   L),
///      x_p <- x_p + dt sum_I N_Ip v_I; particles that leave their cell go to the layer's list of leavers;
///   C and A of the next step in one, while the particles are at hand.
///
/// The nodes bring dt a, dt v in cells and dt v* in cells, so that only sums are left for the particles.
#pragma once

#include <vsb/kernels/lane_plasticity.hpp>
#include <vsb/kernels/lane_tractions.hpp>
#include <vsb/physics/kinematics.hpp>

namespace vsb {

namespace kernel {

/// Sweep A.
template <bool Cubic, class Field, int Dim, class Real, class Device>
struct SumLanes {
  LoadedLanes<Dim, Real, Device> on;
  LaneNodes<Dim, Real, Device> nodes;
  Field virtual_stress;
  Kokkos::View<int*, Device> only;  ///< [layer]: 0 for those to leave alone; empty: none

  KOKKOS_FUNCTION void operator()(int layer) const {
    if (only.size() > 0 && only(layer) == 0) return;
    StepSums<Dim, Real, Device> sums(on.lanes, nodes, layer);
    for (int g = on.lanes.layer_first(layer); g < on.lanes.layer_first(layer + 1); ++g) {
      const auto& group = on.lanes.groups(g);
      sums.begin(group);
      sum_group_with<Cubic>(on, group, virtual_stress, sums);
    }
    sums.end();
  }
};

/// Sweep B.
template <int Dim, class Real, class Device>
struct AccelerateLanes {
  using P = typename Lanes<Real>::Pack;
  using Momentum = LayerSums<1, Dim, Dim, Real, Device>;
  CellLanes<Dim, Real, Device> lanes;
  LaneNodes<Dim, Real, Device> nodes;

  KOKKOS_FUNCTION void operator()(int layer) const {
    Momentum sums(lanes, nodes, layer);
    for (int g = lanes.layer_first(layer); g < lanes.layer_first(layer + 1); ++g) {
      const auto& group = lanes.groups(g);
      sums.begin(group);
      accelerate(group, sums);
    }
    sums.end();
  }
  [[gnu::noinline, gnu::flatten]] KOKKOS_FUNCTION void accelerate(const LaneGroup<Dim>& group,
                                                                  Momentum& sums) const {
    CellPolynomial<Dim, P> dv[Dim], p[Dim];
    static_for<Dim>([&](auto i)
                        VSB_UNROLLED { coefficients_of(nodes, nodes.increment_column + i, group, dv[i]); });
    for (size_t entry = lanes.begin(group); entry < lanes.end(group); entry += P::width) {
      const auto xi = lanes.load_xi(entry);
      static_for<Dim>([&](auto i) VSB_UNROLLED {
        const P v = lanes.load(lanes.velocity_column + i, entry);
        lanes.store(lanes.velocity_column + i, entry, v + value_at<Dim>(dv[i], xi));
      });
    }
    lane_sums::momentum(lanes, group, p);
    static_for<Dim>([&](auto i) VSB_UNROLLED { sums.add_moments(1 + i, group, p[i]); });
  }
};

/// Sweep C for one group.
template <bool Cubic, class Material, class Volume, int Dim, class Real, class Device>
struct MoveGroup {
  using P = typename Lanes<Real>::Pack;
  CellLanes<Dim, Real, Device> lanes;
  LaneNodes<Dim, Real, Device> nodes;
  UniformGrid<Dim, Real> grid;
  Material material;
  Volume volume;
  Leavers<Dim, Real, Device> leavers;

  [[gnu::noinline, gnu::flatten]] KOKKOS_FUNCTION void operator()(const LaneGroup<Dim>& group,
                                                                  int layer) const {
    CellPolynomial<Dim, P> dx[Dim], u[Dim];
    static_for<Dim>([&](auto i) VSB_UNROLLED {
      coefficients_of(nodes, nodes.displacement_column + i, group, dx[i]);
      coefficients_of(nodes, nodes.remapped_column + i, group, u[i]);
    });
    for (size_t entry = lanes.begin(group); entry < lanes.end(group); entry += P::width) {
      const auto xi = lanes.load_xi(entry);
      Matrix<Dim, P> L;  // dt L
      static_for<Dim>([&](auto i) VSB_UNROLLED {
        static_for<Dim>([&](auto j) VSB_UNROLLED {
          L(i, j) = derivative_at<j, Dim>(u[i], xi);
          if constexpr (!Cubic) L(i, j) *= P(grid.inverse_spacing[j] * grid.spacing[0]);
        });
      });
      advance(entry, L);
      const P V = lanes.load(lanes.volume_column, entry);
      lanes.store(lanes.volume_column, entry, volume(V, L, P(1)));
      Vector<Dim, P> moved;
      static_for<Dim>([&](auto i) VSB_UNROLLED { moved[i] = xi[i] + value_at<Dim>(dx[i], xi); });
      lanes.store_row(lanes.xi_column, entry, moved);
      if (!all_in_unit_cube(moved)) leave(group, layer, entry);
    }
  }
  KOKKOS_FORCEINLINE_FUNCTION static bool all_in_unit_cube(const Vector<Dim, P>& xi) {
    auto inside = (xi[0] >= P(0)) & (xi[0] < P(1));
    static_for<Dim>([&](auto i) VSB_UNROLLED {
      if constexpr (i > 0) inside = inside & (xi[i] >= P(0)) & (xi[i] < P(1));
    });
    return !any(!inside);
  }

  KOKKOS_FORCEINLINE_FUNCTION void advance(size_t entry, const Matrix<Dim, P>& L) const {
    constexpr int remembered = Material::template state_size<Dim>();
    const auto sigma = lanes.load_stress(entry);
    if constexpr (remembered == 0) {
      lanes.store_row(lanes.stress_column, entry, material.advance(sigma, L, P(1)));
    } else if constexpr (Material::plastic) {
      advance_plastic_lanes(lanes, material, entry, sigma, L);
    } else {
      // Lane by lane: such materials branch.
      for (int l = 0; l < P::width; ++l) {
        if (lanes.id(entry + static_cast<size_t>(l)) < 0) continue;  // a ghost may be strained without end
        Vector<remembered, Real> state;
        SymmetricTensor<Dim, Real> s;
        Matrix<Dim, Real> L_l;
        for (int c = 0; c < remembered; ++c) state[c] = *lanes.at(lanes.state_column + c, entry + l);
        for (int c = 0; c < s.size; ++c) s[c] = sigma[c][l];
        for (int i = 0; i < Dim; ++i)
          for (int j = 0; j < Dim; ++j) L_l(i, j) = L(i, j)[l];
        s = material.advance(s, state, L_l, Real(1));
        for (int c = 0; c < remembered; ++c) *lanes.at(lanes.state_column + c, entry + l) = state[c];
        for (int c = 0; c < s.size; ++c) *lanes.at(lanes.stress_column + c, entry + l) = s[c];
      }
    }
  }

  /// Takes the particles of a slot that left their cell to the layer's list.
  [[gnu::noinline]] KOKKOS_FUNCTION void leave(const LaneGroup<Dim>& group, int layer, size_t entry) const {
    for (int l = 0; l < P::width; ++l) {
      const size_t e = entry + static_cast<size_t>(l);
      if (lanes.id(e) < 0) {
        lanes.clear(e);  // ghosts are carried along, and outside their cell would grow without bound
        continue;
      }
      auto cell = lanes.cell(group, l);
      Vector<Dim, Real> xi;
      for (int i = 0; i < Dim; ++i) xi[i] = *lanes.at(lanes.xi_column + i, e);
      if (!to_next_cell(cell, xi)) continue;
      const int n = leavers.first(layer) + leavers.count(layer)++;
      for (int c = 0; c < lanes.columns(); ++c) leavers.data(n, c) = *lanes.at(c, e);
      for (int i = 0; i < Dim; ++i) leavers.data(n, lanes.xi_column + i) = xi[i];
      leavers.head(n) = {lanes.id(e), cell, false};
      lanes.clear(e);
    }
  }
  /// The cell in which a particle is and its place there; whether that is another cell than before. Round-off
  /// at a face of the grid counts as inside, as everywhere (UniformGrid::contains).
  KOKKOS_FUNCTION bool to_next_cell(Vector<Dim, int>& cell, Vector<Dim, Real>& xi) const {
    constexpr Real epsilon = std::numeric_limits<Real>::epsilon();
    bool out = false;
    for (int i = 0; i < Dim; ++i) {
      const Real round_off = 16 * static_cast<Real>(grid.cells[i]) * epsilon;
      if (xi[i] >= Real(0) && xi[i] < Real(1)) continue;
      if (cell[i] == 0 && xi[i] < Real(0) && xi[i] >= -round_off) continue;
      if (cell[i] == grid.cells[i] - 1 && xi[i] >= Real(1) && xi[i] <= Real(1) + round_off) continue;
      out = true;
      const Real whole = math::floor(xi[i]);
      if (!(math::abs(whole) < Real(1 << 20))) {
        cell[i] = -1;  // not finite, or nowhere near: outside the grid
        continue;
      }
      cell[i] += static_cast<int>(whole);
      xi[i] -= whole;
      if (xi[i] >= Real(1)) {  // from just below zero
        xi[i] = Real(0);
        ++cell[i];
      }
    }
    return out;
  }
};

/// Sweep C, and A of the next step.
template <bool Cubic, class Field, class Material, class Volume, int Dim, class Real, class Device>
struct MoveLanes {
  LoadedLanes<Dim, Real, Device> on;
  MoveGroup<Cubic, Material, Volume, Dim, Real, Device> move;
  Field virtual_stress;

  KOKKOS_FUNCTION void operator()(int layer) const {
    StepSums<Dim, Real, Device> sums(on.lanes, move.nodes, layer);
    move.leavers.count(layer) = 0;
    for (int g = on.lanes.layer_first(layer); g < on.lanes.layer_first(layer + 1); ++g) {
      const auto& group = on.lanes.groups(g);
      move(group, layer);
      sums.begin(group);
      sum_group_with<Cubic>(on, group, virtual_stress, sums);
    }
    sums.end();
  }
};

}  // namespace kernel

}  // namespace vsb
