// SPDX-License-Identifier: BSD-3-Clause
#include "run/cut_through.hpp"

#include <array>
#include <cmath>

namespace vsb::app {

namespace {

using Cell = std::array<int, 3>;

/// The cells of a scene's grid in one dimension too many, those beyond the scene's of one cell.
struct Cells {
  Cell count{1, 1, 1};

  size_t index(const Cell& c) const {
    return static_cast<size_t>(c[0] + count[0] * (c[1] + count[1] * c[2]));
  }
  Cell cell(size_t index) const {
    const auto n = static_cast<int>(index);
    return {n % count[0], n / count[0] % count[1], n / (count[0] * count[1])};
  }
};

}  // namespace

bool hole_meets_outside(const Scene& scene, const HoleSpec& hole, const std::vector<CellContent>& contents) {
  const auto d = static_cast<size_t>(scene.dimension);
  Cells cells;
  for (size_t i = 0; i < d; ++i) cells.count[i] = scene.grid.cells[i];
  const size_t along = hole.axis < 0 ? 2 : static_cast<size_t>(hole.axis);
  std::vector<bool> seen(contents.size(), false);
  std::vector<size_t> open;
  const auto visit = [&](const Cell& c) {
    const size_t index = cells.index(c);
    if (seen[index] || contents[index] == CellContent::particles) return;
    seen[index] = true;
    open.push_back(index);
  };
  // The cells around the axis, on both sides of it where it lies on nodes or on a plane of symmetry.
  for (size_t index = 0; index < contents.size(); ++index) {
    const Cell c = cells.cell(index);
    bool touches = true;
    for (size_t i = 0; i < d; ++i) {
      if (i == along) continue;
      const double middle = scene.grid.lower[i] + (c[i] + 0.5) * scene.grid.spacing[i];
      touches = touches && std::abs(middle - hole.center[i]) < 0.51 * scene.grid.spacing[i];
    }
    if (touches && contents[index] == CellContent::nothing) visit(c);
  }
  while (!open.empty()) {
    const Cell c = cells.cell(open.back());
    open.pop_back();
    for (size_t i = 0; i < d; ++i)
      for (const int side : {0, 1}) {
        Cell next = c;
        next[i] += side == 0 ? -1 : 1;
        if (next[i] >= 0 && next[i] < cells.count[i])
          visit(next);
        else if (scene.faces.fixed[i][static_cast<size_t>(side)] == 0)
          return true;
      }
  }
  return false;
}

}  // namespace vsb::app
