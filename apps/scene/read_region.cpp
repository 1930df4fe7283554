// SPDX-License-Identifier: BSD-3-Clause
#include "scene/read_region.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "scene/inclined_cylinder.hpp"

namespace vsb::app {

namespace {

Point point_of(const std::vector<double>& values) {
  Point p{};
  std::copy(values.begin(), values.end(), p.begin());
  return p;
}

Region parse(const toml::node& node, const TableReader& parent, const std::string& key, int dimension);

std::vector<Region> parse_parts(const toml::node& node, const TableReader& parent, const std::string& key,
                                int dimension, size_t at_least) {
  const auto* array = node.as_array();
  if (!array || array->size() < at_least)
    parent.fail(node, key, fmt::format("must be an array of at least {} shapes", at_least));
  std::vector<Region> parts;
  for (size_t i = 0; i < array->size(); ++i)
    parts.push_back(parse(*array->get(i), parent, fmt::format("{}[{}]", key, i), dimension));
  return parts;
}

/// Of a table of numbers. `key` is the path of `value` in the table `parent`.
Region parse_simple(const Key& kind, const toml::node& value, const TableReader& parent,
                    const std::string& key, int dimension) {
  const auto* table = value.as_table();
  if (!table) parent.fail(value, key, "must be a table");
  ResolvedTable unused;
  TableReader r(*table, parent.name(key), unused, *kind.inside);
  const auto d = static_cast<size_t>(dimension);
  const auto vector = [&](const NumbersKey& numbers) { return point_of(r.read(numbers.of(d))); };
  if (&kind == &shape_keys.box) {
    const Point lower = vector(box_keys.lower), upper = vector(box_keys.upper);
    for (size_t i = 0; i < d; ++i)
      if (!(upper[i] > lower[i]))
        parent.fail(value, key, "'upper' must be greater than 'lower' in every direction");
    return box(dimension, lower, upper);
  }
  if (&kind == &shape_keys.ball || &kind == &shape_keys.disc) {
    const bool disc = &kind == &shape_keys.disc;
    if (disc && dimension != 2) parent.fail(value, key, "a disc is for dimension 2; use ball or cylinder");
    const auto& keys = disc ? disc_keys : ball_keys;
    const Point center = vector(keys.center);
    return ball(center, r.read(keys.radius));
  }
  if (&kind == &shape_keys.cylinder) {
    const auto& keys = cylinder_keys;
    if (dimension != 3) parent.fail(value, key, "a cylinder is for dimension 3; use disc");
    const bool inclined = r.has(keys.axis) && r.written(keys.axis)->is_array();
    const Point direction = inclined ? vector(keys.direction) : Point{};
    if (inclined && direction == Point{}) parent.fail(value, key, "the axis must not be zero");
    const std::string axis = inclined ? "" : r.read(keys.axis);
    const Point center = vector(keys.center);
    const double radius = r.read(keys.radius);
    const double unlimited = std::numeric_limits<double>::max();
    const double lower = r.read(keys.lower, -unlimited);
    const double upper = r.read(keys.upper, unlimited);
    if (!(upper > lower)) parent.fail(value, key, "'upper' must be greater than 'lower'");
    if (inclined) return inclined_cylinder(direction, center, radius, lower, upper);
    return cylinder(axis[0] - 'x', center, radius, lower, upper);
  }
  if (&kind == &shape_keys.ellipse || &kind == &shape_keys.ellipsoid) {
    const bool ellipse = &kind == &shape_keys.ellipse;
    if (ellipse && dimension != 2) parent.fail(value, key, "an ellipse is for dimension 2; use ellipsoid");
    const auto& keys = ellipse ? ellipse_shape_keys : ellipsoid_keys;
    const Point center = vector(keys.center);
    return ellipsoid(dimension, center, vector(keys.semi_axes));
  }
  const Point on = vector(half_space_keys.point), normal = vector(half_space_keys.normal);
  if (normal == Point{}) parent.fail(value, key, "the normal must not be zero");
  return half_space(on, normal);
}

Region parse(const toml::node& node, const TableReader& parent, const std::string& key, int dimension) {
  const auto kinds = names_of(shape_keys.keys());
  const std::string what = fmt::format("must be a table with one shape: {}", fmt::join(kinds, ", "));
  const auto* table = node.as_table();
  if (!table || table->size() != 1) parent.fail(node, key, what);
  const std::string name(table->begin()->first.str());
  const toml::node& value = table->begin()->second;
  const auto found = std::find(kinds.begin(), kinds.end(), name);
  if (found == kinds.end())
    parent.fail(node, key, fmt::format("unknown shape '{}'{} ({})", name, did_you_mean(name, kinds), what));
  const Key& kind = *shape_keys.keys()[static_cast<size_t>(found - kinds.begin())];
  const std::string inner_key = key + "." + name;
  if (&kind == &shape_keys.all_of) return union_of(parse_parts(value, parent, inner_key, dimension, 1));
  if (&kind == &shape_keys.common)
    return intersection_of(parse_parts(value, parent, inner_key, dimension, 1));
  if (&kind == &shape_keys.difference)
    return difference_of(parse_parts(value, parent, inner_key, dimension, 2));
  return parse_simple(kind, value, parent, inner_key, dimension);
}

}  // namespace

Region read_region(TableReader& reader, const ShapeKey& key, int dimension, bool optional) {
  const toml::node* node = reader.node(key);
  if (node) return parse(*node, reader, key.name, dimension);
  if (!optional)
    reader.missing(key, fmt::format("a shape: {}", fmt::join(names_of(shape_keys.keys()), ", ")));
  return everywhere();
}

}  // namespace vsb::app
