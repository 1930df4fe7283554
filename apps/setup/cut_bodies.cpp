// SPDX-License-Identifier: BSD-3-Clause
#include "setup/cut_bodies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "scene/units.hpp"
#include "setup/cut_lattice.hpp"
#include "setup/lattice_points.hpp"
#include "setup/local_origin.hpp"
#include "setup/setup_error.hpp"

namespace vsb::app {

namespace {

struct Face {
  size_t axis, side;  ///< side 0: lower, 1: upper
};

/// The scene on a grid with one more cell at every open face.
Scene with_a_cell_beyond(Scene scene) {
  auto& grid = scene.grid;
  for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i) {
    const bool below = scene.faces.fixed[i][0] == 0, above = scene.faces.fixed[i][1] == 0;
    if (!grid.mapped()) {
      if (below) grid.lower[i] -= grid.spacing[i];
      grid.cells[i] += int(below) + int(above);
      continue;
    }
    auto& nodes = grid.coordinates[i];
    const double first = nodes[0] - (nodes[1] - nodes[0]), last = 2 * nodes.back() - nodes[nodes.size() - 2];
    const bool radial = grid.polar && i == 0, around = grid.polar && i == 1;
    const bool meets_itself = around && last - first > 2 * pi;
    if (above && !meets_itself) nodes.push_back(last);
    if (below && !meets_itself && !(radial && first <= 0)) nodes.insert(nodes.begin(), first);
    if (!grid.polar) grid.lower[i] = nodes.front();
    grid.cells[i] = static_cast<int>(nodes.size()) - 1;
  }
  return scene;
}

/// The face beyond which coordinates q along the logical axes lie; none inside the grid and beyond an edge of
/// it.
std::optional<Face> face_passed(const Scene& scene, const Point& q) {
  std::optional<Face> passed;
  for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i) {
    const auto [low, high] = extent(scene.grid, i);
    const double round_off = 1e-9 * (high - low);
    if (q[i] >= low - round_off && q[i] <= high + round_off) continue;
    if (passed) return {};
    passed = Face{i, q[i] > high ? size_t(1) : size_t(0)};
  }
  return passed;
}

/// Whether the body goes on, far beyond the face.
bool endless(const Scene& scene, const BodySpec& body, Point q, const Face& face) {
  if (scene.grid.polar && face.axis == 1) return false;
  const auto [low, high] = extent(scene.grid, face.axis);
  const double far = 1e6 * (high - low);
  if (scene.grid.polar && face.axis == 0 && face.side == 0) return false;
  q[face.axis] += face.side == 0 ? -far : far;
  return body.region(position_of(scene.grid, q));
}

[[noreturn]] void throw_cut_off(const Scene& scene, const BodySpec& body, const Face& face, const Point& x) {
  throw SetupError(
      body.where,
      fmt::format(
          "body '{}' reaches out of the grid at the open face {}_{}, to {}, and would "
          "be cut off "
          "there: make the grid larger or the body smaller, or, for a symmetry plane or a support, give the "
          "face a condition",
          body.name, scene.grid.axis_name(face.axis), face.side == 0 ? "min" : "max",
          position_text(scene, x)));
}

/// Whether the body's bounds lie within every open face of the grid.
bool ends_in_grid(const Scene& scene, const BodySpec& body) {
  if (scene.grid.polar) return false;  // its faces are not those of its bounding box
  const AxisBox bounds = body.region.bounds(), grid = bounding_box(scene.grid, scene.dimension);
  for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i)
    if ((scene.faces.fixed[i][0] == 0 && bounds.lower[i] < grid.lower[i]) ||
        (scene.faces.fixed[i][1] == 0 && bounds.upper[i] > grid.upper[i]))
      return false;
  return true;
}

/// Of a cut lattice every share beyond an open face counts, also that of a box with its centre in the grid.
void refuse_shares_beyond(const Scene& scene, const BodySpec& body) {
  const AxisBox box = bounding_box(scene.grid, scene.dimension);
  for (size_t axis = 0; axis < static_cast<size_t>(scene.dimension); ++axis)
    for (size_t side = 0; side < 2; ++side) {
      if (scene.faces.fixed[axis][side] != 0) continue;
      AxisBox beyond = box;
      const double h = scene.grid.spacing[axis];
      if (side == 0) {
        beyond.lower[axis] = box.lower[axis] - h;
        beyond.upper[axis] = box.lower[axis];
      } else {
        beyond.lower[axis] = box.upper[axis];
        beyond.upper[axis] = box.upper[axis] + h;
      }
      const Face face{axis, side};
      for_each_lattice_share(scene, body, beyond, [&](const LatticeShare& share) {
        if (!endless(scene, body, share.position, face)) throw_cut_off(scene, body, face, share.position);
      });
    }
}

}  // namespace

void refuse_cut_bodies(const Scene& scene) {
  std::optional<Scene> larger;
  for (const auto& body : scene.bodies) {
    if (ends_in_grid(scene, body)) continue;
    if (body.boundary != BoundaryBoxes::keep) {
      refuse_shares_beyond(scene, body);
      continue;
    }
    if (!larger) larger = with_a_cell_beyond(scene);
    for_each_lattice_point(*larger, body, [&](const LatticePoint& point) {
      const Point q = logical_coordinates(scene.grid, point.x);
      const auto face = face_passed(scene, q);
      if (!face || scene.faces.fixed[face->axis][face->side] != 0 || !body.region(point.x) ||
          endless(scene, body, q, *face))
        return;
      throw_cut_off(scene, body, *face, point.x);
    });
  }
}

}  // namespace vsb::app
