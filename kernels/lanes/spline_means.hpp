// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The mean divergence on node-centred cell lanes (physics/mean_divergence.hpp), between the re-map and sweep
/// C:
///   theta_c = sum_p V_p M_c(x_p) theta_p / sum_p V_p M_c(x_p),   theta_p = dt tr L_p.
/// The functions M_c are multilinear around the centres c of the scene's cells. These centres are the corners
/// of the node-centred cells, so that a particle always has the same 2^Dim functions.
///
/// The values of centre c are stored at the lowest node of its cell: the sums of V M_c and V M_c theta in the
/// columns of the momentum, and the means theta_c in those of the increment dt a. Both are free between the
/// re-map and the next sums.
#pragma once

#include <vsb/kernels/lanes/linear_step.hpp>
#include <vsb/kernels/lanes/spline_scatter.hpp>

namespace vsb {

/// The range of xi in which the functions M_c of a node-centred cell vary, per lane. Beside a wall the
/// function of the centre inside is constant.
template <int Dim, class P>
struct CentreRange {
  ///@{
  /// Per lane, in [0, 1].
  Vector<Dim, P> least, most;
  ///@}
  /// xi limited to the range, component by component.
  KOKKOS_FORCEINLINE_FUNCTION Vector<Dim, P> clamp(const Vector<Dim, P>& xi) const {
    Vector<Dim, P> along;
    static_for<Dim>([&](auto i) VSB_UNROLLED {
      const P above = math::select(xi[i] > least[i], xi[i], least[i]);
      along[i] = math::select(above < most[i], above, most[i]);
    });
    return along;
  }
};

/// `grid` is the node-centred grid.
template <int Dim, class Real, class Device>
KOKKOS_FUNCTION CentreRange<Dim, typename Lanes<Real>::Pack> centre_range_of(
    const CellLanes<Dim, Real, Device>& lanes, const LaneGroup<Dim>& group,
    const UniformGrid<Dim, Real>& grid, const Walls<Dim>& walls) {
  using P = typename Lanes<Real>::Pack;
  CentreRange<Dim, P> range;
  for (int i = 0; i < Dim; ++i) {
    range.least[i] = P(Real(0));
    range.most[i] = P(Real(1));
    for (int l = 0; l < P::width; ++l) {
      const int node = lanes.cell(group, l)[i];
      if (node == 0 && walls.mirrored(i, 0)) range.least[i].set(l, Real(1));
      if (node == grid.cells[i] - 1 && walls.mirrored(i, 1)) range.most[i].set(l, Real(0));
    }
  }
  return range;
}

/// The row of a stencil that stores the centres at corners 2 r and 2 r + 1 of a node-centred cell.
constexpr int centre_row(int r) {
  return (r >> 1) * 3 + (r & 1);
}

namespace kernel {

/// Sums of V M_c and V M_c theta of a layer.
template <int Dim, class Real, class Device>
struct SumLaneDivergence {
  using P = typename Lanes<Real>::Pack;
  using Nodes = LaneNodes<Dim, Real, Device>;
  using Sums = SplineLayerSums<1, 2, Dim, Real, Device>;
  CellLanes<Dim, Real, Device> lanes;
  Nodes nodes;
  UniformGrid<Dim, Real> grid;  ///< node-centred
  Walls<Dim> walls;

