// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The fields of the nodes of the background grid.
#pragma once

#include <vsb/views/masks.hpp>
#include <vsb/views/tensor.hpp>

namespace vsb {

/// The nodal velocity by which particles and surface points move.
enum class PositionVelocity {
  strain,  ///< v*_I of the re-map, by which they strain too
  grid  ///< v_I before it, as in the paper: positions and strains part, and where sigma - sbar is in tension
        ///< the difference feeds energy into a body
};

/// Nodal fields, one row per node. Fields that particles scatter together are stored together, in rows of
/// (mass, momentum, force); accessors give them their names.
template <int Dim, class Real, class Device>
struct Nodes {
  static constexpr int dimension = Dim;  ///< of space: 1, 2 or 3
  /// Columns of `sums`.
  static constexpr int sum_columns = 1 + 2 * Dim;
  using real = Real;                                                 ///< type of the numbers
  using device = Device;                                             ///< where the memory is
  using Fields = Kokkos::View<Real**, Kokkos::LayoutRight, Device>;  ///< one row per node

  Fields sums;               ///< [node][1 + 2 Dim]: mass in kg, momentum in kg m/s, force in N
  Fields acceleration;       ///< [node][Dim], m/s^2; zero in prescribed components
  Fields velocity;           ///< [node][Dim], m/s; at the end of the step, before the re-map
  Fields remapped_velocity;  ///< [node][Dim], m/s; the re-mapped velocity of MUSL (during the re-map: its
                             ///< momentum)
  Kokkos::View<ComponentMask*, Device> fixed_components;  ///< [node]: prescribed velocity components

  /// The velocity that moves particles and surface points.
  KOKKOS_FUNCTION const Fields& velocity_for(PositionVelocity which) const {
    return which == PositionVelocity::grid ? velocity : remapped_velocity;
  }
  /// Number of nodes.
  KOKKOS_FUNCTION int count() const { return static_cast<int>(sums.extent(0)); }
  /// The mass of a node in kg (kg/m^2 in 1D, kg/m in 2D); Eq. (10).
  KOKKOS_FUNCTION Real& mass(int node) const { return sums(node, 0); }
  /// Component i of the momentum of a node, kg m/s.
  KOKKOS_FUNCTION Real& momentum(int node, int i) const { return sums(node, 1 + i); }
  /// Component i of the force on a node, N; internal and external together.
  KOKKOS_FUNCTION Real& force(int node, int i) const { return sums(node, 1 + Dim + i); }
};

/// [node]: the tractions that act at a node; zero for nodes outside N1 (see
/// kernels/boundary/mark_boundary_nodes.hpp).
template <class Device>
using BoundaryNodes = Kokkos::View<TractionMask*, Device>;

/// Allocates zero-filled nodal fields without prescribed components.
template <int Dim, class Real, class Device>
Nodes<Dim, Real, Device> allocate_nodes(int n) {
  using Fields = typename Nodes<Dim, Real, Device>::Fields;
  const auto rows = static_cast<size_t>(n);
  Nodes<Dim, Real, Device> nodes;
  nodes.sums = Fields("vsb::node_sums", rows, Nodes<Dim, Real, Device>::sum_columns);
  nodes.acceleration = Fields("vsb::node_acceleration", rows, Dim);
  nodes.velocity = Fields("vsb::node_velocity", rows, Dim);
  nodes.remapped_velocity = Fields("vsb::node_remapped_velocity", rows, Dim);
  nodes.fixed_components = decltype(nodes.fixed_components)("vsb::node_fixed_components", rows);
  return nodes;
}

}  // namespace vsb
