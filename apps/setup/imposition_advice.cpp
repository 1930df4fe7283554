// SPDX-License-Identifier: BSD-3-Clause
#include "setup/imposition_advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "setup/loaded_pieces.hpp"
#include "setup/loads.hpp"

namespace vsb::app {

namespace {

/// Of the stress in the last cells, and of a cell: what is less need not be told.
constexpr double small_error = 0.05;

Point between(const Point& a, const Point& b, double t) {
  return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
}

/// A face between a cell with particles and one without: its corners, and those of the face opposite to it.
struct OuterFace {
  std::vector<Point> corners, opposite;
};

template <class Visit>
void for_each_outer_face(const Scene& scene, const OccupiedCells& grid, const Visit& visit) {
  const auto d = static_cast<size_t>(scene.dimension);
  const auto& n = grid.cells;
  const auto is_occupied = [&](const std::array<int, 3>& c) {
    for (size_t i = 0; i < d; ++i)
      if (c[i] < 0 || c[i] >= n[i]) return false;
    return static_cast<bool>(grid.occupied[static_cast<size_t>((c[2] * n[1] + c[1]) * n[0] + c[0])]);
  };
  std::array<int, 3> cell{};
  for (cell[2] = 0; cell[2] < n[2]; ++cell[2])
    for (cell[1] = 0; cell[1] < n[1]; ++cell[1])
      for (cell[0] = 0; cell[0] < n[0]; ++cell[0]) {
        if (!is_occupied(cell)) continue;
        for (size_t axis = 0; axis < d; ++axis)
          for (const int side : {0, 1}) {
            auto neighbour = cell;
            neighbour[axis] += side == 0 ? -1 : 1;
            if (is_occupied(neighbour)) continue;
            OuterFace face;
            for (size_t corner = 0; corner < size_t(1) << d; ++corner) {
              auto ijk = cell;
              for (size_t i = 0; i < d; ++i) ijk[i] += static_cast<int>(corner >> i & 1);
              const bool outer = static_cast<int>(corner >> axis & 1) == side;
              (outer ? face.corners : face.opposite)
                  .push_back(node_position(scene.grid, scene.dimension, ijk));
            }
            visit(face);
          }
      }
}

/// The point of a face at shares of its edges, which its corners follow in binary order.
Point point_of(std::vector<Point> corners, std::array<double, 2> at) {
  for (const double t : at) {
    if (corners.size() == 1) break;
    for (size_t c = 0; 2 * c < corners.size(); ++c)
      corners[c] = between(corners[2 * c], corners[2 * c + 1], t);
    corners.resize(corners.size() / 2);
  }
  return corners.front();
}

/// By which share of its cell a face lies outside the body, along a line into the cell; nothing where the
/// line misses the body.
std::optional<double> gap_along(const Region& body, const Point& outer, const Point& inner) {
  constexpr double touching = 1e-6;
  constexpr int samples = 16;
  double outside = 0;
  for (int k = 0; k <= samples; ++k) {
    double inside = std::max(touching, static_cast<double>(k) / samples);
    if (!body(between(outer, inner, inside))) {
      outside = inside;
      continue;
    }
    if (k == 0) return 0.0;
    for (int halving = 0; halving < 20; ++halving) {
      const double middle = 0.5 * (outside + inside);
      (body(between(outer, inner, middle)) ? inside : outside) = middle;
    }
    return inside;
  }
  return {};
}

/// The mean over the lines that meet the body.
double gap_to(const Region& body, const OuterFace& face) {
  constexpr int lines = 4;
  double sum = 0;
  int count = 0;
  for (int u = 0; u < (face.corners.size() > 1 ? lines : 1); ++u)
    for (int v = 0; v < (face.corners.size() > 2 ? lines : 1); ++v) {
      const std::array<double, 2> at = {(u + 0.5) / lines, (v + 0.5) / lines};
      const auto gap = gap_along(body, point_of(face.corners, at), point_of(face.opposite, at));
      if (!gap) continue;
      sum += *gap;
      ++count;
    }
  return count == 0 ? 1 : sum / count;
}

std::string nodal_text(const TractionSpec& traction, double gap) {
  return fmt::format(
      "traction '{}' has imposition = \"nodal\", which takes lines of the grid for the surface, and the "
      "surface lies up to {:.2g} of a cell within them: stresses in the last cells come out {} the load, at "
      "corners and edges more, some with the wrong sign; let the surface lie on a line of the grid, or take "
      "imposition = \"virtual_stress\", which needs none",
      traction.name, gap,
      gap < 0.9 ? fmt::format("about {:.2g} times as large as", 1 / (1 - gap)) : "many times as large as");
}

/// The lines of the grid around a coordinate of a logical axis.
std::pair<double, double> lines_around(const GridSpec& grid, size_t axis, double q) {
  if (grid.mapped()) {
    const auto& lines = grid.coordinates[axis];
    const auto above = std::upper_bound(lines.begin() + 1, lines.end() - 1, q);
    return {*(above - 1), *above};
  }
  const double h = grid.spacing[axis], below = grid.lower[axis] + std::floor((q - grid.lower[axis]) / h) * h;
  return {below, below + h};
}

/// Where a loaded particle is, in cells along the grid's axis that points most out of the body.
struct Depth {
  double below_surface;  ///< d
  double reach;          ///< f, of the body in its last cell
};
Depth depth_of(const Scene& scene, const LoadedPiece& loaded, const Point& particle) {
  const auto d = static_cast<size_t>(scene.dimension);
  const auto& x = loaded.piece.position;
  const auto& area = loaded.piece.area;
  const double norm = std::hypot(area[0], area[1], area[2]),
               step = 1e-3 * shortest_edge(scene.grid, scene.dimension) / norm;
  const Point inside = {x[0] - step * area[0], x[1] - step * area[1], x[2] - step * area[2]};
  const Point q = logical_coordinates(scene.grid, x), q_inside = logical_coordinates(scene.grid, inside),
              q_particle = logical_coordinates(scene.grid, particle);
  size_t axis = 0;
  double most = 0;
  std::array<std::pair<double, double>, 3> lines;
  for (size_t i = 0; i < d; ++i) {
    lines[i] = lines_around(scene.grid, i, q_inside[i]);
    const double change = std::abs(q[i] - q_inside[i]) / (lines[i].second - lines[i].first);
    if (change > most) axis = i;
    most = std::max(most, change);
  }
  const auto [low, high] = lines[axis];
  const bool upwards = q[axis] > q_inside[axis];
  const double h = high - low, reach = (upwards ? q[axis] - low : high - q[axis]) / h;
  return {(upwards ? q[axis] - q_particle[axis] : q_particle[axis] - q[axis]) / h, std::min(reach, 1.0)};
}

/// Means over the surface of a traction.
struct Shortfall {
  double depth = 0;  ///< of the loaded particles, in cells
  double share = 0;  ///< of the stress that is missing in the last cells
};
Shortfall shortfall_of(const Scene& scene, size_t k, const PlacedParticles& placed) {
  Shortfall mean;
  double sum = 0;
  for (const auto& loaded : loaded_pieces(scene, k, placed)) {
    const auto& area = loaded.piece.area;
    const double weight = std::hypot(area[0], area[1], area[2]);
    const auto [depth, reach] =
        depth_of(scene, loaded, placed.position[static_cast<size_t>(loaded.particle)]);
    // A particle that lies in the cell before leaves the last one without any: that one ends at its own face.
    const double missing = depth < reach ? depth / reach : depth - reach;
    mean.depth += weight * depth;
    mean.share += weight * std::clamp(missing, 0.0, 1.0);
    sum += weight;
  }
  if (sum > 0) {
    mean.depth /= sum;
    mean.share /= sum;
  }
  return mean;
}

std::string material_points_text(const TractionSpec& traction, const Shortfall& mean) {
  return fmt::format(
      "traction '{}' has imposition = \"material_points\", which loads the outermost particles as if they "
      "lay "
      "on the surface; they lie {:.2g} of a cell below it, so that stresses in the last cells come out about "
      "{:.2g} % smaller than the load; more particles per cell make it less, imposition = \"virtual_stress\" "
      "has no such error",
      traction.name, mean.depth, 100 * mean.share);
}

}  // namespace

std::vector<std::string> imposition_advice(const Scene& scene, const PlacedParticles& placed,
                                           const OccupiedCells& grid) {
  std::vector<std::string> advice;
  if (const TractionMask nodal = imposed_by(scene, Imposition::nodal); nodal != 0) {
    const Region bodies = union_of_bodies(scene);
    std::vector<double> gap(scene.tractions.size());
    for_each_outer_face(scene, grid, [&](const OuterFace& face) {
      TractionMask common = nodal;
      for (const auto& corner : face.corners) common &= tractions_at(scene, common, corner);
      if (common == 0) return;
      const double of_face = gap_to(bodies, face);
      for (size_t k = 0; k < gap.size(); ++k)
        if (common >> k & 1u) gap[k] = std::max(gap[k], of_face);
    });
    for (size_t k = 0; k < gap.size(); ++k)
      if (gap[k] > small_error) advice.push_back(nodal_text(scene.tractions[k], gap[k]));
  }
  for (size_t k = 0; k < scene.tractions.size(); ++k) {
    if (scene.tractions[k].imposition != Imposition::material_points) continue;
    if (const auto mean = shortfall_of(scene, k, placed); mean.share > small_error)
      advice.push_back(material_points_text(scene.tractions[k], mean));
  }
  return advice;
}

}  // namespace vsb::app
