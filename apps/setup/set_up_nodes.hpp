// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What a scene prescribes and declares at the nodes.
#pragma once

#include "setup/loads.hpp"
#include "setup/scene_grid.hpp"

namespace vsb::app {

/// The components that the conditions at the faces of the grid prescribe.
template <class Basis, class View>
void fix_faces(const Scene& scene, const Basis& basis, const View& fixed_components) {
  const auto mask = Kokkos::create_mirror_view(fixed_components);
  for (int node = 0; node < basis.node_count(); ++node) {
    const auto ijk = ijk_in_scene(basis, node);
    ComponentMask fixed = 0;
    for (size_t i = 0; i < Basis::dimension; ++i) {
      const auto& faces = scene.faces.fixed[i];
      if (ijk[i] == 0) fixed = static_cast<ComponentMask>(fixed | faces[0]);
      if (ijk[i] == scene.grid.cells[i]) fixed = static_cast<ComponentMask>(fixed | faces[1]);
    }
    mask(node) = fixed;
  }
  Kokkos::deep_copy(fixed_components, mask);
}

/// The tractions, of those imposed on nodes, in whose surface each node lies.
template <class Device, class Basis>
BoundaryNodes<Device> declared_tractions(const Scene& scene, const Basis& basis, TractionMask on_nodes) {
  const BoundaryNodes<Device> declared("vsb::declared_tractions", static_cast<size_t>(basis.node_count()));
  const auto mask = Kokkos::create_mirror_view(declared);
  for (int node = 0; node < basis.node_count(); ++node)
    mask(node) =
        tractions_at(scene, on_nodes, node_position(scene.grid, Basis::dimension, ijk_in_scene(basis, node)));
  Kokkos::deep_copy(declared, mask);
  return declared;
}

}  // namespace vsb::app
