// SPDX-License-Identifier: BSD-3-Clause
#include "setup/box_share.hpp"

#include <vector>

namespace vsb::app {

namespace {

constexpr double round_off = 1e-9;  // of the box: faces that coincide but for this are the same

constexpr BoxMoments moments_of_whole{1, 1. / 2, 1. / 2, 1. / 4, 1. / 2, 1. / 4, 1. / 4, 1. / 8};

/// A box with its sampling lines. Positions are given in shares of the box's edges.
class SampledBox {
 public:
  SampledBox(const Region& region, const AxisBox& box, int dimension)
      : region_(region),
        box_(box),
        d_(static_cast<size_t>(dimension)),
        n_(static_cast<size_t>(samples_per_direction(dimension))) {}

  BoxMoments integrate() const {
    size_t best = 0, most = 0;
    bool any = false, all = true;
    for (size_t axis = 0; axis < d_; ++axis) {
      const size_t crossings = count_crossings(axis, any, all);
      if (crossings > most) {
        most = crossings;
        best = axis;
      }
    }
    if (!any) return {};
    if (all) return moments_of_whole;
    BoxMoments sum{};
    for (size_t line = 0; line < lines(); ++line) add(line_of(best, line), best, sum);
    for (double& value : sum) value /= static_cast<double>(lines());
    return sum;
  }

 private:
  size_t lines() const { return d_ == 1 ? 1 : d_ == 2 ? n_ : n_ * n_; }

  double middle(size_t k) const { return (static_cast<double>(k) + 0.5) / static_cast<double>(n_); }
  /// Sample k of a line: its begin, the middles of n intervals, its end.
  double sample(size_t k) const { return k == 0 ? 0 : k == n_ + 1 ? 1 : middle(k - 1); }

  /// The position of a line along an axis.
  Point line_of(size_t axis, size_t line) const {
    Point local{0.5, 0.5, 0.5};
    for (size_t k = 1; k < d_; ++k, line /= n_) local[(axis + k) % d_] = middle(line % n_);
    return local;
  }

  bool inside(Point local, size_t axis, double along) const {
    local[axis] = along;
    Point x{};
    for (size_t i = 0; i < d_; ++i) x[i] = box_.lower[i] + local[i] * (box_.upper[i] - box_.lower[i]);
    return region_(x);
  }

  size_t count_crossings(size_t axis, bool& any, bool& all) const {
    size_t crossings = 0;
    for (size_t line = 0; line < lines(); ++line) {
      const Point local = line_of(axis, line);
      bool before = false;
      for (size_t k = 0; k < n_ + 2; ++k) {
        const bool now = inside(local, axis, sample(k));
        any = any || now;
        all = all && now;
        if (k > 0 && now != before) ++crossings;
        before = now;
      }
    }
    return crossings;
  }

  void add(Point local, size_t axis, BoxMoments& sum) const {
    const auto add_interval = [&](double from, double to) {
      local[axis] = 0.5 * (from + to);
      for (size_t k = 0; k < size_t(1) << d_; ++k) sum[k] += (to - from) * value_of_product(k, local);
    };
    double begin = 0;
    bool before = inside(local, axis, 0);
    for (size_t k = 1; k < n_ + 2; ++k) {
      const bool now = inside(local, axis, sample(k));
      if (now != before) {
        double same = sample(k - 1), other = sample(k);
        for (int step = 0; step < 40; ++step) {
          const double between = 0.5 * (same + other);
          (inside(local, axis, between) == before ? same : other) = between;
        }
        if (before) add_interval(begin, 0.5 * (same + other));
        begin = 0.5 * (same + other);
      }
      before = now;
    }
    if (before) add_interval(begin, 1);
  }

  const Region& region_;
  const AxisBox& box_;
  size_t d_, n_;
};

}  // namespace

double volume_of(const AxisBox& box, int dimension) {
  double volume = 1;
  for (size_t i = 0; i < static_cast<size_t>(dimension); ++i) volume *= box.upper[i] - box.lower[i];
  return volume;
}

BoxMoments moments_of(const Region& region, const AxisBox& box, int dimension) {
  switch (region.overlap(box)) {
    case Overlap::none:
      return {};
    case Overlap::all:
      return moments_of_whole;
    default:
      return SampledBox(region, box, dimension).integrate();
  }
}

BoxShare share_of(const Region& region, const AxisBox& box, int dimension) {
  const auto d = static_cast<size_t>(dimension);
  BoxShare share;
  for (size_t i = 0; i < d; ++i) share.centroid[i] = 0.5 * (box.lower[i] + box.upper[i]);
  const double volume = volume_of(box, dimension);
  const auto moments = moments_of(region, box, dimension);
  if (moments[0] >= 1 - round_off) {
    share.volume = volume;
    share.whole = true;
  } else if (moments[0] > round_off) {
    share.volume = moments[0] * volume;
    for (size_t i = 0; i < d; ++i)
      share.centroid[i] = box.lower[i] + moments[size_t(1) << i] / moments[0] * (box.upper[i] - box.lower[i]);
  }
  return share;
}

}  // namespace vsb::app
