// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Gather and scatter between the nodes of a group of cell lanes and polynomials on its cells, one cell per
/// lane. A nodal field f(x) = sum_I N_I(x) f_I becomes coefficients of the monomials q_k. The moments
/// sum_p w_p q_k(xi_p) become the sums sum_p w_p N_I(x_p), which are added to those of a layer.
#pragma once

#include <vsb/physics/cell_polynomial.hpp>
#include <vsb/views/cell_lanes.hpp>

namespace vsb {

/// A nodal field at the corners of the cells of a group.
template <int Dim, class Real, class Device, class P>
KOKKOS_FORCEINLINE_FUNCTION void values_at_corners(const LaneNodes<Dim, Real, Device>& nodes, int column,
                                                   const LaneGroup<Dim>& group, Vector<(1 << Dim), P>& c) {
  static_for<LaneGroup<Dim>::corner_rows>([&](auto r) VSB_UNROLLED {
    c[2 * r] = nodes.load(column, group.node[r]);
    c[2 * r + 1] = nodes.load(column, group.node[r] + 1);
  });
}

/// The coefficients of a nodal field on the cells of a group.
template <int Dim, class Real, class Device, class P>
KOKKOS_FORCEINLINE_FUNCTION void coefficients_of(const LaneNodes<Dim, Real, Device>& nodes, int column,
                                                 const LaneGroup<Dim>& group, CellPolynomial<Dim, P>& c) {
  values_at_corners(nodes, column, group, c);
  coefficients_from_nodes<Dim>(c);
}

/// The sums of one layer: columns First, ..., First + Count - 1 of LaneNodes' lower and upper sums. The right
/// node of the last lane is the left node of the next group of a run. Its sum is kept for that group, and
/// written at the end of the run.
template <int First, int Count, int Dim, class Real, class Device>
class LayerSums {
  using P = typename Lanes<Real>::Pack;
  static constexpr int rows = LaneGroup<Dim>::corner_rows;

 public:
  /// Of these nodes; reads and writes no sums yet.
  KOKKOS_FUNCTION explicit LayerSums(const LaneNodes<Dim, Real, Device>& nodes) : nodes_(nodes) {}
  /// Sets the sums of a layer to zero; kernels/lanes/update_nodes.hpp leaves them so.
  KOKKOS_FUNCTION void begin_anew(const CellLanes<Dim, Real, Device>& lanes, int layer) const {
    const auto& nodes = nodes_;
    const Ints& plane = lanes.plane_first;
    for (int c = First; c < First + Count; ++c) {
      zero(nodes.at(nodes.lower_sums + c, 0), plane(layer), plane(layer + 1));
      if (Dim > 1) zero(nodes.at(nodes.upper_sums + c, 0), plane(layer + 1), plane(layer + 2));
    }
  }
  /// Call it for every group of the layer, in order.
  KOKKOS_FORCEINLINE_FUNCTION void begin(const LaneGroup<Dim>& group) {
    if (group.row != row_ || group.x != next_x_) {
      end();
      for (int c = 0; c < Count; ++c)
        for (int r = 0; r < rows; ++r) carried_[c][r] = P(Real(0));
    }
    row_ = group.row;
    next_x_ = group.x + 1;
    for (int r = 0; r < rows; ++r) next_node_[r] = group.node[r] + P::width;
  }
  /// Adds the nodal sums of the moments of the present group; overwrites the moments with them.
  KOKKOS_FORCEINLINE_FUNCTION void add_moments(int column, const LaneGroup<Dim>& group,
                                               CellPolynomial<Dim, P>& m) {
    nodes_from_moments<Dim>(m);
    add(column, group, m);
  }
  /// Adds to the nodes, numbered as the corners of multilinear.hpp.
  KOKKOS_FORCEINLINE_FUNCTION void add(int column, const LaneGroup<Dim>& group,
                                       const CellPolynomial<Dim, P>& at_node) {
    static_for<rows>([&](auto r) VSB_UNROLLED {
      Real* to = row_of(column, r) + group.node[r];
      P& carried = carried_[column - First][r];
      (P::load(to) + at_node[2 * r] + shift_in(carried, at_node[2 * r + 1])).store(to);
      carried = at_node[2 * r + 1];
    });
  }
  /// Call it after the last group of the layer: adds what was kept for a next group.
  KOKKOS_FUNCTION void end() {
    if (next_x_ < 0) return;
    for (int c = 0; c < Count; ++c)
      for (int r = 0; r < rows; ++r) row_of(First + c, r)[next_node_[r]] += carried_[c][r][P::width - 1];
    next_x_ = -1;
  }

 private:
  using Ints = typename CellLanes<Dim, Real, Device>::Ints;
  KOKKOS_FUNCTION static void zero(Real* column, int begin, int end) {
    for (int n = begin; n < end; n += P::width) P(Real(0)).store(column + n);
  }
  KOKKOS_FORCEINLINE_FUNCTION Real* row_of(int column, int r) const {
    const bool upper = Dim > 1 && (r >> (Dim > 1 ? Dim - 2 : 0) & 1);
    return nodes_.at((upper ? nodes_.upper_sums : nodes_.lower_sums) + column, 0);
  }

  LaneNodes<Dim, Real, Device> nodes_;
  P carried_[Count][rows];
  int next_node_[rows];
  int row_ = -1, next_x_ = -1;
};

}  // namespace vsb
