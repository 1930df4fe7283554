// SPDX-License-Identifier: BSD-3-Clause
#include "run/body_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vsb::app {

namespace {

Point operator+(const Point& a, const Point& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Point operator-(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Point operator*(double s, const Point& a) {
  return {s * a[0], s * a[1], s * a[2]};
}
double dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Where the boundary crosses the edge from a point inside to one outside. The same edge gives the same point
/// in every simplex it belongs to.
Point crossing(const Region& region, Point inside, Point outside) {
  for (int i = 0; i < 60; ++i) {
    const Point middle = 0.5 * (inside + outside);
    (region(middle) ? inside : outside) = middle;
  }
  return 0.5 * (inside + outside);
}

Point mean(const std::vector<Point>& points) {
  Point sum{};
  for (const Point& p : points) sum = sum + p;
  return (1.0 / static_cast<double>(points.size())) * sum;
}

/// Adds a piece, its area turned from the inside to the outside.
void add_piece(const Point& position, Point area, const Point& outwards, std::vector<SurfacePiece>& pieces) {
  if (dot(area, area) == 0) return;
  if (dot(area, outwards) < 0) area = -1.0 * area;
  pieces.push_back({position, area});
}

void add_triangle(const Point& a, const Point& b, const Point& c, const Point& outwards,
                  std::vector<SurfacePiece>& pieces) {
  // Three points for a third of the area each: exact for quadratic functions.
  const Point middle = (1.0 / 3.0) * (a + b + c), area = (1.0 / 6.0) * cross(b - a, c - a);
  for (const Point& corner : {a, b, c}) add_piece(0.5 * (middle + corner), area, outwards, pieces);
}

/// The pieces within one simplex of `inside` and `outside` corners (neither empty).
void cut_simplex(const Region& region, const std::vector<Point>& inside, const std::vector<Point>& outside,
                 std::vector<SurfacePiece>& pieces) {
  const Point outwards = mean(outside) - mean(inside);
  std::vector<Point> x;
  for (const Point& a : inside)
    for (const Point& b : outside) x.push_back(crossing(region, a, b));
  if (x.size() == 1) {  // 1D
    add_piece(x[0], {outwards[0] > 0 ? 1.0 : -1.0, 0, 0}, outwards, pieces);
  } else if (x.size() == 2) {  // a line through a triangle
    const Point along = x[1] - x[0];
    add_piece(0.5 * (x[0] + x[1]), {along[1], -along[0], 0}, outwards, pieces);
  } else if (x.size() == 3) {  // a corner of a tetrahedron
    add_triangle(x[0], x[1], x[2], outwards, pieces);
  } else {  // two corners against two; x[0] and x[3] lie on opposite edges
    add_triangle(x[0], x[1], x[3], outwards, pieces);
    add_triangle(x[0], x[3], x[2], outwards, pieces);
  }
}

}  // namespace

std::vector<SurfacePiece> surface_pieces(const Region& region, const SurfaceBox& box) {
  const auto d = static_cast<size_t>(box.dimension);
  std::array<size_t, 3> points{1, 1, 1};
  for (size_t i = 0; i < d; ++i) points[i] = static_cast<size_t>(box.intervals[i]) + 1;
  const auto place = [&](const std::array<size_t, 3>& ijk) {
    Point x{};
    for (size_t i = 0; i < d; ++i) x[i] = box.lower[i] + static_cast<double>(ijk[i]) * box.interval[i];
    return x;
  };
  const auto index = [&](const std::array<size_t, 3>& ijk) {
    return (ijk[2] * points[1] + ijk[1]) * points[0] + ijk[0];
  };
  std::vector<char> is_inside(points[0] * points[1] * points[2]);
  std::array<size_t, 3> at{};
  for (at[2] = 0; at[2] < points[2]; ++at[2])
    for (at[1] = 0; at[1] < points[1]; ++at[1])
      for (at[0] = 0; at[0] < points[0]; ++at[0]) is_inside[index(at)] = region(place(at)) ? 1 : 0;

  // Kuhn's triangulation: one simplex for each order of the axes; neighbouring intervals fit together.
  std::vector<SurfacePiece> pieces;
  std::array<size_t, 3> last{1, 1, 1};
  for (size_t i = 0; i < d; ++i) last[i] = points[i] - 1;
  for (at[2] = 0; at[2] < last[2]; ++at[2])
    for (at[1] = 0; at[1] < last[1]; ++at[1])
      for (at[0] = 0; at[0] < last[0]; ++at[0]) {
        bool mixed = false;
        for (size_t corner = 1; corner < size_t(1) << d; ++corner) {
          auto c = at;
          for (size_t i = 0; i < d; ++i) c[i] += corner >> i & 1;
          mixed = mixed || is_inside[index(c)] != is_inside[index(at)];
        }
        if (!mixed) continue;
        std::vector<size_t> order(d);
        std::iota(order.begin(), order.end(), size_t(0));
        do {
          std::vector<Point> inside, outside;
          auto c = at;
          for (size_t k = 0; k <= d; ++k) {
            if (k > 0) ++c[order[k - 1]];
            (is_inside[index(c)] ? inside : outside).push_back(place(c));
          }
          if (!inside.empty() && !outside.empty()) cut_simplex(region, inside, outside, pieces);
        } while (std::next_permutation(order.begin(), order.end()));
      }
  return pieces;
}

SurfaceBox surface_box(const Scene& scene, int per_cell) {
  const auto around = bounding_box(scene.grid, scene.dimension);
  const double shortest = shortest_edge(scene.grid, scene.dimension);
  SurfaceBox box{scene.dimension, {}, {}, {}};
  for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i) {
    box.lower[i] = around.lower[i];
    const double length = around.upper[i] - around.lower[i];
    const double h = scene.grid.mapped() ? shortest : scene.grid.spacing[i];
    box.intervals[i] = std::max(1, static_cast<int>(std::lround(length / h * per_cell)));
    box.interval[i] = length / box.intervals[i];
  }
  return box;
}

Region union_of_bodies(const Scene& scene) {
  std::vector<Region> regions;
  for (const auto& body : scene.bodies) regions.push_back(body.region);
  return union_of(std::move(regions));
}

}  // namespace vsb::app