  KOKKOS_FUNCTION void operator()(int layer) const {
    Sums sums(lanes, nodes, layer);
    for_each_group(lanes, layer, [&](const auto& group, int g) {
      sums.begin(group, lanes.stencils(g));
      add(group, sums);
    });
    sums.end();
  }
  [[gnu::noinline, gnu::flatten]] KOKKOS_FUNCTION void add(const LaneGroup<Dim>& group, Sums& sums) const {
    const auto& stencil = lanes.stencils(lanes.number_of(group));
    const auto theta = divergence_of(stencil);
    const auto range = centre_range_of(lanes, group, grid, walls);
    CellPolynomial<Dim, P> V_M, V_M_theta;
    lane_sums::set_zero<Dim>(V_M);
    lane_sums::set_zero<Dim>(V_M_theta);
    for (size_t entry = lanes.begin(group); entry < lanes.end(group); entry += P::width) {
      const auto xi = lanes.load_xi(entry);
      const auto above = range.clamp(xi);
      const P value = quadratic_at<Dim>(theta, Powers<Dim, P>(xi));
      CellPolynomial<Dim, P> M;
      M[0] = lanes.load(lanes.volume_column, entry);
      static_for<Dim>([&](auto i) VSB_UNROLLED {
        static_for<(1 << i)>([&](auto a) VSB_UNROLLED {
          M[a | (1 << i)] = M[a] * above[i];
          M[a] = M[a] * P(P(Real(1)) - above[i]);
        });
      });
      static_for<M.size>([&](auto a) VSB_UNROLLED {
        V_M[a] += M[a];
        V_M_theta[a] += M[a] * value;
      });
    }
    set_down(1, stencil, V_M, sums);
    set_down(2, stencil, V_M_theta, sums);
  }
  /// dt tr L in a node-centred cell. Along direction i, r_1 has the slope 1 = r_0, and r_2 the slope r_1 -
  /// r_0 / 2.
  KOKKOS_FORCEINLINE_FUNCTION QuadraticPolynomial<Dim, P> divergence_of(
      const LaneStencil<Dim>& stencil) const {
    QuadraticPolynomial<Dim, P> theta;
    static_for<theta.size>([&](auto k) VSB_UNROLLED { theta[k] = P(Real(0)); });
    static_for<Dim>([&](auto i) VSB_UNROLLED {
      QuadraticPolynomial<Dim, P> u;
      coefficients_of(nodes, nodes.remapped_column + i, stencil, u);
      const P scale(grid.inverse_spacing[i] * grid.spacing[0]);
      static_for<u.size>([&](auto k) VSB_UNROLLED {
        constexpr int step = stencil_size(i);
        if constexpr (stencil_digit(k, i) == 1) theta[k - step] += scale * u[k];
        if constexpr (stencil_digit(k, i) == 2) {
          const P slope = scale * u[k];
          theta[k - step] += slope;
          theta[k - 2 * step] -= P(Real(0.5)) * slope;
        }
      });
    });
    return theta;
  }
  KOKKOS_FORCEINLINE_FUNCTION static void set_down(int column, const LaneStencil<Dim>& stencil,
                                                   const CellPolynomial<Dim, P>& at_centre, Sums& sums) {
    QuadraticPolynomial<Dim, P> at_node;
    static_for<at_node.size>([&](auto k) VSB_UNROLLED { at_node[k] = P(Real(0)); });
    static_for<at_centre.size>(
        [&](auto a) VSB_UNROLLED { at_node[3 * centre_row(a >> 1) + (a & 1)] = at_centre[a]; });
    sums.add(column, stencil, at_node);
  }
};

}  // namespace kernel

/// Which functions are small, and which they merge into.
template <class Device>
struct SmallMeans {
  ///@{
  /// [node group]: small; merged into by others.
  Kokkos::View<LaneMask*, Device> small, merging;
  ///@}
  Kokkos::View<int*, Device> merged_into;  ///< [node]: of a small function, the node it merges into
};

namespace kernel {

/// theta_c of a node group without merging; marks the small functions.
template <int Dim, class Real, class Device>
struct DivideLaneSums : LaneNodeRows<Dim, Real, Device, 3> {
  using Base = LaneNodeRows<Dim, Real, Device, 3>;
  using Base::nodes;
  using typename Base::P;
  Real least;  ///< m^Dim
  SmallMeans<Device> means;

  KOKKOS_FUNCTION void operator()(int node_group) const {
    const int node = node_group * P::width;
    const P V = this->sum(1, node), V_theta = this->sum(2, node), zero(Real(0));
    const auto some = V > zero;
    math::select(some, V_theta / V, zero).store(nodes.at(nodes.increment_column, node));
    means.small(node_group) = bits_of(some & (V < P(least)));
    means.merging(node_group) = 0;
  }
};

/// The functions at the nodes of a node group, and access to their neighbours.
template <int Dim, class Real, class Device>
struct LaneMeans {
  CellLanes<Dim, Real, Device> lanes;
  LaneNodeRows<Dim, Real, Device, 3> rows;
  CentreMeans<Dim, Real> functions;
  SmallMeans<Device> means;
  Vector<Dim, int> first;  ///< the cell whose function is at the lowest node of the box

