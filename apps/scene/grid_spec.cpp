// SPDX-License-Identifier: BSD-3-Clause
#include "scene/grid_spec.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "scene/units.hpp"

namespace vsb::app {

Point position_of(const GridSpec& grid, const Point& q) {
  if (!grid.polar) return q;
  double cosine = std::cos(q[1]), sine = std::sin(q[1]);
  // Nodes at a multiple of 90 degrees lie on the axis itself, where symmetry planes and surfaces are.
  if (std::abs(cosine) < 1e-15) cosine = 0;
  if (std::abs(sine) < 1e-15) sine = 0;
  return {grid.center[0] + q[0] * cosine, grid.center[1] + q[0] * sine, q[2]};
}

Point logical_coordinates(const GridSpec& grid, const Point& x) {
  if (!grid.polar) return x;
  const double dx = x[0] - grid.center[0], dy = x[1] - grid.center[1], turn = 2 * pi;
  const double middle = 0.5 * (grid.coordinates[1].front() + grid.coordinates[1].back());
  double theta = std::atan2(dy, dx);
  while (theta < middle - pi) theta += turn;
  while (theta > middle + pi) theta -= turn;
  return {std::hypot(dx, dy), theta, x[2]};
}

std::pair<double, double> extent(const GridSpec& grid, size_t axis) {
  if (grid.mapped()) return {grid.coordinates[axis].front(), grid.coordinates[axis].back()};
  return {grid.lower[axis], grid.lower[axis] + grid.cells[axis] * grid.spacing[axis]};
}

std::string GridSpec::axis_name(size_t axis) const {
  static const char* const names[2][3] = {{"x", "y", "z"}, {"r", "theta", "z"}};
  return names[polar ? 1 : 0][axis];
}

Point node_position(const GridSpec& grid, int dimension, const std::array<int, 3>& ijk) {
  Point q{};
  for (size_t i = 0; i < static_cast<size_t>(dimension); ++i)
    q[i] = grid.mapped() ? grid.coordinates[i][static_cast<size_t>(ijk[i])]
                         : grid.lower[i] + static_cast<double>(ijk[i]) * grid.spacing[i];
  return grid.mapped() ? position_of(grid, q) : q;
}

double shortest_edge(const GridSpec& grid, int dimension) {
  if (!grid.mapped()) return *std::min_element(grid.spacing.begin(), grid.spacing.begin() + dimension);
  double shortest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < static_cast<size_t>(dimension); ++i)
    for (size_t k = 0; k + 1 < grid.coordinates[i].size(); ++k) {
      const double interval = grid.coordinates[i][k + 1] - grid.coordinates[i][k];
      const bool around = grid.polar && i == 1;  // a chord of the innermost circle
      shortest = std::min(shortest, around ? 2 * grid.coordinates[0][0] * std::sin(interval / 2) : interval);
    }
  return shortest;
}

AxisBox bounding_box(const GridSpec& grid, int dimension) {
  AxisBox box;
  const auto d = static_cast<size_t>(dimension);
  if (!grid.polar) {
    for (size_t i = 0; i < d; ++i) {
      std::tie(box.lower[i], box.upper[i]) = extent(grid, i);
    }
    return box;
  }
  const double infinity = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < d; ++i) {
    box.lower[i] = infinity;
    box.upper[i] = -infinity;
  }
  const int layers = dimension == 3 ? grid.cells[2] : 0;
  for (int k = 0; k <= layers; ++k)
    for (int j = 0; j <= grid.cells[1]; ++j)
      for (const int i : {0, grid.cells[0]}) {
        const Point x = node_position(grid, dimension, {i, j, k});
        for (size_t c = 0; c < d; ++c) {
          box.lower[c] = std::min(box.lower[c], x[c]);
          box.upper[c] = std::max(box.upper[c], x[c]);
        }
      }
  return box;
}

bool contains(const GridSpec& grid, int dimension, const Point& x) {
  const Point q = logical_coordinates(grid, x);
  for (size_t i = 0; i < static_cast<size_t>(dimension); ++i) {
    const auto [low, high] = extent(grid, i);
    if (!(q[i] >= low && q[i] <= high)) return false;
  }
  return true;
}

CellShare cell_share(const GridSpec& grid, int dimension, const std::array<int, 3>& per_cell,
                     const std::array<long long, 3>& ijk) {
  Point q{}, edges{};
  double volume = 1;
  for (size_t i = 0; i < static_cast<size_t>(dimension); ++i) {
    const auto cell = static_cast<size_t>(ijk[i] / per_cell[i]);
    const double low = grid.coordinates[i][cell];
    const double interval = (grid.coordinates[i][cell + 1] - low) / per_cell[i];
    volume *= interval;
    edges[i] = interval;
    q[i] = low + (static_cast<double>(ijk[i] % per_cell[i]) + 0.5) * interval;
  }
  if (grid.polar) {
    volume *= q[0];
    edges[1] *= q[0];
  }
  return {position_of(grid, q), volume, edges};
}

}  // namespace vsb::app
