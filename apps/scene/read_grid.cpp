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
  const auto lower = r.read(grid_keys.lower.of(d));
  const auto upper = r.read(grid_keys.upper.of(d));
  const auto spacing = r.read(grid_keys.spacing, d);
  double nodes = 1;
  for (size_t i = 0; i < d; ++i) {
    const double cells = (upper[i] - lower[i]) / spacing[i];
    const double rounded = std::round(cells);
    if (!(rounded >= 1) || std::abs(cells - rounded) > 1e-6 * rounded)
      r.fail(grid_keys.upper,
             fmt::format(
                 "must lie a whole number of cells (>= 1) above 'lower'; in {} there are {} cells of {} m",
                 axis_names[i], cells, spacing[i]));
    nodes *= rounded + 1;
    if (nodes > 1e9)
      r.fail(grid_keys.spacing, fmt::format("the grid must have <= 1e9 nodes, not {:.3g}", nodes));
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

void limit_nodes(const TableReader& r, const Key& key, const GridSpec& grid) {
  double nodes = 1;
  for (const auto& axis : grid.coordinates) nodes *= std::max(1.0, static_cast<double>(axis.size()));
  if (nodes > most_mapped_nodes)
    r.fail(key, fmt::format("the grid must have <= {:g} nodes, not {:.3g}", most_mapped_nodes, nodes));
}

GridSpec read_rectilinear(TableReader& r, int dimension) {
  GridSpec grid;
  for (size_t i = 0; i < static_cast<size_t>(dimension); ++i) {
    set_axis(grid, i, r.read(grid_keys.axis(i)));
    grid.lower[i] = grid.coordinates[i].front();
  }
  limit_nodes(r, grid_keys.x, grid);
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
std::vector<double> divided(const TableReader& r, const Key& key, const std::vector<double>& ends,
                            int count) {
  auto nodes = equal_intervals(ends[0], ends[1], count);
  if (std::adjacent_find(nodes.begin(), nodes.end(), [](double a, double b) { return !(b > a); }) !=
      nodes.end())
    r.fail(key, fmt::format(
                    "lie too close together for {} cells: double precision has not as many numbers between "
                    "them",
                    count));
  return nodes;
}

GridSpec read_polar(TableReader& document, int dimension) {
  if (dimension == 1) document.fail(grid_keys.polar, "a polar grid is for dimension 2 or 3");
  TableReader r = document.table(grid_keys.polar);
  const auto& keys = polar_keys;
  GridSpec grid;
  grid.polar = true;
  const auto center = r.read(keys.center);
  std::copy(center.begin(), center.end(), grid.center.begin());
  const auto radii = r.read(keys.radii);
  if (!(radii[1] > radii[0])) r.fail(keys.radii, "must increase");
  const auto radial = static_cast<int>(r.read(keys.radial_cells));
  const auto angles = r.read(keys.angles);
  const double span = angles[1] - angles[0];
  if (!(span > 0 && span < 360))
    r.fail(keys.angles,
           "must increase, by less than 360 degrees: the faces theta_min and theta_max are not joined");
  const auto angular = static_cast<int>(r.read(keys.angular_cells));
  if (span / angular > 90)
    r.fail(keys.angular_cells, fmt::format("a cell must span <= 90 degrees, not {:g}", span / angular));
  const double degree = std::acos(-1.0) / 180;
  set_axis(grid, 0, divided(r, keys.radii, radii, radial));
  auto theta = divided(r, keys.angles, angles, angular);
  for (auto& angle : theta) angle *= degree;
  set_axis(grid, 1, std::move(theta));
  if (dimension == 3) set_axis(grid, 2, r.read(keys.z));
  limit_nodes(r, keys.radial_cells, grid);
  r.finish();
  return grid;
}

/// Of a cell: what double precision must tell apart everywhere in the grid.
constexpr double coarsest_coordinate = 1e-6;

/// Refuses coordinates so large that two of them a small share of a cell apart are the same number.
void refuse_coarse_coordinates(const TableReader& r, const Key& key, const GridSpec& grid, int dimension) {
  const auto box = bounding_box(grid, dimension);
  const double h = shortest_edge(grid, dimension);
  for (size_t i = 0; i < static_cast<size_t>(dimension); ++i) {
    const double farthest = std::max(std::abs(box.lower[i]), std::abs(box.upper[i]));
    const double step = std::numeric_limits<double>::epsilon() * farthest;
    if (step > coarsest_coordinate * h)
      r.fail(key,
             fmt::format(
                 "the grid lies up to {:.6g} m from the origin along {}, where numbers are {:.2g} m apart, "
                 "and its cells are {:.6g} m: move the scene to within {:.3g} m",
                 farthest, axis_names[i], step, h,
                 coarsest_coordinate * h / std::numeric_limits<double>::epsilon()));
  }
}

/// The components that are fixed at a face, and whether it lets particles go.
unsigned char read_face(TableReader& r, const FaceKey& key, size_t axis, int dimension, bool polar,
                        bool& outflow) {
  const toml::node* written = r.written(key);
  if (written && written->is_array()) {
    const std::vector<std::string> allowed(axis_names.begin(), axis_names.begin() + dimension);
    if (written->as_array()->empty()) r.fail(key, "must name a component; an open face is 'open'");
    int mask = 0;
    for (const auto& component : r.words(key, allowed)) mask |= 1 << (component[0] - 'x');
    return static_cast<unsigned char>(mask);
  }
  // Components are along x, y and z; the normal of a face of constant r or theta is not.
  const bool no_roller = polar && axis < 2;
  if (no_roller && written && written->value<std::string>() == "roller")
    r.fail(key,
           "must be 'open', 'outflow', 'fixed' or a list of fixed components such as [\"y\"]: a roller "
           "needs a face across x, y or z");
  const std::string kind =
      r.read(key.only(no_roller ? std::vector<std::string>{"open", "outflow", "fixed"} : key.words));
  outflow = kind == "outflow";
  if (kind == "roller") return static_cast<unsigned char>(1 << axis);
  return static_cast<unsigned char>(kind == "fixed" ? (1 << dimension) - 1 : 0);
}

}  // namespace

const FaceKey& FaceKeys::face(const GridSpec& grid, size_t axis, size_t side) const {
  if (grid.polar && axis == 0) return side == 0 ? r_min : r_max;
  if (grid.polar && axis == 1) return side == 0 ? theta_min : theta_max;
  if (axis == 0) return side == 0 ? x_min : x_max;
  if (axis == 1) return side == 0 ? y_min : y_max;
  return side == 0 ? z_min : z_max;
}

KeyList FaceKeys::others(const GridSpec& grid, int dimension) const {
  KeyList left = keys();
  for (size_t axis = 0; axis < static_cast<size_t>(dimension); ++axis)
    for (const size_t side : {0, 1}) left.erase(std::find(left.begin(), left.end(), &face(grid, axis, side)));
  return left;
}

GridSpec read_grid(TableReader r, int dimension) {
  const auto& keys = grid_keys;
  const bool rectilinear = r.has(keys.x) || r.has(keys.y) || r.has(keys.z), polar = r.has(keys.polar);
  const bool uniform = r.has(keys.lower) || r.has(keys.upper) || r.has(keys.spacing);
  if (int(rectilinear) + int(polar) + int(uniform) > 1) {
    const auto first = r.source().begin();
    r.fail(first->second, std::string(first->first.str()),
           "a grid has either lower, upper and spacing, or node coordinates x (y, z), or polar");
  }
  GridSpec grid = polar         ? read_polar(r, dimension)
                  : rectilinear ? read_rectilinear(r, dimension)
                                : read_uniform(r, dimension);
  const Key& coordinates = polar         ? static_cast<const Key&>(keys.polar)
                           : rectilinear ? static_cast<const Key&>(keys.x)
                                         : keys.lower;
  refuse_coarse_coordinates(r, coordinates, grid, dimension);
  r.finish();
  return grid;
}

FaceSpec read_faces(TableReader r, int dimension, const GridSpec& grid) {
  FaceSpec faces;
  for (size_t axis = 0; axis < static_cast<size_t>(dimension); ++axis)
    for (size_t side = 0; side < 2; ++side)
      faces.fixed[axis][side] = read_face(r, face_keys.face(grid, axis, side), axis, dimension, grid.polar,
                                          faces.outflow[axis][side]);
  r.finish();
  return faces;
}

}  // namespace vsb::app