  /// Calls work(cell, node) for the nodes of a node group, by its index in the box, whose bits are set in
  /// bits(node_group).
  template <class Work>
  KOKKOS_FORCEINLINE_FUNCTION void for_each(const Kokkos::View<LaneMask*, Device>& bits, int box_index,
                                            const Work& work) const {
    const int node_group = lanes.node_group_at(box_index);
    if (node_group < 0 || bits(node_group) == 0) return;
    const int per_row = lanes.groups_per_row() + 1;
    auto cell = first;
    cell[0] += box_index % per_row * lanes.width;
    for (int i = 1, row = box_index / per_row; i < Dim; ++i) {
      cell[i] += row % (lanes.box.cells[i] + 1);
      row /= lanes.box.cells[i] + 1;
    }
    for (int l = 0; l < lanes.width; ++l, ++cell[0])
      if (bits(node_group) >> l & 1) work(cell, node_group * lanes.width + l);
  }
  /// The node of a cell's function, or -1.
  KOKKOS_FORCEINLINE_FUNCTION int node_of(const Vector<Dim, int>& cell) const {
    int row = 0;
    for (int i = Dim - 1; i > 0; --i) {
      const int at = cell[i] - first[i];
      if (at < 0 || at > lanes.box.cells[i]) return -1;
      row = row * (lanes.box.cells[i] + 1) + at;
    }
    const int x = cell[0] - first[0];
    return x < 0 || x >= (lanes.groups_per_row() + 1) * lanes.width ? -1 : lanes.node_at(row, x);
  }
  KOKKOS_FORCEINLINE_FUNCTION bool is_small(int node) const {
    return means.small(node / lanes.width) >> (node % lanes.width) & 1;
  }
  /// V M_c (column 1), V M_c theta (column 2).
  KOKKOS_FORCEINLINE_FUNCTION Real sum(int column, int node) const {
    Real all = 0;
    for (int plane = 0; plane < (Dim > 1 ? 3 : 1); ++plane)
      all += *rows.nodes.at(rows.nodes.sums_of_plane(plane) + column, node);
    return all;
  }
  KOKKOS_FORCEINLINE_FUNCTION Real& theta(int node) const {
    return *rows.nodes.at(rows.nodes.increment_column, node);
  }
};

/// Finds the function that each small function merges into.
template <int Dim, class Real, class Device>
struct FindMergedMeans : LaneMeans<Dim, Real, Device> {
  KOKKOS_FUNCTION void operator()(int box_index) const {
    this->for_each(this->means.small, box_index, [&](const auto& cell, int node) {
      const int merged_into = this->node_of(this->functions.merged_function(cell, [&](const auto& c) {
        const int there = this->node_of(c);
        return there < 0 ? Real(0) : this->sum(1, there);
      }));
      this->means.merged_into(node) = merged_into;
      constexpr int width = Lanes<Real>::width;
      if (merged_into != node)
        Kokkos::atomic_fetch_or(&this->means.merging(merged_into / width), LaneMask(1)
                                                                               << merged_into % width);
    });
  }
};

/// theta_c of the functions that small ones merge into: the mean over all of them.
template <int Dim, class Real, class Device>
struct MergeSmallMeans : LaneMeans<Dim, Real, Device> {
  KOKKOS_FUNCTION void operator()(int box_index) const {
    this->for_each(this->means.merging, box_index, [&](const auto& cell, int node) {
      Real volume = this->sum(1, node), divergence = this->sum(2, node);
      this->functions.for_each_neighbour(cell, [&](const auto& c) {
        const int there = this->node_of(c);
        if (there < 0 || !this->is_small(there) || this->means.merged_into(there) != node) return;
        volume += this->sum(1, there);
        divergence += this->sum(2, there);
      });
      this->theta(node) = divergence / volume;
    });
  }
};

/// theta_c of small functions: that of the function they merge into.
template <int Dim, class Real, class Device>
struct CopyMergedMeans : LaneMeans<Dim, Real, Device> {
  KOKKOS_FUNCTION void operator()(int box_index) const {
    this->for_each(this->means.small, box_index, [&](const auto&, int node) {
      this->theta(node) = this->theta(this->means.merged_into(node));
    });
  }
};

}  // namespace kernel

/// Writes theta_c to nodes.increment_column. `grid` is the scene's grid; `small` is memory that grows as
/// needed.
template <class Exec, int Dim, class Real, class Device>
void average_lane_divergence(const Exec& exec, const LaneState<Dim, Real, Device>& s,
                             const UniformGrid<Dim, Real>& grid, SmallMeans<Device>& small) {
  const auto& m = s.memory;
  const int node_groups = m.lanes.node_count / m.lanes.width;
  if (static_cast<int>(small.small.extent(0)) < node_groups) {
    const auto n = static_cast<size_t>(node_groups);
    small.small = Kokkos::View<LaneMask*, Device>("vsb::small_means", n);
    small.merging = Kokkos::View<LaneMask*, Device>("vsb::merging_means", n);
    small.merged_into =
        Kokkos::View<int*, Device>("vsb::merged_means", n * static_cast<size_t>(m.lanes.width));
  }
  kernel::LaneMeans<Dim, Real, Device> at{
      m.lanes, {m.nodes}, {with_ghost_layer(grid), m.walls}, small, m.lanes.lowest_node()};
  for (int i = 0; i < Dim; ++i) ++at.first[i];  // of the ghost layer
  Kokkos::parallel_for("vsb::sum_lane_divergence", detail::over_layers(exec, s),
                       kernel::SumLaneDivergence<Dim, Real, Device>{m.lanes, m.nodes, m.grid, m.walls});
  Kokkos::parallel_for(
      "vsb::divide_lane_sums", Kokkos::RangePolicy<Exec>(exec, 0, node_groups),
      kernel::DivideLaneSums<Dim, Real, Device>{{m.nodes}, at.functions.least_volume(), small});
  const Kokkos::RangePolicy<Exec> over_box(exec, 0, static_cast<int>(m.lanes.node_group_at.extent(0)));
  Kokkos::parallel_for("vsb::find_merged_means", over_box, kernel::FindMergedMeans<Dim, Real, Device>{at});
  Kokkos::parallel_for("vsb::merge_small_means", over_box, kernel::MergeSmallMeans<Dim, Real, Device>{at});
  Kokkos::parallel_for("vsb::copy_merged_means", over_box, kernel::CopyMergedMeans<Dim, Real, Device>{at});
}

}  // namespace vsb
