// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Where a void filter starts from: the cells whose centre lies in no body are outside at first.
#pragma once

#include <vsb/kernels/boundary/mark_boundary_nodes.hpp>
#include "setup/local_origin.hpp"

namespace vsb::app {

/// Takes the cells whose centre lies in a body out of a set of cells.
template <class Device, class Grid>
void remove_body_cells(const Scene& scene, const Grid& grid, const typename CellBits<Device>::Rows& cells) {
  constexpr int dimension = Grid::dimension;
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), cells, "vsb::cells on host");
  const Point origin = local_origin(scene);
  for (int n = 0; n < grid.cell_count(); ++n) {
    const auto cell = grid.cell_ijk(n);
    Vector<dimension, typename Grid::real> middle;
    for (int i = 0; i < dimension; ++i) middle[i] = typename Grid::real(0.5);
    const Point centre = to_scene(grid.map(cell, middle).x, origin);
    for (const auto& body : scene.bodies)
      if (body.region(centre))
        host(static_cast<size_t>(n / grid.cells[0]), static_cast<size_t>(cell[0] / 64)) &=
            ~(std::uint64_t(1) << (cell[0] % 64));
  }
  Kokkos::deep_copy(cells, host);
}

}  // namespace vsb::app
