// SPDX-License-Identifier: BSD-3-Clause
#include "setup/field_advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "setup/imposition_advice.hpp"
#include "setup/loads.hpp"
#include "setup/open_faces.hpp"

namespace vsb::app {

namespace {

template <int Dim>
Vector<Dim, double> vector(const Point& p) {
  Vector<Dim, double> v;
  for (size_t i = 0; i < Dim; ++i) v[static_cast<int>(i)] = p[i];
  return v;
}

/// Whether the particle and its neighbours at distance w along the axes lie in the body: elsewhere the change
/// across the particle reaches beyond the surface.
template <int Dim>
bool is_inside(const Region& body, Point x, double w) {
  for (size_t i = 0; i < Dim; ++i)
    for (const double step : {-w, w}) {
      Point neighbour = x;
      neighbour[i] += step;
      if (!body(neighbour)) return false;
    }
  return true;
}

template <int Dim>
SpuriousTraction largest_spurious(const Scene& scene, const PlacedParticles& placed) {
  SpuriousTraction worst;
  const TractionMask on_nodes = imposed_by(scene, Imposition::virtual_stress);
  for (size_t k = 0; k < scene.tractions.size(); ++k) {
    const auto& traction = scene.tractions[k];
    if (!(on_nodes >> k & 1u) || std::holds_alternative<Stress6>(traction.field)) continue;
    const auto field = stress_field<Dim, double>(scene, traction.field);
    for (size_t b = 0; b < scene.bodies.size(); ++b)
      for (int p = placed.bodies[b].first; p < placed.bodies[b].last; ++p) {
        const auto n = static_cast<size_t>(p);
        const double w = std::pow(placed.volume[n], 1.0 / Dim);
        if (!is_inside<Dim>(scene.bodies[b].region, placed.position[n], w)) continue;
        const auto x = vector<Dim>(placed.position[n]);
        const auto divergence = field.at(x).divergence;
        auto jump = (-w) * divergence;
        for (int j = 0; j < Dim; ++j) {
          auto lower = x, upper = x;
          lower[j] -= w / 2;
          upper[j] += w / 2;
          const auto change = field.at(upper).stress - field.at(lower).stress;
          for (int i = 0; i < Dim; ++i) jump[i] += change(i, j);
        }
        for (int i = 0; i < Dim; ++i)
          if (std::abs(jump[i]) > worst.size) worst = {std::abs(jump[i]), placed.position[n], traction.name};
      }
  }
  return worst;
}

}  // namespace

SpuriousTraction spurious_traction(const Scene& scene, const PlacedParticles& placed) {
  return scene.dimension == 1   ? largest_spurious<1>(scene, placed)
         : scene.dimension == 2 ? largest_spurious<2>(scene, placed)
                                : largest_spurious<3>(scene, placed);
}

ThinWall thin_wall(const Scene& scene, const OccupiedCells& grid) {
  ThinWall thinnest;
  TractionMask on_boundary = imposed_by(scene, Imposition::virtual_stress);
  for (size_t k = 0; k < scene.tractions.size(); ++k)
    if (scene.tractions[k].all_nodes) on_boundary &= ~(TractionMask(1) << k);
  if (on_boundary == 0) return thinnest;
  const auto& n = grid.cells;
  const auto is_occupied = [&](const std::array<int, 3>& c) {
    return static_cast<bool>(grid.occupied[static_cast<size_t>((c[2] * n[1] + c[1]) * n[0] + c[0])]);
  };
  // The tractions declared at the node of a cell, on one side of it along the axis.
  const auto declared = [&](std::array<int, 3> ijk, size_t axis, int side, Point& at) {
    ijk[axis] += side;
    at = node_position(scene.grid, scene.dimension, ijk);
    return tractions_at(scene, on_boundary, at);
  };
  for (size_t axis = 0; axis < static_cast<size_t>(scene.dimension); ++axis) {
    const size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::array<int, 3> c{};
    for (c[u] = 0; c[u] < n[u]; ++c[u])
      for (c[v] = 0; c[v] < n[v]; ++c[v]) {
        int begin = -1;  // of a run of occupied cells that follows a void one
        for (c[axis] = 1; c[axis] < n[axis]; ++c[axis]) {
          auto before = c;
          --before[axis];
          const bool was = is_occupied(before), is = is_occupied(c);
          if (!was && is) begin = c[axis];
          if (!was || is || begin < 0) continue;
          const int cells = c[axis] - begin;
          if (cells >= ThinWall::enough || (thinnest.cells > 0 && cells >= thinnest.cells)) continue;
          auto first = c;
          first[axis] = begin;
          Point lower, upper;
          if (declared(first, axis, 0, lower) == declared(before, axis, 1, upper)) continue;
          thinnest.cells = cells;
          for (size_t i = 0; i < 3; ++i) thinnest.position[i] = 0.5 * (lower[i] + upper[i]);
        }
      }
  }
  return thinnest;
}

std::vector<std::string> field_advice(const Scene& scene, const PlacedParticles& placed,
                                      const OccupiedCells& grid) {
  std::vector<std::string> advice = open_face_advice(scene, placed);
  for (auto& text : imposition_advice(scene, placed, grid)) advice.push_back(std::move(text));
  const auto box = bounding_box(scene.grid, scene.dimension);
  const auto spurious = spurious_traction(scene, placed);
  for (const auto& traction : scene.tractions) {
    const bool acts = std::any_of(placed.position.begin(), placed.position.end(), [&](const Point& x) {
      return full_stress(scene, traction, x) != Stress6{};
    });
    if (traction.all_nodes && !acts)
      advice.push_back(
          fmt::format("traction '{}' has no stress at any particle, so it loads nothing: check its field",
                      traction.name));
  }
  for (const auto& traction : scene.tractions) {
    if (traction.name != spurious.traction) continue;
    const double most = largest_stress(traction.field, box.lower, box.upper);
    if (spurious.size > 0.1 * most)
      advice.push_back(fmt::format(
          "traction '{}': its stress jumps inside the material by {:.3g} Pa at {}, which acts as a traction "
          "there: let it change over several particles, or move the change out of the material",
          traction.name, spurious.size, position_text(scene, spurious.position, 4)));
    break;
  }
  if (const auto wall = thin_wall(scene, grid); wall.cells > 0)
    advice.push_back(fmt::format(
        "the wall at {} is {} cell{} thick between faces with different tractions, whose boundary nodes meet "
        "inside it; about {} are needed: refine the grid, or use a blend (radial_blend, planar_blend) with "
        "nodes = \"all\"",
        position_text(scene, wall.position, 4), wall.cells, wall.cells == 1 ? "" : "s", ThinWall::enough));
  return advice;
}

}  // namespace vsb::app
