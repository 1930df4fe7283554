// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Gather and scatter between the nodes of a group of node-centred cell lanes and quadratic polynomials on
/// its cells, one cell per lane (see kernels/lanes/scatter.hpp).
#pragma once

#include <vsb/physics/quadratic_polynomial.hpp>
#include <vsb/views/cell_lanes.hpp>

namespace vsb {

/// The coefficients of a nodal field on the cells of a group.
template <int Dim, class Real, class Device, class P>
KOKKOS_FORCEINLINE_FUNCTION void coefficients_of(const LaneNodes<Dim, Real, Device>& nodes, int column,
                                                 const LaneStencil<Dim>& stencil,
                                                 QuadraticPolynomial<Dim, P>& c) {
  static_for<LaneStencil<Dim>::rows>([&](auto r) VSB_UNROLLED {
    static_for<3>([&](auto a) VSB_UNROLLED { c[3 * r + a] = nodes.load(column, stencil.node[r] + a); });
  });
  quadratic_from_nodes<Dim>(c);
}

/// The sums of one layer: columns First, ..., First + Count - 1 of the sums of its three node planes (one
/// plane in 1D). The last lane adds to two nodes beyond its own. Their sums are kept for the next group of a
/// run, and written at the end of the run.
template <int First, int Count, int Dim, class Real, class Device>
class SplineLayerSums {
  using P = typename Lanes<Real>::Pack;
  static constexpr int rows = LaneStencil<Dim>::rows;

 public:
  /// Sets the sums of the layer to zero.
  KOKKOS_FUNCTION SplineLayerSums(const CellLanes<Dim, Real, Device>& lanes,
                                  const LaneNodes<Dim, Real, Device>& nodes, int layer)
      : nodes_(nodes) {
    // Layers without groups too: the sums of ghost nodes may be added to any of the sums of their images.
    // The outermost planes of the box have no nodes.
    const int planes = Dim == 1 ? 1 : math::min(3, lanes.layers() + 1 - layer);
    for (int c = First; c < First + Count; ++c)
      for (int plane = 0; plane < planes; ++plane) {
        const int end = lanes.plane_first(layer + plane + 1);
        Real* column = nodes.at(nodes.sums_of_plane(plane) + c, 0);
        for (int n = lanes.plane_first(layer + plane); n < end; n += P::width) P(Real(0)).store(column + n);
      }
  }
  /// Call it for every group of the layer, in order.
  KOKKOS_FORCEINLINE_FUNCTION void begin(const LaneGroup<Dim>& group, const LaneStencil<Dim>& stencil) {
    if (group.row != row_ || group.x != next_x_) {
      end();
      for (int c = 0; c < Count; ++c)
        for (int r = 0; r < rows; ++r) middle_[c][r] = above_[c][r] = P(Real(0));
    }
    row_ = group.row;
    next_x_ = group.x + 1;
    for (int r = 0; r < rows; ++r) next_node_[r] = stencil.node[r] + P::width;
  }
  /// Adds to the nodes of the present group.
  KOKKOS_FORCEINLINE_FUNCTION void add(int column, const LaneStencil<Dim>& stencil,
                                       const QuadraticPolynomial<Dim, P>& at_node) {
    static_for<rows>([&](auto r) VSB_UNROLLED {
      P& middle = middle_[column - First][r];
      P& above = above_[column - First][r];
      const P both = at_node[3 * r + 1] + shift_in(above, at_node[3 * r + 2]);
      Real* to = row_of(column, r) + stencil.node[r];
      (P::load(to) + at_node[3 * r] + shift_in(middle, both)).store(to);
      middle = both;
      above = at_node[3 * r + 2];
    });
  }
  /// Call it after the last group of the layer: adds what was kept for a next group.
  KOKKOS_FUNCTION void end() {
    if (next_x_ < 0) return;
    for (int c = 0; c < Count; ++c)
      for (int r = 0; r < rows; ++r) {
        Real* to = row_of(First + c, r) + next_node_[r];
        to[0] += middle_[c][r][P::width - 1];
        to[1] += above_[c][r][P::width - 1];
      }
    next_x_ = -1;
  }

 private:
  KOKKOS_FORCEINLINE_FUNCTION Real* row_of(int column, int r) const {
    return nodes_.at(nodes_.sums_of_plane(Dim == 1 ? 0 : Dim == 2 ? r : r / 3) + column, 0);
  }

  LaneNodes<Dim, Real, Device> nodes_;
  P middle_[Count][rows], above_[Count][rows];  ///< of the group before
  int next_node_[rows];
  int row_ = -1, next_x_ = -1;
};

}  // namespace vsb
