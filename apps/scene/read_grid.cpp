// SPDX-License-Identifier: BSD-3-Clause
#include "scene/read_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vsb::app {

namespace {

const std::vector<std::string> axis_names = {"x", "y", "z"};

/// So that the raster, with eight cells per cell of a grid in space, can be numbered.
constexpr double most_mapped_nodes = 1e8;

GridSpec read_uniform(TableReader& r, int dimension) {
  const auto d = static_cast<size_t>(dimension);
  GridSpec grid;
  const auto lower = r.numbers("lower", d, Range::any(), {}, "m, corner of the grid");
  const auto upper = r.numbers("upper", d, Range::any(), {}, "m, opposite corner");
  const auto spacing = r.number_or_numbers("spacing", d, Range::positive(), {}, "m, cell size");
  double nodes = 1;
  for (size_t i = 0; i < d; ++i) {
    const double cells = (upper[i] - lower[i]) / spacing[i];
    const double rounded = std::round(cells);
    if (!(rounded >= 1) || std::abs(cells - rounded) > 1e-6 * rounded)
      r.fail(*r.source().get("upper"), "upper",
             fmt::format(
                 "must lie a whole number of cells (>= 1) above 'lower'; in {} there are {} cells of {} m",
                 axis_names[i], cells, spacing[i]));
    nodes *= rounded + 1;
    if (nodes > 1e9)
      r.fail(*r.source().get("spacing"), "spacing",
             fmt::format("the grid must have <= 1e9 nodes, not {:.3g}", nodes));
    grid.lower[i] = lower[i];
    grid.spacing[i] = spacing[i];
    grid.cells[i] = static_cast<int>(rounded);
  }
  return grid;
}

void set_axis(GridSpec& grid, size_t axis, std::vector<double> nodes) {
  grid.cells[axis] = static_cast<int>(nodes.size()) - 1;
  grid.coordinates[axis] = std::move(nodes);
}

void limit_nodes(const TableReader& r, const toml::node& at, const std::string& key, const GridSpec& grid) {
  double nodes = 1;
  for (const auto& axis : grid.coordinates) nodes *= std::max(1.0, static_cast<double>(axis.size()));
  if (nodes > most_mapped_nodes)
    r.fail(at, key, fmt::format("the grid must have <= {:g} nodes, not {:.3g}", most_mapped_nodes, nodes));
}

GridSpec read_rectilinear(TableReader& r, int dimension) {
  GridSpec grid;
  for (size_t i = 0; i < static_cast<size_t>(dimension); ++i) {
    set_axis(grid, i, r.increasing_numbers(axis_names[i], "m, nodes"));
    grid.lower[i] = grid.coordinates[i].front();
  }
  limit_nodes(r, *r.source().get("x"), "x", grid);
  return grid;
}

/// count + 1 numbers from low to high, both of them exact.
std::vector<double> equal_intervals(double low, double high, int count) {
  std::vector<double> nodes;
  for (int i = 0; i <= count; ++i) nodes.push_back(low + (high - low) * i / count);
  nodes.back() = high;
  return nodes;
}

/// Equal intervals between the two numbers of a key, which must be so many different numbers.
std::vector<double> divided(const TableReader& r, const std::string& key, const std::vector<double>& ends,
                            int count) {
  auto nodes = equal_intervals(ends[0], ends[1], count);
  if (std::adjacent_find(nodes.begin(), nodes.end(), [](double a, double b) { return !(b > a); }) !=
      nodes.end())
    r.fail(
        *r.source().get(key), key,
        fmt::format("lie too close together for {} cells: double precision has not as many numbers between "
                    "them",
                    count));
  return nodes;
}

GridSpec read_polar(TableReader& document, int dimension) {
  if (dimension == 1)
    document.fail(*document.source().get("polar"), "polar", "a polar grid is for dimension 2 or 3");
  TableReader r = document.table("polar");
  r.allow_only({"center", "radii", "radial_cells", "angles", "angular_cells", "z"});
  GridSpec grid;
  grid.polar = true;
  const auto center = r.numbers("center", 2, Range::any(), std::vector<double>{0, 0}, "m");
  std::copy(center.begin(), center.end(), grid.center.begin());
  const int most = 1'000'000;
  const auto radii = r.numbers("radii", 2, Range::positive(), {}, "m");
  if (!(radii[1] > radii[0])) r.fail(*r.source().get("radii"), "radii", "must increase");
  const auto radial = static_cast<int>(r.integer("radial_cells", 1, most));
  const auto angles = r.numbers("angles", 2, Range::between(-360, 360), {}, "degrees from x towards y");
  const double span = angles[1] - angles[0];
  if (!(span > 0 && span < 360))
    r.fail(*r.source().get("angles"), "angles",
           "must increase, by less than 360 degrees: the faces theta_min and theta_max are not joined");
  const auto angular = static_cast<int>(r.integer("angular_cells", 1, most));
  if (span / angular > 90)
    r.fail(*r.source().get("angular_cells"), "angular_cells",
           fmt::format("a cell must span <= 90 degrees, not {:g}", span / angular));
  const double degree = std::acos(-1.0) / 180;
  set_axis(grid, 0, divided(r, "radii", radii, radial));
  auto theta = divided(r, "angles", angles, angular);
  for (auto& angle : theta) angle *= degree;
  set_axis(grid, 1, std::move(theta));
  if (dimension == 3) set_axis(grid, 2, r.increasing_numbers("z", "m, nodes"));
  limit_nodes(r, *r.source().get("radial_cells"), "radial_cells", grid);
  r.finish();
  return grid;
}

/// Of a cell: what double precision must tell apart everywhere in the grid.
constexpr double coarsest_coordinate = 1e-6;

/// Refuses coordinates so large that two of them a small share of a cell apart are the same number.
void refuse_coarse_coordinates(const TableReader& r, const std::string& key, const GridSpec& grid,
                               int dimension) {
  const auto box = bounding_box(grid, dimension);
  const double h = shortest_edge(grid, dimension);
  for (size_t i = 0; i < static_cast<size_t>(dimension); ++i) {
    const double farthest = std::max(std::abs(box.lower[i]), std::abs(box.upper[i]));
    const double step = std::numeric_limits<double>::epsilon() * farthest;
    if (step > coarsest_coordinate * h)
      r.fail(*r.source().get(key), key,
             fmt::format(
                 "the grid lies up to {:.6g} m from the origin along {}, where numbers are {:.2g} m apart, "
                 "and its cells are {:.6g} m: move the scene to within {:.3g} m",
                 farthest, axis_names[i], step, h,
                 coarsest_coordinate * h / std::numeric_limits<double>::epsilon()));
  }
}

/// The components that are fixed at a face, and whether it lets particles go.
unsigned char read_face(TableReader& r, const std::string& key, size_t axis, int dimension, bool polar,
                        bool& outflow) {
  const toml::node* written = r.source().get(key);
  if (written && written->is_array()) {
    const std::vector<std::string> allowed(axis_names.begin(), axis_names.begin() + dimension);
    if (written->as_array()->empty()) r.fail(*written, key, "must name a component; an open face is 'open'");
    int mask = 0;
    for (const auto& component : r.texts(key, allowed)) mask |= 1 << (component[0] - 'x');
    return static_cast<unsigned char>(mask);
  }
  // Components are along x, y and z; the normal of a face of constant r or theta is not.
  const bool no_roller = polar && axis < 2;
  if (no_roller && written && written->value<std::string>() == "roller")
    r.fail(*written, key,
           "must be 'open', 'outflow', 'fixed' or a list of fixed components such as [\"y\"]: a roller "
           "needs a face across x, y or z");
  const auto kinds = no_roller ? std::vector<std::string>{"open", "outflow", "fixed"}
                               : std::vector<std::string>{"open", "outflow", "roller", "fixed"};
  const std::string kind = r.choice(key, kinds, "open");
  outflow = kind == "outflow";
  if (kind == "roller") return static_cast<unsigned char>(1 << axis);
  return static_cast<unsigned char>(kind == "fixed" ? (1 << dimension) - 1 : 0);
}

}  // namespace

