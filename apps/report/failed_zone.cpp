// SPDX-License-Identifier: BSD-3-Clause
#include "report/failed_zone.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

namespace vsb::app {

namespace {

/// Positions across the hole (a, b) and along it (c), from its centre.
struct Offset {
  double a, b, c;
  double radius() const { return std::hypot(a, b); }
};

/// A position on a raster of a quarter of the rows' distance, as one number: equal for positions that differ
/// by round-off alone, as mirror images do.
std::uint64_t key(const Offset& x, double row) {
  const auto number = [&](double along) {
    return static_cast<std::uint64_t>(std::llround(4 * along / row) + (1 << 20)) & 0x1fffff;
  };
  return (number(x.a) << 42) | (number(x.b) << 21) | number(x.c);
}

/// The particles that are there, to be found by their position.
class OffsetIndex {
 public:
  OffsetIndex(double row, size_t count) : row_(row) { keys_.reserve(count); }
  void add(const Offset& x, bool failed) { keys_.push_back(key(x, row_) << 1 | (failed ? 1u : 0u)); }
  void sort() { std::sort(keys_.begin(), keys_.end()); }
  /// Whether there is a particle that has not failed.
  bool intact(const Offset& x) const {
    return std::binary_search(keys_.begin(), keys_.end(), key(x, row_) << 1);
  }

 private:
  double row_;
  std::vector<std::uint64_t> keys_;  ///< twice the key, and 1 where it failed: 63 + 1 bits
};

}  // namespace

FailedZone measure_failed_zone(const HoleSpec& hole, int dimension, const std::vector<Point>& start,
                               const std::vector<Fate>& fate) {
  const size_t axis = hole.axis < 0 ? 2 : static_cast<size_t>(hole.axis);
  const size_t across = (axis + 1) % 3, across2 = (axis + 2) % 3;
  const auto offset = [&](size_t p) {
    return Offset{start[p][across] - hole.center[across], start[p][across2] - hole.center[across2],
                  dimension == 3 ? start[p][axis] - hole.center[axis] : 0.0};
  };
  const auto in_rows = [&](double radius) { return (radius - hole.radius) / hole.row; };
  FailedZone zone;
  std::vector<double> radius(start.size());
  std::map<long long, long long> in_layer;
  OffsetIndex index(hole.row, start.size());
  size_t failed = 0, gone = 0;
  for (size_t p = 0; p < start.size(); ++p) {
    const Offset x = offset(p);
    radius[p] = x.radius();
    const auto layer = std::llround(4 * x.c / hole.row);
    in_layer[layer] += fate[p] == Fate::failed;
    gone += fate[p] == Fate::gone;
    if (fate[p] != Fate::gone) index.add(x, fate[p] == Fate::failed);
    if (fate[p] != Fate::failed) continue;
    ++failed;
    zone.rows = std::max(zone.rows, in_rows(radius[p]));
    if (std::min(std::abs(x.a), std::abs(x.b)) < hole.row)
      zone.rows_axis = std::max(zone.rows_axis, in_rows(radius[p]));
    if (std::abs(std::abs(x.a) - std::abs(x.b)) < hole.row / 2)
      zone.rows_diagonal = std::max(zone.rows_diagonal, in_rows(radius[p]));
  }
  if (failed == 0) return zone;
  index.sort();
  size_t lopsided = 0;
  for (size_t p = 0; p < start.size(); ++p) {
    if (fate[p] != Fate::failed) continue;
    const auto [a, b, c] = offset(p);
    bool image_intact = false;
    for (const double s : {1.0, -1.0})
      for (const double t : {1.0, -1.0})
        image_intact = image_intact || index.intact({s * a, t * b, c}) || index.intact({s * b, t * a, c});
    lopsided += image_intact;
  }
  zone.asymmetry = static_cast<double>(lopsided) / static_cast<double>(failed);
  const auto last = radius.begin() + static_cast<std::ptrdiff_t>(gone + failed - 1);
  std::nth_element(radius.begin(), last, radius.end());
  zone.rows_mean = in_rows(*last);
  zone.per_layer = static_cast<double>(failed) / static_cast<double>(in_layer.size());
  const auto [least, most] = std::minmax_element(
      in_layer.begin(), in_layer.end(), [](const auto& x, const auto& y) { return x.second < y.second; });
  zone.layer_spread = static_cast<double>(most->second - least->second) / zone.per_layer;
  return zone;
}

}  // namespace vsb::app
