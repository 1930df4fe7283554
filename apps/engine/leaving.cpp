// SPDX-License-Identifier: BSD-3-Clause
#include "engine/leaving.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vsb::app {

namespace {

/// Of the wave speed, and of the modulus; see looks_unstable. The smaller of both shares, its largest value
/// among the particles when the first one left, was in an elastic block in 2D, linear functions:
///   let go from a pressure of 0.05, 0.1, 0.2, 0.3 and 0.5 of the modulus, drifting at 0.02 to 1 wave speeds:
///   up to 0.07, 0.14, 0.32, 0.49 and 0.45; in steps of 1.4, 1.5, 1.6, 1.8 and 2 times the critical one
///   (exponential volume update, in which no volume turns negative first): 0.58, 1.1, 5.6, 6.9 and 80; in
///   column-large-strain, which throws particles out: 2.8.
constexpr double unstable_share = 0.5;

/// How far q lies beyond the faces across an axis, m or rad; negative inside.
double beyond(const GridSpec& grid, size_t axis, double q, size_t side) {
  const auto [low, high] = extent(grid, axis);
  return side == 0 ? low - q : q - high;
}

}  // namespace

std::string face_name(const Scene& scene, const GridFace& face) {
  return scene.grid.axis_name(face.axis) + (face.side == 0 ? "_min" : "_max");
}

std::vector<GridFace> faces_passed(const Scene& scene, const Point& x) {
  const Point q = logical_coordinates(scene.grid, x);
  std::vector<GridFace> passed;
  GridFace nearest{0, 0};  // a position between an arc and its chords lies beyond no face of the polar grid
  double most = -std::numeric_limits<double>::infinity();
  for (size_t axis = 0; axis < static_cast<size_t>(scene.dimension); ++axis)
    for (size_t side = 0; side < 2; ++side) {
      const auto [low, high] = extent(scene.grid, axis);
      const double out = beyond(scene.grid, axis, q[axis], side) / (high - low);
      if (out > 0) passed.push_back({axis, side});
      if (out <= most) continue;
      most = out;
      nearest = {axis, side};
    }
  if (passed.empty()) passed.push_back(nearest);
  return passed;
}

Point nearest_inside(const Scene& scene, const Point& x) {
  const auto& grid = scene.grid;
  const auto d = static_cast<size_t>(scene.dimension);
  Point q = logical_coordinates(grid, x);
  std::array<int, 3> cell{};
  for (size_t i = 0; i < d; ++i) {
    const auto [low, high] = extent(grid, i);
    q[i] = std::clamp(q[i], low, high);
    if (!grid.mapped()) continue;
    const auto& nodes = grid.coordinates[i];
    const auto above = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, q[i]);
    cell[i] = static_cast<int>(above - nodes.begin()) - 1;
  }
  if (!grid.mapped()) return q;
  Point middle{};  // of the cell: its edges are straight, those of the coordinates need not be
  const int corners = 1 << scene.dimension;
  for (int c = 0; c < corners; ++c) {
    auto node = cell;
    for (size_t i = 0; i < d; ++i) node[i] += c >> i & 1;
    const Point corner = node_position(grid, scene.dimension, node);
    for (size_t i = 0; i < 3; ++i) middle[i] += corner[i] / corners;
  }
  return middle;
}

bool looks_unstable(double speed, double wave_speed, double stress, double modulus) {
  return speed > unstable_share * wave_speed && stress > unstable_share * modulus;
}

void OutflowReport::add(long long step, const GridFace& face) {
  ++particles;
  ++by_face[face.axis][face.side];
  if (first_step < 0) first_step = step;
  last_step = step;
}

std::vector<std::int64_t> OutflowReport::numbers() const {
  std::vector<std::int64_t> n{particles, first_step, last_step};
  for (const auto& sides : by_face) n.insert(n.end(), sides.begin(), sides.end());
  return n;
}

OutflowReport OutflowReport::from_numbers(const std::vector<std::int64_t>& n) {
  OutflowReport outflow;
  if (n.size() != outflow.numbers().size()) return outflow;
  outflow.particles = n[0];
  outflow.first_step = n[1];
  outflow.last_step = n[2];
  for (size_t face = 0; face < 6; ++face) outflow.by_face[face / 2][face % 2] = n[3 + face];
  return outflow;
}

std::string outflow_text(const Scene& scene, const OutflowReport& outflow) {
  if (outflow.particles == 0) return "no particle";
  std::string faces;
  for (size_t face = 0; face < 6; ++face)
    if (const auto n = outflow.by_face[face / 2][face % 2]; n > 0)
      faces +=
          fmt::format("{} {} at {}", faces.empty() ? ":" : ",", n, face_name(scene, {face / 2, face % 2}));
  return fmt::format("{} particle{}, {:.6g} kg, steps {} to {}{}", outflow.particles,
                     outflow.particles == 1 ? "" : "s", outflow.mass_gone, outflow.first_step,
                     outflow.last_step, faces);
}

}  // namespace vsb::app
