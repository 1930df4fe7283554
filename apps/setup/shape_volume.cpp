// SPDX-License-Identifier: BSD-3-Clause
#include "setup/shape_volume.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "scene/units.hpp"
#include "setup/box_share.hpp"

namespace vsb::app {

namespace {

constexpr double shortest_interval = 1e-6;  ///< of a line, in shares of the box that it crosses
constexpr double unresolved = 1e-9;   ///< of the volume: boxes smaller than this together are not halved
constexpr double agreement = 1.5e-4;  ///< of the volume: between estimates with fewer and with more boxes
constexpr size_t boxes_in_plane = 512, boxes_in_space = 1024, fewest_boxes = 128;
constexpr size_t most_boxes = 8;       ///< times as many, at last
constexpr double shortest_way = 1e-4;  ///< to an end, in shares of the box
constexpr double thin = 0.1;           ///< chords, in shares of the box: one point tells of all
constexpr double farthest_end = 4;     ///< that is looked for, in edges of the box
constexpr double gauss[] = {0.5 - 0.5 / 1.7320508075688772, 0.5 + 0.5 / 1.7320508075688772};

double length(const AxisBox& box, size_t axis) {
  return box.upper[axis] - box.lower[axis];
}

struct Interval {
  double lower, upper;
};

/// Adds what a part of a line has in common with a region, in the order of the line.
void add_intervals(const Region& region, const AxisBox& line, size_t axis, double shortest,
                   std::vector<Interval>& chords) {
  const Overlap overlap = region.overlap(line);
  if (overlap == Overlap::none) return;
  const double lower = line.lower[axis], upper = line.upper[axis];
  if (overlap == Overlap::all || upper - lower <= shortest) {
    // Of an interval with a crossing one half counts: the one beside what is inside, if there is any.
    const double half = overlap == Overlap::all ? 0 : 0.5 * (upper - lower);
    if (!chords.empty() && chords.back().upper >= lower)
      chords.back().upper = upper - half;
    else
      chords.push_back({lower + half, upper});
    return;
  }
  AxisBox part = line;
  part.upper[axis] = part.lower[axis] = 0.5 * (lower + upper);
  part.lower[axis] = lower;
  add_intervals(region, part, axis, shortest, chords);
  part.lower[axis] = part.upper[axis];
  part.upper[axis] = upper;
  add_intervals(region, part, axis, shortest, chords);
}

/// How far it is along a line from its end at `from`, which is inside, to the first point outside.
double way_out(const Region& region, const AxisBox& line, size_t axis, bool upwards, double shortest) {
  const Overlap overlap = region.overlap(line);
  const double all = length(line, axis);
  if (overlap == Overlap::none) return 0;
  if (overlap == Overlap::all) return all;
  if (all <= shortest) return 0.5 * all;
  AxisBox near = line, far = line;
  const double middle = 0.5 * (line.lower[axis] + line.upper[axis]);
  (upwards ? near.upper : near.lower)[axis] = middle;
  (upwards ? far.lower : far.upper)[axis] = middle;
  const double way = way_out(region, near, axis, upwards, shortest);
  return way < length(near, axis) ? way : way + way_out(region, far, axis, upwards, shortest);
}

/// What a box has of a region, by chords of lines along all axes. Every point of the region belongs to the
/// axes in shares that add up to one, w_i = r_i^-4 / sum_k r_k^-4 with r_i the way along axis i to the nearer
/// end of the region; in a wall of normal n, n_i^4 / sum_k n_k^4. So a line hardly counts in a wall that it
/// runs along, where few lines are for very long, and each wall is counted by lines that cross it.
class Chords {
 public:
  /// `near`: the region in the box and farthest_end edges around it.
  Chords(const Region& within, const Region& near, const AxisBox& box, int dimension)
      : within_(within), near_(near), box_(box), d_(static_cast<size_t>(dimension)) {
    for (size_t a = 0; a < d_; ++a) most_ = std::min(most_, farthest_end * length(box, a));
  }

  double volume() {
    double volume = 0;
    const size_t lines = d_ == 1 ? 1 : d_ == 2 ? n_ : n_ * n_;
    for (size_t axis = 0; axis < d_; ++axis) {
      double area = 1;
      for (size_t k = 1; k < d_; ++k) area *= length(box_, (axis + k) % d_);
      for (size_t n = 0; n < lines; ++n)
        volume += counted_length(line(axis, n), axis) * area / static_cast<double>(lines);
    }
    return volume;
  }

