// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The balance of kernels/readout/balance.hpp for particles in cell lanes. It needs the nodal forces
///   f_I = -sum_p V_p sigma_p . grad N_Ip + m_I g
/// without and with the virtual stress. Both are summed in memory of their own; the state is not changed.
#pragma once

#include <vsb/kernels/lanes/resultant.hpp>
#include <vsb/kernels/readout/balance.hpp>

namespace vsb {

namespace kernel {

/// Lower and upper sums together, and the weight.
template <int Dim, class Real, class Device>
struct LaneNodeSums {
  LaneNodes<Dim, Real, Device> nodes;
  Vector<Dim, Real> gravity;  ///< m/s^2

  KOKKOS_FUNCTION Real sum(int column, int node) const {
    const Real lower = *nodes.at(nodes.lower_sums + column, node);
    return Dim == 1 ? lower : lower + *nodes.at(nodes.upper_sums + column, node);
  }
  KOKKOS_FUNCTION Real force(int node, int i) const {
    return sum(1 + Dim + i, node) + sum(0, node) * gravity[i];
  }
};

template <int Dim, class Real, class Device>
struct KeepForce {
  LaneNodeSums<Dim, Real, Device> sums;
  Kokkos::View<Real**, Kokkos::LayoutLeft, Device> force;
  KOKKOS_FUNCTION void operator()(int node) const {
    for (int i = 0; i < Dim; ++i) force(node, i) = sums.force(node, i);
  }
};

/// One node group of the box.
template <int Dim, class Real, class Device>
struct LaneNodeBalance {
  CellLanes<Dim, Real, Device> lanes;
  LaneNodeSums<Dim, Real, Device> sums;                   ///< with virtual stress
  Kokkos::View<Real**, Kokkos::LayoutLeft, Device> bare;  ///< [node][Dim], force without, N

  KOKKOS_FUNCTION void operator()(int box_index, BalanceSums& sum) const {
    constexpr int width = Lanes<Real>::width;
    const int node_group = lanes.node_group_at(box_index);
    if (node_group < 0) return;
    for (int l = 0; l < width; ++l) {
      const int node = node_group * width + l;
      ComponentMask fixed = 0;
      Vector<Dim, double> p, f, g;
      for (int i = 0; i < Dim; ++i) {
        fixed = static_cast<ComponentMask>(fixed | (sums.nodes.fixed(node_group, i) >> l & 1) << i);
        p[i] = sums.sum(1 + i, node);
        f[i] = sums.force(node, i);
        g[i] = bare(node, i);
      }
      add_node_balance(fixed, sums.sum(0, node), p, f, g, sum);
    }
  }
};

/// The particles of one group.
template <int Dim, class Real, class Device>
struct LaneStrainEnergy {
  CellLanes<Dim, Real, Device> lanes;
  double modulus;

  KOKKOS_FUNCTION void operator()(int g, Vector<1, double>& sum) const {
    const auto& group = lanes.groups(g);
    for (size_t e = lanes.begin(group); e < lanes.end(group); ++e) {
      if (lanes.id(e) < 0) continue;
      SymmetricTensor<Dim, Real> sigma;
      for (int c = 0; c < sigma.size; ++c) sigma[c] = *lanes.at(lanes.stress_column + c, e);
      sum[0] += strain_energy_scale<Dim, Real>(sigma, *lanes.at(lanes.volume_column, e), modulus);
    }
  }
};

}  // namespace kernel

/// The balance of the particles at their present positions. `virtual_stress` is the field of the sweeps,
/// without the loads of kernels/lanes/loads.hpp. `modulus`: the constrained modulus of the material, Pa.
/// Waits for the device.
template <class Exec, class Field, int Dim, class Real, class Device>
Balance<Dim> balance(const Exec& exec, const LaneState<Dim, Real, Device>& s, double modulus,
                     const Field& virtual_stress, const Vector<Dim, Real>& gravity,
                     const FaceCover<Device>& cover = {}) {
  using Columns = decltype(s.memory.nodes.data);
  auto apart = s;
  apart.memory.lanes.mass_matrices = {};  // those of the step stay
  auto& nodes = apart.memory.nodes;
  const auto rows = static_cast<size_t>(padded_rows<Real>(s.memory.lanes.node_count));
  nodes.data = Columns("vsb::balance_sums", rows, static_cast<size_t>(2 * nodes.sum_columns));
  const Columns bare(Kokkos::view_alloc("vsb::bare_force", Kokkos::WithoutInitializing), rows, Dim);
  const kernel::LaneNodeSums<Dim, Real, Device> sums{nodes, gravity};
  detail::sum_lanes(exec, apart, NoVirtualStress{});
  Kokkos::parallel_for("vsb::keep_force", Kokkos::RangePolicy<Exec>(exec, 0, s.memory.lanes.node_count),
                       kernel::KeepForce<Dim, Real, Device>{sums, bare});
  if (Field::loaded) detail::sum_lanes(exec, apart, virtual_stress);
  auto result = detail::balance_of(
      ordered_sum<kernel::BalanceSums::size, Device>(
          exec, "vsb::lane_node_balance", static_cast<int>(s.memory.lanes.node_group_at.extent(0)),
          kernel::LaneNodeBalance<Dim, Real, Device>{s.memory.lanes, sums, bare}),
      resultant(exec, s, virtual_stress, ~TractionMask(0), cover));
  result.strain_energy =
      ordered_sum<1, Device>(exec, "vsb::lane_strain_energy", s.memory.lanes.group_count,
                             kernel::LaneStrainEnergy<Dim, Real, Device>{s.memory.lanes, modulus})[0];
  return result;
}

}  // namespace vsb
