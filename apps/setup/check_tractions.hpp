// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Refuses scenes whose tractions would not act as declared, or have no support.
#pragma once

#include <fmt/format.h>

#include <vsb/kernels/statics/unsupported_load.hpp>
#include "setup/loads.hpp"
#include "setup/scene_grid.hpp"
#include "setup/support_text.hpp"

namespace vsb::app {

/// Every traction must have boundary nodes or surface points, and the body must not touch an open face of the
/// grid where one is declared: there are no void cells beyond a face, so part of the load would be missing
/// without a word. carried [particle]: tractions that move with it; empty where none does. Throws SetupError.
template <class Basis, class Device, int Dim, class Real>
void check_tractions(const Scene& scene, const Basis& basis, const Occupancy<Device>& occupancy,
                     const Loads<Dim, Real>& loads, TractionMask on_surface,
                     const std::vector<TractionMask>& carried, const PlacedParticles& placed) {
  if (scene.tractions.empty()) return;
  const auto boundary =
      Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), occupancy.boundary, "vsb::boundary on host");
  const auto declared =
      Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), occupancy.tractions, "vsb::declared on host");
  TractionMask acting = on_surface;
  for (size_t node = 0; node < boundary.extent(0); ++node) acting |= boundary(node);
  for (size_t k = 0; k < scene.tractions.size(); ++k) {
    if (acting >> k & 1u) continue;
    if (!(loads.on_nodes() >> k & 1u))
      throw SetupError(
          scene.tractions[k].where,
          fmt::format(
              "traction '{}' finds no surface of a body{}, so it would load nothing: check its 'surface'",
              scene.tractions[k].name,
              scene.tractions[k].imposition == Imposition::nodal ? " that follows faces of cells" : ""));
    throw SetupError(
        scene.tractions[k].where,
        fmt::format(
            "traction '{}' finds no boundary node, so it would load nothing. A boundary node belongs to a "
            "cell "
            "without particles or to one that touches such a cell; leave at least one empty cell beyond the "
            "loaded boundary (a smaller grid spacing, or a larger grid), or set method.fill_criterion, and "
            "check "
            "the traction's 'surface'",
            scene.tractions[k].name));
  }
  const Point origin = local_origin(scene);
  for (size_t p = 0; p < placed.position.size(); ++p) {
    const auto shape = basis.shape(to_local<Vector<Dim, Real>>(placed.position[p], origin));
    const TractionMask own = carried.empty() ? 0 : carried[p];
    for (int a = 0; a < Basis::support; ++a) {
      const auto ijk = basis.grid.node_ijk(shape.node[a]);
      if (own == 0 && (declared(static_cast<size_t>(shape.node[a])) & ~loads.at_all_active_nodes()) == 0)
        continue;
      for (int i = 0; i < Dim; ++i) {
        const auto& faces = scene.faces.fixed[static_cast<size_t>(i)];
        const bool lower = ijk[i] == 0 && faces[0] == 0,
                   upper = ijk[i] == basis.grid.cells[i] && faces[1] == 0;
        if (!lower && !upper) continue;
        const auto& body = body_of(scene, placed, p);
        throw SetupError(body.where, fmt::format("body '{}' reaches the open face {}_{} of the grid, where a "
                                                 "traction is declared: leave at least "
                                                 "one empty cell between them, or give the face a condition, "
                                                 "or the traction another 'surface'",
                                                 body.name, scene.grid.axis_name(static_cast<size_t>(i)),
                                                 lower ? "min" : "max"));
      }
    }
  }
}

/// What no support takes up of the loads, in words (support_text.hpp); empty where nothing is found.
template <int Dim>
std::string text(const Scene& scene, const UnsupportedLoad<Dim>& load) {
  if (!load.found) return {};
  LooseLoad loose{load.share, to_scene(load.middle, local_origin(scene))};
  for (int i = 0; i < Dim; ++i) loose.force[static_cast<size_t>(i)] = load.force[i];
  for (int i = 0; i < 3; ++i) loose.torque[static_cast<size_t>(i)] = load.torque[i];
  return support_text(scene, loose);
}

/// Throws SetupError for a load of a static solution that nothing takes up.
template <int Dim>
void refuse_unsupported(const Scene& scene, const UnsupportedLoad<Dim>& load) {
  if (load.found) throw SetupError(fmt::format("--static: there is no static state: {}", text(scene, load)));
}

}  // namespace vsb::app
