// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The sweeps over cell lanes of one MUSL step, a layer each call:
///   A  mass, momentum and force of the nodes (kernels/lane_sums.hpp);
///   B  v_p <- v_p + dt sum_I N_Ip a_I (FLIP), and the momentum of the re-map, sum_p N_Ip m_p v_p;
///   C  L = sum_I v*_I (x) grad N_Ip,  sigma <- material(sigma, L dt),  V <- V det(I + dt L) or V exp(dt tr L),
///      x_p <- x_p + dt sum_I N_Ip v_I; particles that leave their cell go to the layer's list of leavers;
///   C and A of the next step in one, while the particles are at hand.
///
/// The nodes bring dt a, dt v in cells and dt v* in cells, so that only sums are left for the particles.
#pragma once

#include <vsb/kernels/lane_sums.hpp>
#include <vsb/physics/kinematics.hpp>

namespace vsb {

namespace kernel {

/// Sweep A.
template <int Dim, class Real, class Device, bool Cubic, class Field>
struct SumLanes {
  LaneSums<Dim, Real, Device, Cubic> sums;
  LaneNodes<Dim, Real, Device> nodes;
  Field virtual_stress;

  [[gnu::flatten]] KOKKOS_FUNCTION void operator()(int layer) const {
    const auto& lanes = sums.lanes;
    typename LaneSums<Dim, Real, Device, Cubic>::Sums of_layer(lanes, nodes, layer);
    for (int g = lanes.layer_first(layer); g < lanes.layer_first(layer + 1); ++g) {
      of_layer.begin(lanes.groups(g));
      sums(lanes.groups(g), of_layer, virtual_stress);
    }
    of_layer.end();
  }
};

/// Sweep B.
template <int Dim, class Real, class Device, bool Cubic>
struct AccelerateLanes {
  using P = typename Lanes<Real>::Pack;
  LaneSums<Dim, Real, Device, Cubic> sums;
  LaneNodes<Dim, Real, Device> nodes;

  [[gnu::flatten]] KOKKOS_FUNCTION void operator()(int layer) const {
    const auto lanes = sums.lanes;
    LayerSums<1, Dim, Dim, Real, Device> of_layer(lanes, nodes, layer);
    for (int g = lanes.layer_first(layer); g < lanes.layer_first(layer + 1); ++g) {
      const auto& group = lanes.groups(g);
      of_layer.begin(group);
      CellPolynomial<Dim, P> dv[Dim];
      static_for<Dim>([&](auto i) { dv[i] = coefficients_of(nodes, nodes.increment_column + i, group); });
      for (size_t entry = lanes.begin(group); entry < lanes.end(group); entry += P::width) {
        const auto xi = lanes.load_xi(entry);
        static_for<Dim>([&](auto i) {
          lanes.store(lanes.velocity_column + i, entry,
                      lanes.load(lanes.velocity_column + i, entry) + value_at<Dim>(dv[i], xi));
        });
      }
      sums.momentum(group, of_layer);
    }
    of_layer.end();
  }
};

/// Sweep C, and A of the next step.
template <int Dim, class Real, class Device, bool Cubic, class Field, class Material, class Volume>
struct MoveLanes {
  using P = typename Lanes<Real>::Pack;
  LaneSums<Dim, Real, Device, Cubic> sums;
  LaneNodes<Dim, Real, Device> nodes;
  Field virtual_stress;
  Material material;
  Volume volume;
  Leavers<Dim, Real, Device> leavers;

  [[gnu::flatten]] KOKKOS_FUNCTION void operator()(int layer) const {
    const auto lanes = sums.lanes;
    typename LaneSums<Dim, Real, Device, Cubic>::Sums of_layer(lanes, nodes, layer);
    leavers.count(layer) = 0;
    for (int g = lanes.layer_first(layer); g < lanes.layer_first(layer + 1); ++g) {
      const auto& group = lanes.groups(g);
      move(lanes, group, layer);
      of_layer.begin(group);
      sums(group, of_layer, virtual_stress);
    }
    of_layer.end();
  }

  KOKKOS_FORCEINLINE_FUNCTION void move(const CellLanes<Dim, Real, Device>& lanes,
                                        const LaneGroup<Dim>& group, int layer) const {
    CellPolynomial<Dim, P> dx[Dim], u[Dim];
    static_for<Dim>([&](auto i) {
      dx[i] = coefficients_of(nodes, nodes.displacement_column + i, group);
      u[i] = coefficients_of(nodes, nodes.remapped_column + i, group);
    });
    for (size_t entry = lanes.begin(group); entry < lanes.end(group); entry += P::width) {
      const auto xi = lanes.load_xi(entry);
      Matrix<Dim, P> L;  // dt L
      static_for<Dim>([&](auto i) {
        static_for<Dim>([&](auto j) {
          L(i, j) = derivative_at<j, Dim>(u[i], xi);
          if constexpr (!Cubic) L(i, j) *= P(sums.grid.inverse_spacing[j] * sums.grid.spacing[0]);
        });
      });
      advance(lanes, entry, L);
      lanes.store(lanes.volume_column, entry,
                  volume(lanes.load(lanes.volume_column, entry), L, P(Real(1))));
      Vector<Dim, P> moved;
      static_for<Dim>([&](auto i) { moved[i] = xi[i] + value_at<Dim>(dx[i], xi); });
      lanes.store_row(lanes.xi_column, entry, moved);
      auto inside = (moved[0] >= P(Real(0))) & (moved[0] < P(Real(1)));
      static_for<Dim>([&](auto i) {
        if constexpr (i > 0) inside = inside & (moved[i] >= P(Real(0))) & (moved[i] < P(Real(1)));
      });
      if (any(!inside)) leave(lanes, group, layer, entry);
    }
  }

  KOKKOS_FORCEINLINE_FUNCTION void advance(const CellLanes<Dim, Real, Device>& lanes, size_t entry,
                                           const Matrix<Dim, P>& L) const {
    constexpr int remembered = Material::template state_size<Dim>();
    const auto sigma = lanes.load_stress(entry);
    if constexpr (remembered == 0) {
      lanes.store_row(lanes.stress_column, entry, material.advance(sigma, L, P(Real(1))));
    } else {
      // Lane by lane: such materials branch.
      for (int l = 0; l < P::width; ++l) {
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
#if defined(__GNUC__) && !defined(__CUDACC__)
  __attribute__((noinline))
#endif
  KOKKOS_FUNCTION void leave(const CellLanes<Dim, Real, Device>& lanes, const LaneGroup<Dim>& group, int layer,
                             size_t entry) const {
    for (int l = 0; l < P::width; ++l) {
      const size_t e = entry + static_cast<size_t>(l);
      if (lanes.id(e) < 0) continue;
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
      const Real round_off = 16 * static_cast<Real>(sums.grid.cells[i]) * epsilon;
      if (xi[i] >= Real(0) && xi[i] < Real(1)) continue;
      if (cell[i] == 0 && xi[i] < Real(0) && xi[i] >= -round_off) continue;
      if (cell[i] == sums.grid.cells[i] - 1 && xi[i] >= Real(1) && xi[i] <= Real(1) + round_off) continue;
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

}  // namespace kernel

}  // namespace vsb
