// SPDX-License-Identifier: BSD-3-Clause
#include "setup/region_size.hpp"

#include <algorithm>
#include <limits>

#include "setup/box_share.hpp"

namespace vsb::app {

namespace {

/// Calls visit(part) for the n^d equal parts of a box.
template <class Visit>
void for_each_part(const AxisBox& box, int dimension, int n, const Visit& visit) {
  const auto d = static_cast<size_t>(dimension);
  int count = 1;
  for (size_t i = 0; i < d; ++i) count *= n;
  for (int k = 0; k < count; ++k) {
    AxisBox part = box;
    int rest = k;
    for (size_t i = 0; i < d; ++i, rest /= n) {
      const double width = (box.upper[i] - box.lower[i]) / n;
      part.lower[i] = box.lower[i] + rest % n * width;
      part.upper[i] = rest % n == n - 1 ? box.upper[i] : box.lower[i] + (rest % n + 1) * width;
    }
    visit(part);
  }
}

/// Halves the empty slab beside each face of the bounds until nothing of it is left.
void tighten(const Region& region, AxisBox& bounds, int dimension) {
  for (size_t i = 0; i < static_cast<size_t>(dimension); ++i)
    for (const bool upper : {false, true}) {
      double empty = upper ? bounds.upper[i] : bounds.lower[i];
      double filled = upper ? bounds.lower[i] : bounds.upper[i];
      for (double middle; middle = 0.5 * (empty + filled), middle != empty && middle != filled;) {
        AxisBox slab = bounds;
        (upper ? slab.lower : slab.upper)[i] = middle;
        (region.overlap(slab) == Overlap::none ? empty : filled) = middle;
      }
      (upper ? bounds.upper : bounds.lower)[i] = empty;
    }
}

}  // namespace

AxisBox bounds_of(const Region& region, const AxisBox& box, int dimension) {
  const auto d = static_cast<size_t>(dimension);
  const int parts[] = {64, 16, 8};
  AxisBox bounds = box;
  for (bool shrinks = true; shrinks;) {
    AxisBox next = bounds;
    for (size_t i = 0; i < d; ++i) {
      next.lower[i] = std::numeric_limits<double>::infinity();
      next.upper[i] = -next.lower[i];
    }
    for_each_part(bounds, dimension, parts[d - 1], [&](const AxisBox& part) {
      if (region.overlap(part) == Overlap::none) return;
      for (size_t i = 0; i < d; ++i) {
        next.lower[i] = std::min(next.lower[i], part.lower[i]);
        next.upper[i] = std::max(next.upper[i], part.upper[i]);
      }
    });
    shrinks = false;
    for (size_t i = 0; i < d; ++i) {
      const double width = bounds.upper[i] - bounds.lower[i];
      if (!(next.upper[i] > next.lower[i])) return bounds;
      shrinks = shrinks || next.upper[i] - next.lower[i] < 0.9 * width;
    }
    bounds = next;
  }
  tighten(region, bounds, dimension);
  return bounds;
}

double least_volume(const Region& region, const AxisBox& box, int dimension) {
  const int parts[] = {512, 64, 16};
  double volume = 0;
  for_each_part(bounds_of(region, box, dimension), dimension, parts[static_cast<size_t>(dimension) - 1],
                [&](const AxisBox& part) {
                  if (region.overlap(part) == Overlap::all) volume += volume_of(part, dimension);
                });
  return volume;
}

}  // namespace vsb::app
