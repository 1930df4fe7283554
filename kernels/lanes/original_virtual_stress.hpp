// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The original virtual stress boundary method on cell lanes, Eq. (21), Eq. (22) (see
/// kernels/particles/original_virtual_stress.hpp). At the nodes of N1, with both sums over the cells of E1
/// and E2 alone,
///   f_I <- f_I + sum_p V_p (sbar . grad N_Ip + N_Ip fbar) - sum_c V_c (sbar_c . grad N_Ic + N_Ic fbar_c).
/// The sweeps leave these tractions out; this file adds them afterwards.
///
/// Reads particles and the cells and nodes of Algorithm 1; writes the force of the nodes' sums.
#pragma once

#include <vsb/kernels/lanes/mark_nodes.hpp>
#include <vsb/kernels/lanes/virtual_stress.hpp>
#include <vsb/physics/linear_basis.hpp>
#include <vsb/physics/whole_cell.hpp>

namespace vsb {

namespace kernel {

/// One layer: adds the sum over the particles in cells of E2.
template <class Field, int Dim, class Real, class Device>
struct AddOriginalStress {
  using P = typename Lanes<Real>::Pack;
  LoadedLanes<Dim, Real, Device> on;
  LaneNodes<Dim, Real, Device> nodes;
  CellBits<Device> bits;
  Field virtual_stress;
  TractionMask original;

  KOKKOS_FUNCTION void operator()(int layer) const {
    for (int g = on.lanes.layer_first(layer); g < on.lanes.layer_first(layer + 1); ++g) {
      const auto& group = on.lanes.groups(g);
      if (group.load == GroupLoad::none || group.slots == 0) continue;
      const int first = group.x * P::width;
      constexpr auto all = static_cast<std::uint64_t>(-1) >> (64 - P::width);
      const auto cells = bits.boundary(group.row, first / 64) >> (first % 64) & all;
      if (cells != 0) add(group, cells);
    }
  }
  [[gnu::noinline, gnu::flatten]] KOKKOS_FUNCTION void add(const LaneGroup<Dim>& group,
                                                           std::uint64_t cells) const {
    using namespace lane_sums;
    CellPolynomial<Dim, P> f[Dim];
    static_for<Dim>([&](auto i) VSB_UNROLLED { set_zero<Dim>(f[i]); });
    [[maybe_unused]] CellPolynomial<Dim, P> volume;
    if constexpr (Field::uniform) volume_moments(on.lanes, group, volume);
    for_each_mask(on, group, [&](TractionMask tractions, const std::uint64_t* loaded) {
      const TractionMask acting = tractions & original;
      if (acting == 0) return;
      if constexpr (Field::uniform) {
        add_uniform(virtual_stress.at(Vector<Dim, Real>::zero(), acting).stress, on.grid.inverse_spacing,
                    volume, loaded, f);
      } else {
        CellPolynomial<Dim, P> t[Dim];
        function_traction(on, group, virtual_stress, acting, t);
        static_for<Dim>([&](auto i) VSB_UNROLLED { add_where<Dim>(loaded, t[i], f[i]); });
      }
    });
    for (int l = 0; l < P::width; ++l) {
      if ((cells >> l & 1) == 0) continue;
      for (int a = 0; a < 1 << Dim; ++a)
        for (int i = 0; i < Dim; ++i)
          *nodes.at(nodes.sum_column(1 + Dim + i, a), group.node[a >> 1] + l + (a & 1)) += f[i][a][l];
    }
  }
};

/// One row of nodes of the box: subtracts the sum over the whole cells around its nodes.
template <class Field, int Dim, class Real, class Device>
struct SubtractWholeCells {
  CellLanes<Dim, Real, Device> lanes;
  LaneNodes<Dim, Real, Device> nodes;
  LinearBasis<Dim, Real> basis;
  CellBits<Device> bits;
  typename CellBits<Device>::Rows marked;               ///< [row of nodes of the box][word]: N1
  Kokkos::View<const TractionMask*, Device> tractions;  ///< [node of the lanes]
  Field virtual_stress;
  TractionMask original;
  int gauss_points;

  /// The forces of a cell at its corners under a uniform field: the same for all cells.
  struct Corners {
    TractionMask tractions = 0;
    Vector<Dim, Real> force[1 << Dim];
  };

