// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Makes a mapped grid out of the positions of its nodes, on the host: checks the cells, builds the raster
/// from which walks start, and copies both to the device.
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
  MappedNodes<Real, Device> nodes;
  MappedGrid<Dim, Real> grid;
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

/// Twice as many raster cells as the grid has cells, per direction, over the bounding box; and the tolerance.
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
    const double wanted = std::ceil(static_cast<double>(extent[i]) / size);
    count[i] = static_cast<int>(std::min(std::max(wanted, 1.0), 4.0 * grid.cell_count()));
    spacing[i] = extent[i] / static_cast<Real>(count[i]);
  }
  grid.raster = {low, spacing, count};
}

/// Per raster cell, the first grid cell that contains its centre; beyond the grid, that of the nearest raster
/// cell in steps between neighbours.
template <int Dim, class Real>
std::vector<int> start_cells(const MappedGrid<Dim, Real>& grid) {
  const auto& raster = grid.raster;
  std::vector<int> start(static_cast<size_t>(raster.cell_count()), -1), known;
  const auto assign = [&](int raster_cell, int cell) {
    auto& entry = start[static_cast<size_t>(raster_cell)];
    if (entry >= 0) return;
    entry = cell;
    known.push_back(raster_cell);
  };
  const auto centre = [](const Vector<Dim, int>& ijk) {
    Vector<Dim, Real> q;
    for (int i = 0; i < Dim; ++i) q[i] = static_cast<Real>(ijk[i]) + Real(0.5);
    return q;
  };
  for (int n = 0; n < grid.cell_count(); ++n) {
    typename MappedGrid<Dim, Real>::Place place{grid.cell_ijk(n), Vector<Dim, Real>::zero(), false};
    const auto cell = grid.cell(place.cell);
    Vector<Dim, int> first, last;
    for (int i = 0; i < Dim; ++i) {
      Real low = cell.corner[0][i], high = low;
      for (const auto& x : cell.corner) {
        low = std::min(low, x[i]);
        high = std::max(high, x[i]);
      }
      const auto number = [&](Real x) {
        const Real q = (x - raster.lower[i]) * raster.inverse_spacing[i];
        return std::min(std::max(static_cast<int>(q), 0), raster.cells[i] - 1);
      };
      first[i] = number(low);
      last[i] = number(high);
    }
    auto at = first;
    for (bool more = true; more;) {
      Vector<Dim, Real> x = centre(at);
      for (int i = 0; i < Dim; ++i) x[i] = raster.lower[i] + x[i] * raster.spacing[i];
      if (grid.inside(x, place)) assign(raster.cell_index(at), n);
      more = false;
      for (int i = 0; i < Dim && !more; ++i) {
        more = ++at[i] <= last[i];
        if (!more) at[i] = first[i];
      }
    }
  }
  for (int n = 0; n < grid.cell_count(); ++n) {  // cells smaller than the raster's
    const auto cell = grid.cell(grid.cell_ijk(n));
    assign(raster.cell_index(raster.cell_containing(cell.at(centre(Vector<Dim, int>::zero())).x)), n);
  }
  for (size_t next = 0; next < known.size(); ++next) {
    const int cell = start[static_cast<size_t>(known[next])];
    const auto ijk = raster.cell_ijk(known[next]);
    for (int i = 0; i < Dim; ++i)
      for (const int step : {-1, 1}) {
        auto neighbour = ijk;
        neighbour[i] += step;
        if (neighbour[i] >= 0 && neighbour[i] < raster.cells[i]) assign(raster.cell_index(neighbour), cell);
      }
  }
  return start;
}

}  // namespace mapped

/// `position` maps the logical coordinates of a node (see CellNumbering) to its place in m. Throws
/// std::invalid_argument for a cell that is degenerate or inverted.
template <class Real, class Device, int Dim, class Position>
MappedMesh<Dim, Real, Device> make_mapped_mesh(const Vector<Dim, int>& cells, const Position& position) {
  MappedGrid<Dim, Real> grid{};
  grid.cells = cells;
  for (int i = 0; i < Dim; ++i)
    if (cells[i] < 1) throw std::invalid_argument("vsb::make_mapped_mesh: at least one cell per direction");
  std::vector<Real> places;
  for (int node = 0; node < grid.node_count(); ++node) {
    const auto x = position(grid.node_ijk(node));
    for (int i = 0; i < Dim; ++i) places.push_back(static_cast<Real>(x[i]));
  }
  grid.position = places.data();
  mapped::check_cells(grid);
  mapped::fit_raster(grid);
  const auto start = mapped::start_cells(grid);

  using Host = Kokkos::MemoryTraits<Kokkos::Unmanaged>;
  const auto nodes = static_cast<size_t>(grid.node_count());
  MappedNodes<Real, Device> memory;
  memory.position = decltype(memory.position)("vsb::mapped_node_position", nodes, Dim);
  memory.start_cell = decltype(memory.start_cell)("vsb::mapped_start_cell", start.size());
  Kokkos::deep_copy(memory.position, Kokkos::View<const Real**, Kokkos::LayoutRight, Kokkos::HostSpace, Host>(
                                         places.data(), nodes, Dim));
  Kokkos::deep_copy(memory.start_cell,
                    Kokkos::View<const int*, Kokkos::HostSpace, Host>(start.data(), start.size()));
  grid.position = memory.position.data();
  grid.start_cell = memory.start_cell.data();
  return {memory, grid};
}

}  // namespace vsb
