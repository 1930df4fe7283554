// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The nodes of a scene's grid on the host.
#pragma once

#include <vsb/views/nodes.hpp>
#include "engine/simulation.hpp"
#include "setup/scene_grid.hpp"

namespace vsb::app {

/// From nodes after the update of their velocities.
template <class Basis, int Dim, class Real, class Device>
GridSnapshot read_nodes(const Scene& scene, const Basis& basis, const Nodes<Dim, Real, Device>& of,
                        const BoundaryNodes<Device>& loaded) {
  const auto on_host = [](const auto& view) {
    return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), view, "vsb::nodes on host");
  };
  const auto sums = on_host(of.sums), velocity = on_host(of.velocity);
  const auto boundary = on_host(loaded);
  const auto nodes = scene_nodes(scene, basis);
  const auto n = nodes.size();
  GridSnapshot g;
  g.mass.resize(n);
  g.boundary.resize(n);
  g.velocity.assign(3 * n, 0.0);
  g.force.assign(3 * n, 0.0);
  for (size_t i = 0; i < n; ++i) {
    const size_t I = nodes[i];
    g.mass[i] = sums(I, 0);
    g.boundary[i] = boundary(I) != 0;
    for (size_t d = 0; d < Dim; ++d) {
      g.velocity[3 * i + d] = velocity(I, d);
      g.force[3 * i + d] = sums(I, 1 + Dim + d);
    }
  }
  return g;
}

}  // namespace vsb::app
