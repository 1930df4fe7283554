// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Algorithm 1 on node-centred cell lanes, for quadratic B-splines (see
/// kernels/boundary/mark_boundary_nodes.hpp). Void cells are cells of the scene's grid. A node-centred cell
/// overlaps 2^Dim of them, each by one corner. N1 has one ring of nodes more than the nodes of E1 and E2.
/// Ghost nodes are marked as their images are.
#pragma once

#include <vsb/kernels/lanes/ghosts.hpp>

namespace vsb {

/// [group][corner q of the node-centred cell; bit i: upper half in direction i]: the lanes with particles
/// there.
template <class Device>
using LaneCorners = Kokkos::View<LaneMask**, Kokkos::LayoutRight, Device>;

namespace kernel {

/// One group: in which corners of its cells there are particles.
template <int Dim, class Real, class Device>
struct FindCorners {
  using P = typename Lanes<Real>::Pack;
  CellLanes<Dim, Real, Device> lanes;
  LaneCorners<Device> corners;

  KOKKOS_FUNCTION void operator()(int g) const {
    LaneMask in[1 << Dim] = {};
    const auto& group = lanes.groups(g);
    for (size_t entry = lanes.begin(group); entry < lanes.end(group); entry += P::width) {
      LaneMask upper[Dim];
      for (int i = 0; i < Dim; ++i)
        upper[i] = bits_of(lanes.load(lanes.xi_column + i, entry) >= P(Real(0.5)));
      for (int q = 0; q < 1 << Dim; ++q) {
        LaneMask here = lanes.with_particle(entry / P::width);
        for (int i = 0; i < Dim; ++i) here &= q >> i & 1 ? upper[i] : ~upper[i];
        in[q] |= here;
      }
    }
    for (int q = 0; q < 1 << Dim; ++q) corners(g, q) = in[q];
  }
};

/// One row of cells of the scene's grid: which of them hold particles; counts the words that changed. The
/// lower half of node-centred cell d is in cell d of the row, the upper one in cell d + 1.
template <int Dim, class Real, class Device>
struct OccupySplineLanes {
  CellLanes<Dim, Real, Device> lanes;
  LaneCorners<Device> corners;
  typename CellBits<Device>::Rows occupied;

  KOKKOS_FUNCTION void operator()(int row, int& changes) const {
    const int words = static_cast<int>(occupied.extent(1));
    for (int w = 0; w < words; ++w) {
      std::uint64_t bits = 0;
      for (int q = 0; q < 1 << Dim; ++q) bits |= word(row, w, q);
      if (bits != occupied(row, w)) ++changes;
      occupied(row, w) = bits;
    }
  }
  KOKKOS_FUNCTION std::uint64_t word(int row, int w, int q) const {
    constexpr int width = Lanes<Real>::width;
    const int rows = lanes.rows_per_layer();
    int j = row % rows, k = row / rows;
    if (Dim == 2) k -= q >> 1 & 1;
    if (Dim == 3) {
      j -= q >> 1 & 1;
      k -= q >> 2 & 1;
    }
    if (j < 0 || k < 0) return 0;
    std::uint64_t bits = 0;
    for (int x = 64 / width * w - 1; x < 64 / width * (w + 1); ++x) {
      const int g = lanes.group_of(k * rows + j, x);
      if (g < 0) continue;
      const std::uint64_t cells = static_cast<std::uint64_t>(corners(g, q)) << (q & 1);
      const int at = x * width - 64 * w;
      bits |= at < 0 ? cells >> -at : cells << at;
    }
    return bits;
  }
};

/// One row of nodes: counts those at which a traction acts by `mark`, also those that the lanes do not store.
/// Nodes of cells with particles are active even where no particle has them among its nodes.
template <int Dim, class Real, class Device>
struct CountMarkedNodes {
  MarkLaneNodes<1, Dim, Real, Device> mark;