 private:
  static constexpr size_t n_ = 4;  // lines per direction

  /// At the two positions of Gauss's quadrature in each half of the box.
  AxisBox line(size_t axis, size_t n) const {
    AxisBox line = box_;
    for (size_t k = 1; k < d_; ++k, n /= n_) {
      const size_t across = (axis + k) % d_;
      const double at = 0.5 * (static_cast<double>(n % n_ / 2) + gauss[n % 2]);
      line.lower[across] = line.upper[across] = box_.lower[across] + at * length(box_, across);
    }
    return line;
  }

  /// The chords of a line, each with the share that its axis has in its points.
  double counted_length(const AxisBox& line, size_t axis) {
    chords_.clear();
    add_intervals(within_, line, axis, shortest_interval * length(box_, axis), chords_);
    double sum = 0;
    for (const auto& [lower, upper] : chords_) {
      const auto share_at = [&](double at) {
        Point x = line.lower;
        x[axis] = lower + at * (upper - lower);
        return share(x, axis);
      };
      sum += (upper - lower) * (upper - lower < thin * length(box_, axis)
                                    ? share_at(0.5)
                                    : 0.5 * (share_at(gauss[0]) + share_at(gauss[1])));
    }
    return sum;
  }

  double share(const Point& x, size_t axis) const {
    if (d_ == 1) return 1;
    double sum = 0, own = 0;
    for (size_t a = 0; a < d_; ++a) {
      const double square = std::pow(std::max(nearest_end(x, a), shortest(a)), 2);
      sum += 1 / (square * square);
      if (a == axis) own = 1 / (square * square);
    }
    return own / sum;
  }

  /// How far it is along an axis to the nearer end of the region, or `most_`.
  double nearest_end(const Point& x, size_t axis) const {
    double nearest = most_;
    for (const bool upwards : {false, true}) {
      AxisBox line{x, x};
      (upwards ? line.upper : line.lower)[axis] += upwards ? nearest : -nearest;
      nearest = std::min(nearest, way_out(near_, line, axis, upwards, shortest(axis)));
    }
    return nearest;
  }

  double shortest(size_t axis) const { return shortest_way * length(box_, axis); }

  const Region &within_, &near_;
  const AxisBox& box_;
  size_t d_;
  double most_ = std::numeric_limits<double>::infinity();
  std::vector<Interval> chords_;
};

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

Volume volume_within(const Region& region, const AxisBox& limits, int dimension, size_t enough_boxes) {
  const auto d = static_cast<size_t>(dimension);
  AxisBox box = common_box(limits, region.bounds());
  for (size_t i = 0; i < 3; ++i) {
    if (i >= d) box.lower[i] = box.upper[i] = 0;
    if (i < d && !(box.upper[i] > box.lower[i])) return {};
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
    for (const auto& left : boxes) {
      AxisBox around = left.box;
      for (size_t i = 0; i < d; ++i) {
        around.lower[i] -= farthest_end * length(left.box, i);
        around.upper[i] += farthest_end * length(left.box, i);
      }
      volume += Chords(left.region, region.within(around), left.box, dimension).volume();
    }
    return volume;
  };
  std::optional<double> before;  // the estimate with half as many boxes or more
  while (!boxes.empty() && crossed > unresolved * inside) {
    if (boxes.size() >= enough_boxes) {
      const double volume = estimate(), difference = std::abs(volume - before.value_or(0));
      if (before && (difference <= agreement * volume || boxes.size() >= most_boxes * enough_boxes))
        return {volume, difference};
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
  return {estimate(), 0};
}

std::vector<Volume> shape_volumes(const Scene& scene) {
  const size_t boxes = scene.dimension == 3 ? boxes_in_space : boxes_in_plane;
  const AxisBox limits = bounding_box(scene.grid, scene.dimension);
  const Region grid = region_of(scene.grid, scene.dimension);
  std::vector<Volume> volumes;
  for (const auto& body : scene.bodies)
    volumes.push_back(volume_within(intersection_of({body.region, grid}), limits, scene.dimension,
                                    std::max(fewest_boxes, boxes / scene.bodies.size())));
  return volumes;
}

}  // namespace vsb::app
