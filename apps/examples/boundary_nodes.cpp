// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A shared library that has vsb find the boundary nodes of particles, of which it takes the positions alone;
/// boundary_nodes_main.cpp uses it.
#include <vsb/kernels/boundary/update_occupancy.hpp>
#include <vsb/physics/linear_basis.hpp>

using Exec = Kokkos::DefaultHostExecutionSpace;
using Device = Exec::device_type;

/// Boundary nodes of n particles at x[n][2] in a grid of `cells` x `cells` cells of 1 m from the origin on.
extern "C" int count_boundary_nodes(double* x, int n, int cells) {
  const Kokkos::ScopeGuard kokkos;
  vsb::Particles<2, double, Device> particles;
  particles.position = particles.wrap(x, n, 2, 2);
  const vsb::LinearBasis<2, double> basis{
      vsb::UniformGrid<2, double>({{0.0, 0.0}}, {{1.0, 1.0}}, {{cells, cells}})};
  auto occupancy = vsb::allocate_occupancy<Device>(particles.count(), basis);
  Kokkos::deep_copy(occupancy.tractions, vsb::TractionMask(1));  // declared everywhere
  const int lost = vsb::update_occupancy(Exec(), particles, occupancy, basis);
  return lost < 0 ? occupancy.boundary_node_count : -1;
}
