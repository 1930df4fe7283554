// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The original virtual stress boundary method, Eq. (21), Eq. (22). Beside the sum over particles,
///   f_I <- f_I - sum_c V_c (sbar_c . grad N_Ic + N_Ic fbar_c)
/// over the Gauss points c of whole cells. At a node of N1 both this sum and the particles' sum of sbar run
/// over the cells of E1 and E2 only. Over complete supports the method would equal the modified one.
///
/// Reads the cells of Algorithm 1; writes nodal forces.
#pragma once

#include <vsb/kernels/boundary/mark_boundary_nodes.hpp>
#include <vsb/physics/whole_cell.hpp>

namespace vsb {

/// A virtual stress of which some tractions act by the original method.
template <class Field, class Grid, class Device>
struct OriginalVirtualStress {
  static constexpr bool loaded = Field::loaded;  ///< as the field
  static constexpr bool cell_quadrature = true;  ///< kernels sum over whole cells, too
  Field field;                                   ///< of all tractions, of either method
  Grid grid;                                     ///< of the basis
  CellBits<Device> cells;                        ///< E1 and E2 of Algorithm 1
  TractionMask original;                         ///< the tractions of the original method
  int gauss_points;                              ///< per direction, 1 to 4

  /// The tractions that `field` has a stress for.
  TractionMask known() const { return field.known(); }
  /// The sum of the fields of the tractions in the mask at x in m.
  template <class X>
  KOKKOS_FUNCTION auto at(const X& x, TractionMask mask) const {
    return field.at(x, mask);
  }
  /// Tractions of the original method act on particles of boundary cells only.
  template <class X>
  KOKKOS_FUNCTION TractionMask acting_at(const X& x) const {
    return is_boundary(grid.cell_containing(x)) ? ~TractionMask(0) : ~original;
  }
  /// Whether a cell (i, j, k) is one of E1 or E2.
  template <int Dim>
  KOKKOS_FUNCTION bool is_boundary(const Vector<Dim, int>& cell) const {
    return cells.boundary(grid.row_index(cell), cell[0] / 64) >> (cell[0] % 64) & 1;
  }
};

namespace kernel {

/// One node: subtracts the sum over the whole cells around it.
template <class Field, class Basis, int Dim, class Real, class Device>
struct SubtractCellStress {
  Field virtual_stress;
  Basis basis;
  BoundaryNodes<Device> boundary;
  Nodes<Dim, Real, Device> nodes;

  KOKKOS_FUNCTION void operator()(int I) const {
    const TractionMask chi = boundary(I) & virtual_stress.original;
    if (chi == 0) return;
    const auto at = basis.grid.node_ijk(I);
    const GaussPoints<Real> gauss(virtual_stress.gauss_points);
    auto f = Vector<Dim, Real>::zero();
    for (int corner = 0; corner < (1 << Dim); ++corner) {
      Vector<Dim, int> cell;
      bool exists = true;
      for (int i = 0; i < Dim; ++i) {
        cell[i] = at[i] - (corner >> i & 1);
        exists = exists && cell[i] >= 0 && cell[i] < basis.grid.cells[i];
      }
      if (exists && virtual_stress.is_boundary(cell))
        add_whole_cell(basis, cell, corner, virtual_stress, chi, gauss, f);
    }
    for (int i = 0; i < Dim; ++i) nodes.force(I, i) -= f[i];
  }
};

}  // namespace kernel

/// Subtracts the sum over whole cells at the nodes of N1.
template <class Exec, class Field, class Basis, int Dim, class Real, class Device>
void subtract_cell_virtual_stress(const Exec& exec, const Nodes<Dim, Real, Device>& nodes,
                                  const BoundaryNodes<Device>& boundary, const Basis& basis,
                                  const Field& virtual_stress) {
  check_gauss_points(virtual_stress.gauss_points);
  Kokkos::parallel_for(
      "vsb::subtract_cell_virtual_stress", Kokkos::RangePolicy<Exec>(exec, 0, nodes.count()),
      kernel::SubtractCellStress<Field, Basis, Dim, Real, Device>{virtual_stress, basis, boundary, nodes});
}

}  // namespace vsb
