// SPDX-License-Identifier: BSD-3-Clause
#include "run/shape_volume.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "run/box_share.hpp"
#include "scene/units.hpp"

namespace vsb::app {

namespace {

constexpr double shortest_interval = 1e-6;  ///< of a line, in shares of the box that it crosses
constexpr double unresolved = 1e-9;  ///< of the volume: boxes smaller than this together are not halved
constexpr double agreement = 3e-4;   ///< of the volume: between estimates with fewer and with more boxes
constexpr size_t boxes_in_plane = 1024, boxes_in_space = 8192, fewest_boxes = 256;

double length(const AxisBox& box, size_t axis) {
  return box.upper[axis] - box.lower[axis];
}

/// What a line through a box has in common with a region.
struct Chord {
  double length = 0;  ///< m
  int crossings = 0;
};

/// Adds the part of a chord in an interval of the line. `before`: whether the line was inside when it came to
/// the interval.
void add_interval(const Region& region, const AxisBox& line, size_t axis, double shortest, bool& before,
                  Chord& chord) {
  const Overlap overlap = region.overlap(line);
  const double all = length(line, axis);
  if (overlap == Overlap::some && all > shortest) {
    const double middle = 0.5 * (line.lower[axis] + line.upper[axis]);
    AxisBox half = line;
    half.upper[axis] = middle;
    add_interval(region, half, axis, shortest, before, chord);
    half = line;
    half.lower[axis] = middle;
    add_interval(region, half, axis, shortest, before, chord);
    return;
  }
  if (overlap == Overlap::some) {  // the crossing itself
    chord.length += 0.5 * all;
    return;
  }
  const bool inside = overlap == Overlap::all;
  if (inside != before) ++chord.crossings;
  before = inside;
  if (inside) chord.length += all;
}

/// The lines along an axis through a box: the mean of their chords, and the crossings of all.
Chord mean_chord(const Region& region, const AxisBox& box, size_t axis, size_t d) {
  const double gauss[] = {0.5 - 0.5 / std::sqrt(3.0), 0.5 + 0.5 / std::sqrt(3.0)};
  const size_t lines = size_t(1) << (d - 1);
  Chord sum;
  for (size_t n = 0; n < lines; ++n) {
    AxisBox line = box;
    for (size_t k = 1; k < d; ++k) {
      const size_t across = (axis + k) % d;
      line.lower[across] = line.upper[across] =
          box.lower[across] + gauss[n >> (k - 1) & 1] * length(box, across);
    }
    AxisBox begin = line;
    begin.upper[axis] = line.lower[axis] + shortest_interval * length(line, axis);
    bool inside = region.overlap(begin) == Overlap::all;
    add_interval(region, line, axis, shortest_interval * length(line, axis), inside, sum);
  }
  sum.length /= static_cast<double>(lines);
  return sum;
}

/// The volume that a region has in a box, by lines.
double volume_by_lines(const Region& region, const AxisBox& box, int dimension) {
  const auto d = static_cast<size_t>(dimension);
  double share = 0;
  int most = -1;
  for (size_t axis = 0; axis < d; ++axis) {
    const Chord chord = mean_chord(region, box, axis, d);
    if (chord.crossings <= most) continue;
    most = chord.crossings;
    share = chord.length / length(box, axis);
  }
  return share * volume_of(box, dimension);
}

/// A box that the surface may cross, and the parts of the region that have a say in it.
struct CrossedBox {
  AxisBox box;
  Region region;
};

/// The grid as a region, where it is more than its bounding box tells: of a polar one with its arcs.
Region region_of(const GridSpec& grid, int dimension) {
  if (!grid.polar) return everywhere();
  const auto [inner, outer] = extent(grid, 0);
  const auto [first, last] = extent(grid, 1);
  const Point center{grid.center[0], grid.center[1], 0};
  const auto disc = [&](double radius) {
    const double far = std::numeric_limits<double>::max();
    return dimension == 3 ? cylinder(2, center, radius, -far, far) : ball(center, radius);
  };
  const Region after = half_space(center, {std::sin(first), -std::cos(first), 0}),
               before = half_space(center, {-std::sin(last), std::cos(last), 0});
  const Region sector = last - first <= pi ? intersection_of({after, before}) : union_of({after, before});
  return difference_of({intersection_of({disc(outer), sector}), disc(inner)});
}

}  // namespace

double volume_within(const Region& region, const AxisBox& limits, int dimension, size_t enough_boxes) {
  const auto d = static_cast<size_t>(dimension);
  AxisBox box = common_box(limits, region.bounds());
  for (size_t i = 0; i < 3; ++i) {
    if (i >= d) box.lower[i] = box.upper[i] = 0;
    if (i < d && !(box.upper[i] > box.lower[i])) return 0;
  }
  double inside = 0, crossed = 0;
  std::vector<CrossedBox> boxes, halves;
  const auto take = [&](const AxisBox& part, const Region& whole, std::vector<CrossedBox>& to) {
    Region within = whole.within(part);
    if (within.is_empty()) return;
    const double volume = volume_of(part, dimension);
    if (within.is_everywhere()) {
      inside += volume;
      return;
    }
    crossed += volume;
    to.push_back({part, std::move(within)});
  };
  take(box, region, boxes);
  const auto estimate = [&] {
    double volume = inside;
    for (const auto& left : boxes) volume += volume_by_lines(left.region, left.box, dimension);
    return volume;
  };
  double before = -1;  // the estimate with half as many boxes or more
  while (!boxes.empty() && crossed > unresolved * inside) {
    if (boxes.size() >= enough_boxes) {
      const double volume = estimate();
      if (std::abs(volume - before) <= agreement * volume || boxes.size() >= 8 * enough_boxes) return volume;
      before = volume;
    }
    crossed = 0;
    halves.clear();
    for (const auto& whole : boxes) {
      size_t longest = 0;
      for (size_t i = 1; i < d; ++i)
        if (length(whole.box, i) > length(whole.box, longest)) longest = i;
      const double middle = 0.5 * (whole.box.lower[longest] + whole.box.upper[longest]);
      AxisBox half = whole.box;
      half.upper[longest] = middle;
      take(half, whole.region, halves);
      half = whole.box;
      half.lower[longest] = middle;
      take(half, whole.region, halves);
    }
    boxes.swap(halves);
  }
  return estimate();
}

std::vector<double> shape_volumes(const Scene& scene) {
  const size_t boxes = scene.dimension == 3 ? boxes_in_space : boxes_in_plane;
  const AxisBox limits = bounding_box(scene.grid, scene.dimension);
  const Region grid = region_of(scene.grid, scene.dimension);
  std::vector<double> volumes;
  for (const auto& body : scene.bodies)
    volumes.push_back(volume_within(intersection_of({body.region, grid}), limits, scene.dimension,
                                    std::max(fewest_boxes, boxes / scene.bodies.size())));
  return volumes;
}

}  // namespace vsb::app
