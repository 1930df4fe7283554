// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The sweeps over node-centred cell lanes of one MUSL step with quadratic B-splines, a layer each call: A,
/// B, C, and C with A of the next step, as in kernels/lanes/sweeps.hpp.
///
/// The corner of the node-centred cell that holds a particle tells the cell of the scene's grid that holds
/// it. C notes the layers in which it changes, for Algorithm 1. The mean divergence, if asked for, is a sweep
/// of its own before C (kernels/lanes/spline_means.hpp).
#pragma once

#include <vsb/kernels/lanes/spline_means.hpp>
#include <vsb/kernels/lanes/spline_virtual_stress.hpp>
#include <vsb/kernels/lanes/sweeps.hpp>

namespace vsb {

namespace kernel {

/// Sweep A.
template <class Field, int Dim, class Real, class Device>
struct SumSplineLanes {
  LoadedLanes<Dim, Real, Device> on;
  LaneNodes<Dim, Real, Device> nodes;
  Field virtual_stress;
  Kokkos::View<int*, Device> only;  ///< [layer]: 0: the layer is skipped; empty: no layer is

  KOKKOS_FUNCTION void operator()(int layer) const {
    if (only.size() > 0 && only(layer) == 0) return;
    SplineStepSums<Dim, Real, Device> sums(on.lanes, nodes, layer);
    for_each_group(on.lanes, layer, [&](const auto& group, int g) {
      sums.begin(group, on.lanes.stencils(g));
      sum_spline_group(on, group, virtual_stress, sums);
    });
    sums.end();
  }
};

/// Sweep B.
template <int Dim, class Real, class Device>
struct AccelerateSplineLanes {
  using P = typename Lanes<Real>::Pack;
  using Momentum = SplineLayerSums<1, Dim, Dim, Real, Device>;
  CellLanes<Dim, Real, Device> lanes;
  LaneNodes<Dim, Real, Device> nodes;
  Real pic;  ///< eta

  KOKKOS_FUNCTION void operator()(int layer) const {
    Momentum sums(lanes, nodes, layer);
    for_each_group(lanes, layer, [&](const auto& group, int g) {
      sums.begin(group, lanes.stencils(g));
      accelerate(group);
      add_momentum(group, sums);
    });
    sums.end();
  }
  /// v_p <- (1 - eta) v_p + sum_I N_Ip g_I.
  [[gnu::noinline, gnu::flatten]] KOKKOS_FUNCTION void accelerate(const LaneGroup<Dim>& group) const {
    const auto& stencil = lanes.stencils(lanes.number_of(group));
    const P kept(Real(1) - pic);
    QuadraticPolynomial<Dim, P> dv[Dim];
    static_for<Dim>([&](auto i)
                        VSB_UNROLLED { coefficients_of(nodes, nodes.increment_column + i, stencil, dv[i]); });
    for (size_t entry = lanes.begin(group); entry < lanes.end(group); entry += P::width) {
      const Powers<Dim, P> xi(lanes.load_xi(entry));
      static_for<Dim>([&](auto i) VSB_UNROLLED {
        const P v = lanes.load(lanes.velocity_column + i, entry);
        lanes.store(lanes.velocity_column + i, entry, kept * v + quadratic_at<Dim>(dv[i], xi));
      });
    }
  }
  [[gnu::noinline, gnu::flatten]] KOKKOS_FUNCTION void add_momentum(const LaneGroup<Dim>& group,
                                                                    Momentum& sums) const {
    spline_sums::mass_and_momentum<false>(lanes, group, sums);
  }
};

/// Sweep C for one group.
template <class Material, class Volume, int Dim, class Real, class Device>
struct MoveSplineGroup : MoveGroup<false, Material, Volume, Dim, Real, Device> {
  using Base = MoveGroup<false, Material, Volume, Dim, Real, Device>;
  using Base::beta;
  using Base::grid;
  using Base::lanes;
  using Base::nodes;
  using Base::position_velocity;
  using Base::volume;
  using typename Base::P;
  Kokkos::View<int*, Device> crossed;  ///< [layer]: 1 where a particle went from corner to corner
  Walls<Dim> walls;

  /// The range of xi in which a particle stays in its cell. The faces of the grid go through the middle of
  /// the outermost node-centred cells.
  struct CellRange {
    Vector<Dim, P> first, end;
    KOKKOS_FORCEINLINE_FUNCTION bool holds(const Vector<Dim, P>& xi) const {
      auto inside = (xi[0] >= first[0]) & (xi[0] < end[0]);
      static_for<Dim>([&](auto i) VSB_UNROLLED {
        if constexpr (i > 0) inside = inside & (xi[i] >= first[i]) & (xi[i] < end[i]);
      });
      return !any(!inside);
    }
  };
  KOKKOS_FUNCTION CellRange range_of(const LaneGroup<Dim>& group) const {
    CellRange range;
    for (int i = 0; i < Dim; ++i) {
      range.first[i] = P(Real(0));
      range.end[i] = P(Real(1));
      const int last = grid.cells[i] - 1;
      // A ghost at the middle of a cell stays. to_next_cell finds what is outside by more than round-off.
      constexpr Real epsilon = std::numeric_limits<Real>::epsilon();
      for (int l = 0; l < P::width; ++l) {
        const int cell = lanes.cell(group, l)[i];
        if (cell == 0) range.first[i].set(l, Real(0.5) - epsilon);
        if (cell == last) range.end[i].set(l, Real(0.5) + epsilon);
      }
    }
    return range;
  }

