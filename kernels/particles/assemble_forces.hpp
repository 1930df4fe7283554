// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Mass, momentum and force of all nodes, the sum of
///   particles with the virtual stress, Eq. (27), Eq. (28): kernels/particles/particles_to_grid.hpp;
///   whole cells, of the original method, Eq. (21), Eq. (22): kernels/particles/original_virtual_stress.hpp;
///   surface points, Eq. (12), Eq. (13): kernels/particles/surface_traction.hpp.
/// The sums of ghost nodes beyond walls are added to those of their images.
#pragma once

#include <vsb/kernels/boundary/update_occupancy.hpp>
#include <vsb/kernels/particles/original_virtual_stress.hpp>
#include <vsb/kernels/particles/particles_to_grid.hpp>
#include <vsb/kernels/particles/surface_traction.hpp>

namespace vsb {

/// Memory that the sums keep between calls.
template <class Real, class Device>
struct ForceWorkspace {
  ///@{
  /// Of the sums over particles, and over surface points.
  ScatterWorkspace<Real, Device> particles, surface;
  ///@}
};

/// Overwrites nodes.sums; the occupancy must be up to date. Returns -1, or the lowest number of a surface
/// point outside the grid.
template <class Exec, class Basis, class Field, int Dim, class Real, class Device>
int assemble_forces(const Exec& exec, const Particles<Dim, Real, Device>& particles,
                    const Occupancy<Device>& occupancy, SurfacePoints<Dim, Real, Device>& surface,
                    const Nodes<Dim, Real, Device>& nodes, ForceWorkspace<Real, Device>& workspace,
                    const Basis& basis, const Field& virtual_stress, const Vector<Dim, Real>& gravity,
                    Scatter strategy) {
  particles_to_grid(exec, particles, occupancy.bins, nodes, occupancy.boundary, workspace.particles, basis,
                    virtual_stress, gravity, strategy);
  if constexpr (Field::cell_quadrature)
    subtract_cell_virtual_stress(exec, nodes, occupancy.boundary, basis, virtual_stress);
  const int lost =
      add_surface_tractions(exec, surface, nodes, workspace.surface, basis, virtual_stress, strategy);
  fold_ghost_nodes(exec, basis, nodes.sums, 1);
  return lost;
}

}  // namespace vsb
