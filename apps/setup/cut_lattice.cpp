// SPDX-License-Identifier: BSD-3-Clause
#include "setup/cut_lattice.hpp"

#include <algorithm>
#include <cmath>

#include "setup/box_share.hpp"

namespace vsb::app {

namespace {

/// A box of the lattice or a half of one, and what the limits leave of it.
struct LatticeBox {
  AxisBox whole, within;
  bool cut = false;    ///< by the limits
  bool empty = false;  ///< beyond the limits
};

LatticeBox limited(const AxisBox& box, const AxisBox& limits, size_t d) {
  LatticeBox b{box, box};
  for (size_t i = 0; i < d; ++i) {
    const double round_off = 1e-9 * (box.upper[i] - box.lower[i]);
    if (box.lower[i] < limits.lower[i] - round_off) b.within.lower[i] = limits.lower[i];
    if (box.upper[i] > limits.upper[i] + round_off) b.within.upper[i] = limits.upper[i];
    b.cut = b.cut || b.within.lower[i] != box.lower[i] || b.within.upper[i] != box.upper[i];
    b.empty = b.empty || b.within.upper[i] - b.within.lower[i] <= round_off;
  }
  return b;
}

/// Half `number` of a box in every direction, bit i for the upper half in direction i.
AxisBox half(AxisBox box, size_t number, size_t d) {
  for (size_t i = 0; i < d; ++i) {
    const double middle = 0.5 * (box.lower[i] + box.upper[i]);
    (number >> i & 1 ? box.lower[i] : box.upper[i]) = middle;
  }
  return box;
}

class ShareVisitor {
 public:
  ShareVisitor(const Scene& scene, const BodySpec& body, const AxisBox& limits,
               const std::function<void(const LatticeShare&)>& visit)
      : dimension_(scene.dimension), body_(body), limits_(limits), visit_(visit) {}

  void add_box(const AxisBox& box, const LatticeShare& whole) {
    const LatticeBox b = limited(box, limits_, static_cast<size_t>(dimension_));
    if (b.empty || body_.region.overlap(b.within) == Overlap::none) return;
    if (body_.boundary == BoundaryBoxes::cut) {
      const BoxShare share = share_of(body_.region, b.within, dimension_);
      if (share.whole && !b.cut)
        take(whole);
      else
        add(b, share);
      return;
    }
    const size_t halves = size_t(1) << dimension_;
    LatticeBox part[8];
    BoxShare share[8];
    bool all_whole = !b.cut && !touches_cut_half(box);
    for (size_t h = 0; h < halves; ++h) {
      part[h] =
          limited(half(box, h, static_cast<size_t>(dimension_)), limits_, static_cast<size_t>(dimension_));
      if (!part[h].empty) share[h] = share_of(body_.region, part[h].within, dimension_);
      all_whole = all_whole && share[h].whole;
    }
    if (all_whole) return take(whole);
    for (size_t h = 0; h < halves; ++h)
      if (!part[h].empty) add(part[h], share[h]);
  }

  CutVolume volume() const { return volume_; }

 private:
  /// Whether the surface cuts one of the halves of neighbours that touch a box. Where large and small shares
  /// meet, the sum over particles is a poor integral; that position must lie off the boxes that the surface
  /// cuts.
  bool touches_cut_half(const AxisBox& box) const {
    const auto d = static_cast<size_t>(dimension_);
    int number = 1;
    for (size_t i = 0; i < d; ++i) number *= 4;
    for (int n = 0; n < number; ++n) {
      AxisBox part = box;
      bool inside = true;  // of the box itself
      for (size_t i = 0, rest = static_cast<size_t>(n); i < d; ++i, rest /= 4) {
        const double width = 0.5 * (box.upper[i] - box.lower[i]), k = static_cast<double>(rest % 4) - 1;
        inside = inside && (rest % 4 == 1 || rest % 4 == 2);
        part.lower[i] = box.lower[i] + k * width;
        part.upper[i] = box.lower[i] + (k + 1) * width;
      }
      const LatticeBox limited_part = limited(part, limits_, d);
      if (!inside && !limited_part.empty && body_.region.overlap(limited_part.within) == Overlap::some)
        return true;
    }
    return false;
  }
  void add(const LatticeBox& box, const BoxShare& share) {
    if (share.volume > least_share * volume_of(box.whole, dimension_))
      take({share.centroid, share.volume, box.within, {}, false});
    else
      volume_.dropped += share.volume;
  }
  void take(const LatticeShare& share) {
    volume_.particles += share.volume;
    visit_(share);
  }

  int dimension_;
  const BodySpec& body_;
  const AxisBox& limits_;
  const std::function<void(const LatticeShare&)>& visit_;
  CutVolume volume_;
};

}  // namespace

CutVolume for_each_lattice_share(const Scene& scene, const BodySpec& body, const AxisBox& limits,
                                 const std::function<void(const LatticeShare&)>& visit) {
  const auto d = static_cast<size_t>(scene.dimension);
  const UniformLattice lattice = uniform_lattice(scene.grid, body.lattice);
  const LatticeRange range = lattice_range(lattice, body, limits, scene.dimension);
  double volume = 1;
  for (size_t i = 0; i < d; ++i) volume *= lattice.spacing[i];
  ShareVisitor visitor(scene, body, limits, visit);
  LatticeIndex at{};
  for (at[2] = range.first[2]; at[2] < range.last[2]; ++at[2])
    for (at[1] = range.first[1]; at[1] < range.last[1]; ++at[1])
      for (at[0] = range.first[0]; at[0] < range.last[0]; ++at[0]) {
        LatticeShare whole{{}, volume, {}, at, true};
        for (size_t i = 0; i < d; ++i) {
          whole.position[i] = lattice.point(at, i);
          whole.box.lower[i] = lattice.origin[i] + static_cast<double>(at[i]) * lattice.spacing[i];
          whole.box.upper[i] = lattice.origin[i] + static_cast<double>(at[i] + 1) * lattice.spacing[i];
        }
        visitor.add_box(whole.box, whole);
      }
  return visitor.volume();
}

bool cuts_boxes(const Scene& scene, const BodySpec& body) {
  constexpr double round_off = 1e-6;  // of a box
  BodySpec as_cut = body;
  as_cut.boundary = BoundaryBoxes::cut;
  const UniformLattice lattice = uniform_lattice(scene.grid, body.lattice);
  double box = 1;
  for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i) box *= lattice.spacing[i];
  bool cuts = false;
  const auto volume = for_each_lattice_share(
      scene, as_cut, bounding_box(scene.grid, scene.dimension),
      [&](const LatticeShare& share) { cuts = cuts || share.volume < (1 - round_off) * box; });
  return cuts || volume.dropped > round_off * box;
}

}  // namespace vsb::app
