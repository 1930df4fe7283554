// SPDX-License-Identifier: BSD-3-Clause
#include "scene/grid_spec.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vsb::app {

namespace {

/// The place of coordinates along the logical axes of a mapped grid.
Point place(const GridSpec& grid, const Point& q) {
  if (!grid.polar) return q;
  double cosine = std::cos(q[1]), sine = std::sin(q[1]);
  // Nodes at a multiple of 90 degrees lie on the axis itself, where symmetry planes and surfaces are.
  if (std::abs(cosine) < 1e-15) cosine = 0;
  if (std::abs(sine) < 1e-15) sine = 0;
  return {grid.center[0] + q[0] * cosine, grid.center[1] + q[0] * sine, q[2]};
}

}  // namespace

std::string GridSpec::axis_name(size_t axis) const {
  static const char* const names[2][3] = {{"x", "y", "z"}, {"r", "theta", "z"}};
  return names[polar ? 1 : 0][axis];
}

Point node_position(const GridSpec& grid, int dimension, const std::array<int, 3>& ijk) {
  Point q{};
  for (size_t i = 0; i < static_cast<size_t>(dimension); ++i)
    q[i] = grid.mapped() ? grid.coordinates[i][static_cast<size_t>(ijk[i])]
                         : grid.lower[i] + static_cast<double>(ijk[i]) * grid.spacing[i];
  return grid.mapped() ? place(grid, q) : q;
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

GridBox bounding_box(const GridSpec& grid, int dimension) {
  GridBox box;
  const auto d = static_cast<size_t>(dimension);
  if (!grid.polar) {
    for (size_t i = 0; i < d; ++i) {
      box.lower[i] = grid.lower[i];
      box.upper[i] =
          grid.mapped() ? grid.coordinates[i].back() : grid.lower[i] + grid.cells[i] * grid.spacing[i];
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
  Point q = x, low, high;
  if (grid.polar) {
    q[0] = std::hypot(x[0] - grid.center[0], x[1] - grid.center[1]);
    q[1] = std::atan2(x[1] - grid.center[1], x[0] - grid.center[0]);
    const double turn = 2 * std::acos(-1.0);
    while (q[1] < grid.coordinates[1].front()) q[1] += turn;
    while (q[1] >= grid.coordinates[1].front() + turn) q[1] -= turn;
    for (size_t i = 0; i < 3; ++i) {
      low[i] = grid.coordinates[i].empty() ? 0 : grid.coordinates[i].front();
      high[i] = grid.coordinates[i].empty() ? 0 : grid.coordinates[i].back();
    }
  } else {
    const auto box = bounding_box(grid, dimension);
    low = box.lower;
    high = box.upper;
  }
  for (size_t i = 0; i < static_cast<size_t>(dimension); ++i)
    if (!(q[i] >= low[i] && q[i] <= high[i])) return false;
  return true;
}

CellShare cell_share(const GridSpec& grid, int dimension, const std::array<int, 3>& per_cell,
                     const std::array<long long, 3>& ijk) {
  Point q{};
  double volume = 1;
  for (size_t i = 0; i < static_cast<size_t>(dimension); ++i) {
    const auto cell = static_cast<size_t>(ijk[i] / per_cell[i]);
    const double low = grid.coordinates[i][cell];
    const double interval = (grid.coordinates[i][cell + 1] - low) / per_cell[i];
    volume *= interval;
    q[i] = low + (static_cast<double>(ijk[i] % per_cell[i]) + 0.5) * interval;
  }
  if (grid.polar) volume *= q[0];
  return {place(grid, q), volume};
}

}  // namespace vsb::app
