// SPDX-License-Identifier: BSD-3-Clause
#include "setup/support_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "setup/local_origin.hpp"

namespace vsb::app {

namespace {

/// Of a load, what is less than this is round-off.
constexpr double round_off = 1e-9;
/// Of the nodal forces: what the cells at the boundary may leave of loads that balance.
constexpr double left_by_cells = 0.05;

std::string list(const Point& v, int first, int last, double least) {
  std::string numbers;
  for (int i = first; i < last; ++i) {
    const double x = v[static_cast<size_t>(i)];
    numbers += fmt::format("{}{:.4g}", i == first ? "" : ", ", std::abs(x) < least ? 0 : x);
  }
  return numbers;
}

double length(const Point& v) {
  return std::hypot(v[0], v[1], v[2]);
}

}  // namespace

std::string support_text(const Scene& scene, const LooseLoad& load) {
  const auto box = bounding_box(scene.grid, scene.dimension);
  double size = 0;
  for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i)
    size = std::max(size, box.upper[i] - box.lower[i]);
  const double force = std::max(length(load.force), length(load.torque) / size);
  std::vector<std::string> motions;
  std::string axes;
  for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i)
    if (std::abs(load.force[i]) > round_off * force)
      axes += fmt::format("{}{}", axes.empty() ? "along " : " and ", "xyz"[i]);
  if (!axes.empty()) motions.push_back(axes);
  const bool turns = length(load.torque) > round_off * force * size;
  if (turns) motions.emplace_back("against turning");
  const bool balanced = load.share < left_by_cells && !scene.tractions.empty();
  return fmt::format(
      "no support takes up a force of ({}) N{} on the body around {}, {:.2g} % of the sum of the forces "
      "(loads, weight, initial stress) at its nodes: {}hold it {} by a face of the grid that it touches "
      "('faces': \"roller\" or \"fixed\"), or let its loads balance",
      list(load.force, 0, scene.dimension, round_off * force),
      turns ? fmt::format(" and a torque of ({}) N m", list(load.torque, 0, 3, round_off * force * size))
            : "",
      position_text(scene, load.middle, 4), 100 * load.share,
      balanced ? "so little may be what the cells at the boundary leave of loads that balance, and nodes = "
                 "\"all\" in the traction leaves none of it; else "
               : "",
      fmt::join(motions, " and "));
}

}  // namespace vsb::app
