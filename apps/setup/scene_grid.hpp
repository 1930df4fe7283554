// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The nodes and cells of a scene's grid among those of a basis, whose grid may have a layer of ghost cells
/// around it.
#pragma once

#include <array>
#include <vector>
#include <vsb/kernels/boundary/mark_boundary_nodes.hpp>
#include "setup/field_advice.hpp"
#include "setup/local_origin.hpp"

namespace vsb::app {

/// A node's numbers along the axes in the scene's grid.
template <class Basis>
std::array<int, 3> ijk_in_scene(const Basis& basis, int node) {
  const auto ijk = basis.grid.node_ijk(node);
  std::array<int, 3> in_scene{};
  for (int i = 0; i < Basis::dimension; ++i) in_scene[static_cast<size_t>(i)] = ijk[i] - Basis::ghost_layers;
  return in_scene;
}

/// The nodes of the scene's grid.
template <class Basis>
std::vector<size_t> scene_nodes(const Scene& scene, const Basis& basis) {
  std::vector<size_t> nodes;
  for (int node = 0; node < basis.node_count(); ++node) {
    const auto ijk = ijk_in_scene(basis, node);
    bool ghost = false;
    for (size_t i = 0; i < Basis::dimension; ++i) ghost = ghost || ijk[i] < 0 || ijk[i] > scene.grid.cells[i];
    if (!ghost) nodes.push_back(static_cast<size_t>(node));
  }
  return nodes;
}

/// The cells of the scene's grid.
inline size_t scene_cell_count(const Scene& scene) {
  size_t count = 1;
  for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i)
    count *= static_cast<size_t>(scene.grid.cells[i]);
  return count;
}

/// The number in the scene's grid of a cell of the basis's, along x first.
template <class Basis>
size_t scene_cell(const Scene& scene, const Basis&, const Vector<Basis::dimension, int>& cell) {
  int index = 0;
  for (int i = Basis::dimension - 1; i >= 0; --i)
    index = index * scene.grid.cells[static_cast<size_t>(i)] + (cell[i] - Basis::ghost_layers);
  return static_cast<size_t>(index);
}

/// The cells of the scene's grid that hold particles.
template <class Basis>
OccupiedCells occupied_cells(const Scene& scene, const Basis& basis, const PlacedParticles& placed) {
  using Real = typename decltype(basis.grid)::real;
  const Point origin = local_origin(scene);
  OccupiedCells cells;
  for (size_t i = 0; i < Basis::dimension; ++i) cells.cells[i] = scene.grid.cells[i];
  cells.occupied.resize(scene_cell_count(scene));
  for (const Point& x : placed.position)
    cells.occupied[scene_cell(
        scene, basis, basis.grid.cell_containing(to_local<Vector<Basis::dimension, Real>>(x, origin)))] =
        true;
  return cells;
}

/// Adds the voids that the filter tells from the outside, whose cells are `outside`.
template <class Device, class Basis>
void add_voids(const Scene& scene, const Basis& basis, const typename CellBits<Device>::Rows& outside,
               OccupiedCells& cells) {
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), outside, "vsb::outside on host");
  const auto& grid = basis.grid;
  for (int n = 0; n < grid.cell_count(); ++n) {
    const auto ijk = grid.cell_ijk(n);
    bool in_scene = true;
    for (int i = 0; i < Basis::dimension; ++i) {
      const int along = ijk[i] - Basis::ghost_layers;
      in_scene = in_scene && along >= 0 && along < scene.grid.cells[static_cast<size_t>(i)];
    }
    const auto word = host(static_cast<size_t>(n / grid.cells[0]), static_cast<size_t>(ijk[0] / 64));
    if (in_scene && (word >> (ijk[0] % 64) & 1u) == 0) cells.occupied[scene_cell(scene, basis, ijk)] = true;
  }
}

}  // namespace vsb::app
