// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Algorithm 1 with its three steps written out over cells and their nodes, and bodies to try it on.
#pragma once

#include <set>

#include "support.hpp"

namespace vsb::test {

/// A grid as lists: the nodes of each cell, numbered along x first.
struct CellNodes {
  std::vector<std::vector<int>> nodes_of_cell;
  int node_count;
};

template <int Dim, class Real>
CellNodes list_nodes(const UniformGrid<Dim, Real>& grid) {
  int cells[3] = {0, 0, 0};
  for (int i = 0; i < Dim; ++i) cells[i] = grid.cells[i];
  const auto [nx, ny, nz] = cells;
  CellNodes list{{}, (nx + 1) * (ny + 1) * (nz + 1)};
  for (int k = 0; k < std::max(nz, 1); ++k)
    for (int j = 0; j < std::max(ny, 1); ++j)
      for (int i = 0; i < nx; ++i) {
        list.nodes_of_cell.emplace_back();
        for (int c = k; c <= k + (nz > 0); ++c)
          for (int b = j; b <= j + (ny > 0); ++b)
            for (int a = i; a <= i + 1; ++a)
              list.nodes_of_cell.back().push_back((c * (ny + 1) + b) * (nx + 1) + a);
      }
  return list;
}

/// Algorithm 1, as printed.
inline std::set<int> algorithm_1(const CellNodes& grid, const std::vector<bool>& void_cell) {
  const auto touches = [&](size_t cell, const std::set<int>& nodes) {
    for (const int node : grid.nodes_of_cell[cell])
      if (nodes.count(node)) return true;
    return false;
  };
  const auto nodes_of = [&](const std::set<size_t>& cells) {
    std::set<int> nodes;
    for (const size_t cell : cells)
      nodes.insert(grid.nodes_of_cell[cell].begin(), grid.nodes_of_cell[cell].end());
    return nodes;
  };
  std::set<size_t> filled, e1, e2;
  for (size_t cell = 0; cell < void_cell.size(); ++cell)
    if (!void_cell[cell]) filled.insert(cell);
  const std::set<int> active = nodes_of(filled);
  for (size_t cell = 0; cell < void_cell.size(); ++cell)  // step 1
    if (void_cell[cell] && touches(cell, active)) e1.insert(cell);
  const std::set<int> nodes_of_e1 = nodes_of(e1);
  for (size_t cell = 0; cell < void_cell.size(); ++cell)  // step 2
    if (!void_cell[cell] && touches(cell, nodes_of_e1)) e2.insert(cell);
  std::set<int> n1;  // step 3
  const std::set<size_t> both[] = {e1, e2};
  for (const auto& cells : both)
    for (const int node : nodes_of(cells))
      if (active.count(node)) n1.insert(node);
  return n1;
}

/// Particles at random positions in the cells that are not void: one or two in each.
template <int Dim, class Real>
ParticleBlock<Dim, Real, Device> populate(const UniformGrid<Dim, Real>& grid,
                                          const std::vector<bool>& void_cell, Random& random) {
  std::vector<Vector<Dim, Real>> positions;
  size_t number = 0;
  for_each_cell(grid, [&](const Vector<Dim, int>& cell) {
    if (void_cell[number++]) return;
    for (int copies = 1 + random.index(2); copies > 0; --copies) {
      Vector<Dim, Real> x;
      for (int i = 0; i < Dim; ++i)
        x[i] = grid.lower[i] + grid.spacing[i] * (static_cast<Real>(cell[i]) + random.draw<Real>(0.01, 0.99));
      positions.push_back(x);
    }
  });
  random.shuffle(positions);
  const auto block = allocate_particles<Dim, Real, Device>(static_cast<int>(positions.size()));
  edit(block, [&](const auto& particles) {
    for (int p = 0; p < particles.count(); ++p) {
      for (int i = 0; i < Dim; ++i) particles.position(p, i) = positions[static_cast<size_t>(p)][i];
      particles.mass(p) = particles.volume(p) = Real(1);
    }
  });
  return block;
}

}  // namespace vsb::test