GridSpec read_grid(TableReader r, int dimension) {
  std::vector<std::string> keys = {"lower", "upper", "spacing"};
  keys.insert(keys.end(), axis_names.begin(), axis_names.begin() + dimension);
  keys.emplace_back("polar");
  r.allow_only(keys);
  const bool rectilinear = r.has("x") || r.has("y") || r.has("z"), polar = r.has("polar");
  const bool uniform = r.has("lower") || r.has("upper") || r.has("spacing");
  if (int(rectilinear) + int(polar) + int(uniform) > 1) {
    const auto first = r.source().begin();
    r.fail(first->second, std::string(first->first.str()),
           "a grid has either lower, upper and spacing, or node coordinates x (y, z), or polar");
  }
  GridSpec grid = polar         ? read_polar(r, dimension)
                  : rectilinear ? read_rectilinear(r, dimension)
                                : read_uniform(r, dimension);
  refuse_coarse_coordinates(r, polar ? "polar" : rectilinear ? "x" : "lower", grid, dimension);
  r.finish();
  return grid;
}

FaceSpec read_faces(TableReader r, int dimension, const GridSpec& grid) {
  FaceSpec faces;
  for (size_t axis = 0; axis < static_cast<size_t>(dimension); ++axis)
    for (size_t side = 0; side < 2; ++side)
      faces.fixed[axis][side] = read_face(r, grid.axis_name(axis) + (side == 0 ? "_min" : "_max"), axis,
                                          dimension, grid.polar, faces.outflow[axis][side]);
  r.finish();
  return faces;
}

}  // namespace vsb::app