  KOKKOS_FUNCTION void operator()(int row) const {
    // The gradients of the basis functions vary linearly, so that one point is exact for a uniform field.
    const GaussPoints<Real> gauss(Field::uniform ? 1 : gauss_points);
    Corners corners;
    for (int w = 0; w < static_cast<int>(marked.extent(1)); ++w)
      for (int b = 0; marked(row, w) >> b != 0; ++b) {
        if ((marked(row, w) >> b & 1) == 0) continue;
        const int node = lanes.node_at(row, 64 * w + b);
        const TractionMask chi = tractions(node) & original;
        if (chi != 0) subtract(node, node_ijk(row, 64 * w + b), chi, gauss, corners);
        if (b == 63) break;
      }
  }
  KOKKOS_FUNCTION Vector<Dim, int> node_ijk(int row, int x) const {
    Vector<Dim, int> ijk;
    ijk[0] = lanes.box.first[0] + x;
    for (int i = 1; i < Dim; ++i) {
      ijk[i] = lanes.box.first[i] + row % (lanes.box.cells[i] + 1);
      row /= lanes.box.cells[i] + 1;
    }
    return ijk;
  }
  KOKKOS_FUNCTION void subtract(int node, const Vector<Dim, int>& ijk, TractionMask chi,
                                const GaussPoints<Real>& gauss, Corners& corners) const {
    const CellNumbering<Dim> box{lanes.box.cells};
    auto f = Vector<Dim, Real>::zero();
    for (int a = 0; a < 1 << Dim; ++a) {
      Vector<Dim, int> cell, in_box;
      for (int i = 0; i < Dim; ++i) {
        cell[i] = ijk[i] - (a >> i & 1);
        in_box[i] = cell[i] - lanes.box.first[i];
      }
      // Cells outside the grid and outside the box are not in E1 or E2.
      bool in = true;
      for (int i = 0; i < Dim; ++i) in = in && in_box[i] >= 0 && in_box[i] < box.cells[i];
      if (!in || (bits.boundary(box.row_index(in_box), in_box[0] / 64) >> (in_box[0] % 64) & 1) == 0)
        continue;
      if constexpr (Field::uniform) {
        if (corners.tractions != chi) {
          corners.tractions = chi;
          for (int c = 0; c < 1 << Dim; ++c) {
            corners.force[c] = Vector<Dim, Real>::zero();
            add_whole_cell(basis, cell, c, virtual_stress, chi, gauss, corners.force[c]);
          }
        }
        f += corners.force[a];
      } else {
        add_whole_cell(basis, cell, a, virtual_stress, chi, gauss, f);
      }
    }
    for (int i = 0; i < Dim; ++i) *nodes.at(nodes.lower_sums + 1 + Dim + i, node) -= f[i];
  }
};

}  // namespace kernel

/// Adds the tractions of the original method, which are those of `virtual_stress`, to the nodes' sums.
/// `gauss_points` per direction are used for fields that vary.
template <class Exec, class Field, int Dim, class Real, class Device>
void add_cell_virtual_stress(const Exec& exec, const CellLanes<Dim, Real, Device>& lanes,
                             const LaneNodes<Dim, Real, Device>& nodes, const UniformGrid<Dim, Real>& grid,
                             const LaneBoundary<Dim, Device>& b, const Field& virtual_stress,
                             TractionMask original, int gauss_points) {
  if (original == 0) return;
  check_gauss_points(gauss_points);
  Kokkos::parallel_for("vsb::add_original_stress", Kokkos::RangePolicy<Exec>(exec, 0, lanes.layers()),
                       kernel::AddOriginalStress<Field, Dim, Real, Device>{
                           {lanes, grid, b.tractions}, nodes, b.bits, virtual_stress, original});
  Kokkos::parallel_for(
      "vsb::subtract_whole_cells", Kokkos::RangePolicy<Exec>(exec, 0, static_cast<int>(b.marked.extent(0))),
      kernel::SubtractWholeCells<Field, Dim, Real, Device>{
          lanes, nodes, {grid}, b.bits, b.marked, b.tractions, virtual_stress, original, gauss_points});
}

}  // namespace vsb
