// SPDX-License-Identifier: BSD-3-Clause
#include "setup/body_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

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

/// A sampling interval by its number in each direction.
using Interval = std::array<size_t, 3>;

/// Intervals first, ..., last - 1 in each direction.
struct IntervalBlock {
  Interval first, last;
};

/// The intervals that the surface may cross, along x first: blocks of them are halved until they lie in the
/// region as a whole, not at all, or are one interval. The work follows the surface, not the grid.
template <class Position>
std::vector<Interval> crossed_intervals(const Region& region, const SurfaceBox& box,
                                        const Position& position) {
  const auto d = static_cast<size_t>(box.dimension);
  IntervalBlock all{{0, 0, 0}, {1, 1, 1}};
  for (size_t i = 0; i < d; ++i) all.last[i] = static_cast<size_t>(box.intervals[i]);
  std::vector<Interval> crossed;
  std::vector<std::pair<IntervalBlock, Region>> blocks{{all, region}};
  while (!blocks.empty()) {
    const auto [block, parts] = std::move(blocks.back());
    blocks.pop_back();
    AxisBox around{position(block.first), position(block.last)};
    for (size_t i = 0; i < d; ++i) {  // the surface may lie in the face of an interval
      around.lower[i] -= 1e-3 * box.interval[i];
      around.upper[i] += 1e-3 * box.interval[i];
    }
    Region within = parts.within(around);
    if (within.is_empty() || within.is_everywhere()) continue;
    size_t longest = 0;
    const auto length = [&, &at = block](size_t i) { return at.last[i] - at.first[i]; };
    for (size_t i = 1; i < d; ++i)
      if (length(i) > length(longest)) longest = i;
    if (length(longest) == 1) {
      crossed.push_back(block.first);
      continue;
    }
    auto lower = block, upper = block;
    lower.last[longest] = upper.first[longest] = block.first[longest] + length(longest) / 2;
    blocks.emplace_back(upper, within);
    blocks.emplace_back(lower, std::move(within));
  }
  std::sort(crossed.begin(), crossed.end(), [](const Interval& a, const Interval& b) {
    return std::lexicographical_compare(a.rbegin(), a.rend(), b.rbegin(), b.rend());
  });
  return crossed;
}

}  // namespace

std::vector<SurfacePiece> surface_pieces(const Region& region, const SurfaceBox& box) {
  const auto d = static_cast<size_t>(box.dimension);
  const auto position = [&](const Interval& ijk) {
    Point x{};
    for (size_t i = 0; i < d; ++i) x[i] = box.lower[i] + static_cast<double>(ijk[i]) * box.interval[i];
    return x;
  };
  // Kuhn's triangulation: one simplex for each order of the axes; neighbouring intervals fit together.
  std::vector<SurfacePiece> pieces;
  for (const Interval& at : crossed_intervals(region, box, position)) {
    bool is_inside[8];  // [corner]: bit i: upper in direction i
    bool mixed = false;
    for (size_t corner = 0; corner < size_t(1) << d; ++corner) {
      auto c = at;
      for (size_t i = 0; i < d; ++i) c[i] += corner >> i & 1;
      is_inside[corner] = region(position(c));
      mixed = mixed || is_inside[corner] != is_inside[0];
    }
    if (!mixed) continue;
    std::vector<size_t> order(d);
    std::iota(order.begin(), order.end(), size_t(0));
    do {
      std::vector<Point> inside, outside;
      auto c = at;
      size_t corner = 0;
      for (size_t k = 0; k <= d; ++k) {
        if (k > 0) {
          ++c[order[k - 1]];
          corner |= size_t(1) << order[k - 1];
        }
        (is_inside[corner] ? inside : outside).push_back(position(c));
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