  KOKKOS_FORCEINLINE_FUNCTION void operator()(const LaneGroup<Dim>& group, int layer) const {
    if (beta > Real(0))
      move<true>(group, layer);
    else
      move<false>(group, layer);
  }
  /// averaged: whether the mean replaces the divergence.
  template <bool averaged>
  [[gnu::noinline, gnu::flatten]] KOKKOS_FUNCTION void move(const LaneGroup<Dim>& group, int layer) const {
    const auto& stencil = lanes.stencils(lanes.number_of(group));
    QuadraticPolynomial<Dim, P> u[Dim], by_grid[Dim];
    static_for<Dim>([&](auto i)
                        VSB_UNROLLED { coefficients_of(nodes, nodes.remapped_column + i, stencil, u[i]); });
    const QuadraticPolynomial<Dim, P>* dx = nullptr;
    if (position_velocity == PositionVelocity::grid) {
      static_for<Dim>([&](auto i) VSB_UNROLLED {
        coefficients_of(nodes, nodes.displacement_column + i, stencil, by_grid[i]);
      });
      dx = by_grid;
    }
    const CellRange range = range_of(group);
    CentreRange<Dim, P> centres;
    CellPolynomial<Dim, P> mean;
    if constexpr (averaged) {
      centres = centre_range_of(lanes, group, grid, walls);
      means_around(stencil, mean);
    }
    for (size_t entry = lanes.begin(group); entry < lanes.end(group); entry += P::width) {
      const Powers<Dim, P> xi(lanes.load_xi(entry));
      Vector<Dim, P> moved;
      Matrix<Dim, P> L;  // dt L
      static_for<Dim>([&](auto i) VSB_UNROLLED {
        Vector<Dim, P> gradient;
        const P by_strain = quadratic_at<Dim>(u[i], xi, gradient);
        moved[i] = xi.first[i] + P(grid.inverse_spacing[i] * grid.spacing[0]) * by_strain;
        static_for<Dim>([&](auto j) VSB_UNROLLED {
          L(i, j) = gradient[j] * P(grid.inverse_spacing[j] * grid.spacing[0]);
        });
      });
      if constexpr (averaged)
        L = with_mean_divergence(L, value_at<Dim>(mean, centres.clamp(xi.first)), P(beta));
      this->advance(entry, L);
      const P V = lanes.load(lanes.volume_column, entry);
      lanes.store(lanes.volume_column, entry, volume(V, L, P(1)));
      if (dx)
        static_for<Dim>([&](auto i) VSB_UNROLLED { moved[i] = xi.first[i] + quadratic_at<Dim>(dx[i], xi); });
      lanes.store_row(lanes.xi_column, entry, moved);
      note_crossing(layer, entry, xi.first, moved);
      if (!range.holds(moved)) this->copy_migrating(group, layer, entry);
    }
  }
  /// The coefficients of the mean divergence between the centres.
  KOKKOS_FORCEINLINE_FUNCTION void means_around(const LaneStencil<Dim>& stencil,
                                                CellPolynomial<Dim, P>& mean) const {
    static_for<mean.size>([&](auto a) VSB_UNROLLED {
      mean[a] = nodes.load(nodes.increment_column, stencil.node[centre_row(a >> 1)] + (a & 1));
    });
    coefficients_from_nodes<Dim>(mean);
  }
  KOKKOS_FORCEINLINE_FUNCTION void note_crossing(int layer, size_t entry, const Vector<Dim, P>& before,
                                                 const Vector<Dim, P>& after) const {
    const P half(Real(0.5));
    auto different = half < half;
    static_for<Dim>([&](auto i) VSB_UNROLLED {
      different =
          different | ((before[i] < half) & (after[i] >= half)) | ((before[i] >= half) & (after[i] < half));
    });
    if (any(different) && (bits_of(different) & lanes.with_particle(entry / P::width)) != 0)
      crossed(layer) = 1;
  }
};

/// Sweep C, and A of the next step.
template <class Field, class Material, class Volume, int Dim, class Real, class Device>
struct MoveSplineLanes {
  LoadedLanes<Dim, Real, Device> on;
  MoveSplineGroup<Material, Volume, Dim, Real, Device> move;
  Field virtual_stress;
  bool and_sum;  ///< whether A follows at once

  KOKKOS_FUNCTION void operator()(int layer) const {
    move.crossed(layer) = 0;
    const auto move_group = [&](const auto& group) { move(group, layer); };
    if (!and_sum)
      return move_layer(on.lanes, move.migrating, layer, false, move_group, [](const auto&, int) {});
    SplineStepSums<Dim, Real, Device> sums(on.lanes, move.nodes, layer);
    move_layer(on.lanes, move.migrating, layer, true, move_group, [&](const auto& group, int g) {
      sums.begin(group, on.lanes.stencils(g));
      sum_spline_group(on, group, virtual_stress, sums);
    });
    sums.end();
  }
};

}  // namespace kernel

}  // namespace vsb