  KOKKOS_FUNCTION void operator()(int r, int& count) const {
    const Vector<2, int> at{{r % mark.tiling.node_rows[0], r / mark.tiling.node_rows[0]}};
    for (int w = 0; w < mark.tiling.words; ++w)
      for (int b = 0; b < 64; ++b) {
        if ((mark.boundary.active(r, w) >> b & 1) == 0) continue;
        const TractionMask acting =
            mark.boundary.marked(r, w) >> b & 1 ? ~TractionMask(0) : mark.boundary.at_all_active_nodes;
        if ((acting & mark.declared(r, 64 * w + b, at)) != 0) ++count;
      }
  }
};

}  // namespace kernel

/// The cells of the scene's grid around the box, as rows of bits; `last` is the grid's last node. Beyond an
/// open face there is one more layer of cells, as for the particle kernels.
template <int Dim, class Real, class Device>
BitRows<Dim> spline_tiling(const CellLanes<Dim, Real, Device>& lanes, const Vector<Dim, int>& last,
                           const Walls<Dim>& walls) {
  BitRows<Dim> tiling(CellNumbering<Dim>{lanes.box.cells});
  const auto lowest = lanes.lowest_node();
  for (int i = 0; i < Dim; ++i) {
    const int first_cell = walls.mirrored(i, 0) ? 0 : -1,
              last_cell = walls.mirrored(i, 1) ? last[i] - 1 : last[i];
    tiling.first[i] = math::max(0, first_cell - lowest[i]);
    tiling.last[i] = math::min(lanes.box.cells[i] - 1, last_cell - lowest[i]);
  }
  return tiling;
}

/// Brings bits.occupied and the cells with carried tractions up to date. Returns whether they may have
/// changed. Waits for the device.
template <class Exec, int Dim, class Real, class Device>
bool update_spline_occupied(const Exec& exec, const CellLanes<Dim, Real, Device>& lanes,
                            LaneCorners<Device>& corners, const LaneBoundary<Dim, Device>& b) {
  const auto groups = static_cast<size_t>(lanes.group_count);
  if (corners.extent(0) < groups) corners = LaneCorners<Device>("vsb::lane_corners", groups, 1 << Dim);
  Kokkos::parallel_for("vsb::find_corners", Kokkos::RangePolicy<Exec>(exec, 0, lanes.group_count),
                       kernel::FindCorners<Dim, Real, Device>{lanes, corners});
  int changes = 0;
  Kokkos::parallel_reduce("vsb::occupy_spline_lanes", Kokkos::RangePolicy<Exec>(exec, 0, lanes.row_count()),
                          kernel::OccupySplineLanes<Dim, Real, Device>{lanes, corners, b.bits.occupied},
                          changes);
  const bool carried = update_carrying(exec, lanes, b.bits.carried);
  exec.fence();
  return carried || changes > 0;
}

/// Cells of the grid with its ghost layer, at whose nodes tractions are declared.
template <int Dim>
Vector<Dim, int> with_ghost_cells(Vector<Dim, int> cells) {
  for (int i = 0; i < Dim; ++i) cells[i] += 2;
  return cells;
}

/// From bits.occupied to the loads of nodes and groups; see mark_lanes.
template <class Exec, int Dim, class Real, class Device>
void mark_spline_lanes(const Exec& exec, const CellLanes<Dim, Real, Device>& lanes,
                       const Vector<Dim, int>& last, const Walls<Dim>& walls,
                       const LaneGhosts<Device>& ghosts, LaneBoundary<Dim, Device>& b, bool anew) {
  mark_nodes<1>(exec, lanes, spline_tiling(lanes, last, walls), with_ghost_cells(last), b, anew);
  kernel::for_each_image("vsb::mirror_lane_tractions", exec, ghosts,
                         kernel::MirrorLaneTractions<Device>{ghosts, b.tractions});
  load_groups(exec, lanes, b);
}

/// Nodes at which a traction acts, ghost nodes aside. Waits for the device.
template <class Exec, int Dim, class Real, class Device>
int count_marked_nodes(const Exec& exec, const CellLanes<Dim, Real, Device>& lanes,
                       const Vector<Dim, int>& last, const Walls<Dim>& walls,
                       const LaneBoundary<Dim, Device>& b) {
  const auto tiling = spline_tiling(lanes, last, walls);
  int count = 0;
  Kokkos::parallel_reduce(
      "vsb::count_marked_nodes", Kokkos::RangePolicy<Exec>(exec, 0, tiling.node_row_count()),
      kernel::CountMarkedNodes<Dim, Real, Device>{{lanes, b, tiling, with_ghost_cells(last), false}}, count);
  exec.fence();
  return count;
}

}  // namespace vsb
