// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Makes a mapped grid from the positions of its nodes, on the host: checks the cells, builds the raster that
/// gives the first cell of a search, and copies both to the device. The work grows as the number of cells.
#pragma once

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <vector>
#include <vsb/physics/mapped_grid.hpp>
#include <vsb/views/mapped_nodes.hpp>

namespace vsb {

/// A mapped grid with its memory. Kernels take `grid`; it is valid as long as `nodes` lives.
template <int Dim, class Real, class Device>
struct MappedMesh {
  MappedNodes<Real, Device> nodes;  ///< memory of the grid
  MappedGrid<Dim, Real> grid;       ///< points into `nodes`
};

namespace mapped {

/// Throws std::invalid_argument, naming the cell, unless det J is positive at all corners of all cells, by
/// more than the round-off of the edges' directions.
template <int Dim, class Real>
void check_cells(const MappedGrid<Dim, Real>& grid) {
  for (int n = 0; n < grid.cell_count(); ++n) {
    const auto ijk = grid.cell_ijk(n);
    const auto cell = grid.cell(ijk);
    for (int a = 0; a < grid.corners; ++a) {
      Vector<Dim, Real> xi;
      for (int i = 0; i < Dim; ++i) xi[i] = static_cast<Real>(a >> i & 1);
      const auto J = cell.at(xi).J;
      Real lengths = 1;
      for (int k = 0; k < Dim; ++k) {
        Real squared = 0;
        for (int i = 0; i < Dim; ++i) squared += J(i, k) * J(i, k);
        lengths *= std::sqrt(squared);
      }
      const Real det = determinant(J);
      if (std::isfinite(lengths) && det > 1000 * std::numeric_limits<Real>::epsilon() * lengths) continue;
      std::ostringstream text;
      text << "vsb::make_mapped_mesh: cell (";
      for (int i = 0; i < Dim; ++i) text << (i == 0 ? "" : ", ") << ijk[i];
      text << ") is degenerate or inverted: det J = " << det << " at the corner (";
      for (int i = 0; i < Dim; ++i) text << (i == 0 ? "" : ", ") << cell.corner[a][i];
      text << ") m; it must be positive at all corners";
      throw std::invalid_argument(text.str());
    }
  }
}

/// Whether coordinate i of a node depends on its number along axis i alone, and increases with it.
template <int Dim, class Real>
bool is_rectilinear(const MappedGrid<Dim, Real>& grid) {
  for (int node = 0; node < grid.node_count(); ++node) {
    const auto x = grid.node_position(node);
    const auto ijk = grid.node_ijk(node);
    for (int i = 0; i < Dim; ++i) {
      const int stride = grid.node_stride(i);
      if (x[i] != grid.node_position(ijk[i] * stride)[i]) return false;
      if (ijk[i] > 0 && !(x[i] > grid.node_position(node - stride)[i])) return false;
    }
  }
  return true;
}

/// Twice as many raster cells as the grid has cells, per direction, over the bounding box, or a single one
/// where no walk starts from it; and the tolerance.
template <int Dim, class Real>
void fit_raster(MappedGrid<Dim, Real>& grid) {
  Vector<Dim, Real> low = grid.node_position(0), high = low;
  Real magnitude = 0, shortest = std::numeric_limits<Real>::max();
  for (int node = 0; node < grid.node_count(); ++node) {
    const auto x = grid.node_position(node);
    const auto ijk = grid.node_ijk(node);
    for (int i = 0; i < Dim; ++i) {
      low[i] = std::min(low[i], x[i]);
      high[i] = std::max(high[i], x[i]);
      magnitude = std::max(magnitude, std::abs(x[i]));
      if (ijk[i] == grid.cells[i]) continue;
      const auto edge = grid.node_position(node + grid.node_stride(i)) - x;
      shortest = std::min(shortest, std::sqrt(dot(edge, edge)));
    }
  }
  // A position in m is known to epsilon times its magnitude.
  grid.tolerance = 64 * std::numeric_limits<Real>::epsilon() * std::max(Real(1), magnitude / shortest);
  const auto extent = high - low;
  double volume = 1;
  for (int i = 0; i < Dim; ++i) volume *= static_cast<double>(extent[i]);
  const double size = std::pow(volume / grid.cell_count(), 1.0 / Dim) / 2;
  Vector<Dim, Real> spacing;
  Vector<Dim, int> count;
  for (int i = 0; i < Dim; ++i) {
    const double wanted = grid.rectilinear ? 1 : std::ceil(static_cast<double>(extent[i]) / size);
    count[i] = static_cast<int>(std::min(std::max(wanted, 1.0), 4.0 * grid.cell_count()));
    spacing[i] = extent[i] / static_cast<Real>(count[i]);
  }
  grid.raster = {low, spacing, count};
}

/// For every raster cell, the grid cell that contains its centre. A raster cell beyond the grid has that of
/// the nearest raster cell, counted in steps between neighbours. The search for a centre begins at a grid
/// cell whose centre lies in the raster cell, or else at the result of a neighbour, so that it is short.
template <class Grid>
std::vector<int> start_cells(const Grid& grid) {
  constexpr int Dim = Grid::dimension;
  using Real = typename Grid::real;
  const auto& raster = grid.raster;
  std::vector<int> start(static_cast<size_t>(raster.cell_count()), -1), known;
  if (grid.rectilinear) return std::vector<int>(start.size(), 0);
  const auto entry = [&](int raster_cell) -> int& { return start[static_cast<size_t>(raster_cell)]; };
  const auto assign = [&](int raster_cell, int cell) {
    entry(raster_cell) = cell;
    known.push_back(raster_cell);
  };
  const auto centre_of = [&](int raster_cell) {
    const auto ijk = raster.cell_ijk(raster_cell);
    Vector<Dim, Real> x;
    for (int i = 0; i < Dim; ++i)
      x[i] = raster.lower[i] + (static_cast<Real>(ijk[i]) + Real(0.5)) * raster.spacing[i];
    return x;
  };
  const auto spread = [&](const auto& take) {  // to neighbours, and to theirs
    for (size_t next = 0; next < known.size(); ++next) {
      const int cell = entry(known[next]);
      const auto ijk = raster.cell_ijk(known[next]);
      for (int i = 0; i < Dim; ++i)
        for (const int step : {-1, 1}) {
          auto neighbour = ijk;
          neighbour[i] += step;
          if (neighbour[i] < 0 || neighbour[i] >= raster.cells[i]) continue;
          const int n = raster.cell_index(neighbour);
          if (entry(n) < 0) take(n, cell);
        }
    }
  };
  Vector<Dim, Real> middle;
  for (int i = 0; i < Dim; ++i) middle[i] = Real(0.5);
  for (int n = 0; n < grid.cell_count(); ++n) {
    const int r = raster.cell_index(raster.cell_containing(grid.cell(grid.cell_ijk(n)).at(middle).x));
    if (entry(r) < 0) assign(r, n);
  }
  const auto walk = [&](int raster_cell, int from) { return grid.walk(centre_of(raster_cell), from); };
  for (const int r : known)
    if (const auto location = walk(r, entry(r)); location.found) entry(r) = grid.cell_index(location.cell);
  spread([&](int r, int from) {
    if (const auto location = walk(r, from); location.found) assign(r, grid.cell_index(location.cell));
  });
  spread(assign);
  return start;
}

}  // namespace mapped

/// `position` maps the logical coordinates of a node (see CellNumbering) to its position in m. Throws
/// std::invalid_argument for a cell that is degenerate or inverted.
template <class Real, class Device, int Dim, class Position>
MappedMesh<Dim, Real, Device> make_mapped_mesh(const Vector<Dim, int>& cells, const Position& position) {
  MappedGrid<Dim, Real> grid{};
  grid.cells = cells;
  for (int i = 0; i < Dim; ++i)
    if (cells[i] < 1) throw std::invalid_argument("vsb::make_mapped_mesh: at least one cell per direction");
  std::vector<Real> positions;
  for (int node = 0; node < grid.node_count(); ++node) {
    const auto x = position(grid.node_ijk(node));
    for (int i = 0; i < Dim; ++i) positions.push_back(static_cast<Real>(x[i]));
  }
  grid.position = positions.data();
  mapped::check_cells(grid);
  grid.rectilinear = mapped::is_rectilinear(grid);
  mapped::fit_raster(grid);
  const auto start = mapped::start_cells(grid);

  using Host = Kokkos::MemoryTraits<Kokkos::Unmanaged>;
  const auto nodes = static_cast<size_t>(grid.node_count());
  MappedNodes<Real, Device> memory;
  memory.position = decltype(memory.position)("vsb::mapped_node_position", nodes, Dim);
  memory.start_cell = decltype(memory.start_cell)("vsb::mapped_start_cell", start.size());
  Kokkos::deep_copy(memory.position, Kokkos::View<const Real**, Kokkos::LayoutRight, Kokkos::HostSpace, Host>(
                                         positions.data(), nodes, Dim));
  Kokkos::deep_copy(memory.start_cell,
                    Kokkos::View<const int*, Kokkos::HostSpace, Host>(start.data(), start.size()));
  grid.position = memory.position.data();
  grid.start_cell = memory.start_cell.data();
  return {memory, grid};
}

}  // namespace vsb
