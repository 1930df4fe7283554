// SPDX-License-Identifier: BSD-3-Clause
#include "setup/face_cover.hpp"

#include <cmath>

namespace vsb::app {

namespace {

/// Of a position from a face, in units of the edge of a box that stands on it, or in the row above.
constexpr double round_off = 2e-3;

/// The position of x along an axis, m, and those of the faces; around a polar grid, of the arc through x.
struct Along {
  double x, low, high;
};
Along along(const GridSpec& grid, size_t axis, const Point& x) {
  const Point q = logical_coordinates(grid, x);
  const auto [low, high] = extent(grid, axis);
  const double metre = grid.polar && axis == 1 ? q[0] : 1.0;
  return {metre * q[axis], metre * low, metre * high};
}

}  // namespace

void add_covers(const Scene& scene, const BodySpec& body, const LatticeParticle& p, int number,
                std::vector<PlacedCover>& covers) {
  const auto& grid = scene.grid;
  for (size_t axis = 0; axis < static_cast<size_t>(scene.dimension); ++axis) {
    if (grid.polar && axis == 0) continue;  // arcs, of which the grid has the chords
    const double H = p.edges[axis];
    const Along box = along(grid, axis, p.middle);
    const bool lower = box.x - box.low < box.high - box.x;
    const double rows = (lower ? box.x - box.low : box.high - box.x) / H - 0.5;  // of boxes between
    if (!(rows < 2 + round_off) || std::abs(rows - std::round(rows)) > round_off) continue;
    const Along at = along(grid, axis, p.position);
    double d = lower ? at.x - at.low : at.high - at.x;
    if (grid.polar && axis == 1) {
      const double r = std::hypot(p.position[0] - grid.center[0], p.position[1] - grid.center[1]);
      d = r * std::sin(d / r);
    }
    const bool stands = rows < 0.5, seems_to = std::pow(d, scene.dimension) < p.volume;
    const double cover =
        stands ? std::max(0.0, (4 * H - 6 * d) * 2 * d / (H * H)) / cell_filling(scene, body) : 0.0;
    if (grid.mapped() || stands != seems_to || (stands && std::abs(cover - 1) > 1e-6))
      covers.push_back({number, axis, cover});
  }
}

double cell_filling(const Scene& scene, const BodySpec& body) {
  const auto& grid = scene.grid;
  if (!grid.polar || !std::holds_alternative<CellLattice>(body.lattice)) return 1;
  const auto [first, last] = extent(grid, 1);
  const double angle = (last - first) / grid.cells[1];
  return std::sin(angle) / angle;
}

}  // namespace vsb::app
