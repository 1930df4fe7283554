// SPDX-License-Identifier: BSD-3-Clause
#include "scene/read_region.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

#include "scene/inclined_cylinder.hpp"

namespace vsb::app {

namespace {

const std::vector<std::string> kinds = {"box",       "ball",       "disc",  "cylinder",     "ellipse",
                                        "ellipsoid", "half_space", "union", "intersection", "difference"};

Point point_of(const std::vector<double>& values) {
  Point p{};
  std::copy(values.begin(), values.end(), p.begin());
  return p;
}

/// So that squares, and products of two, are finite.
const Range coordinates = Range::between(-1e150, 1e150), lengths{0, 1e150, true, false};

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

Region parse_simple(const std::string& kind, TableReader& r, const toml::node& at, const TableReader& parent,
                    const std::string& key, int dimension) {
  const auto d = static_cast<size_t>(dimension);
  const auto vector = [&](const char* name) { return point_of(r.numbers(name, d, coordinates)); };
  static const std::map<std::string, std::vector<std::string>> keys = {
      {"box", {"lower", "upper"}},          {"ball", {"center", "radius"}},
      {"disc", {"center", "radius"}},       {"cylinder", {"axis", "center", "radius", "lower", "upper"}},
      {"ellipse", {"center", "semi_axes"}}, {"ellipsoid", {"center", "semi_axes"}},
      {"half_space", {"point", "normal"}}};
  r.allow_only(keys.at(kind));
  if (kind == "box") {
    const Point lower = vector("lower"), upper = vector("upper");
    for (size_t i = 0; i < d; ++i)
      if (!(upper[i] > lower[i]))
        parent.fail(at, key, "'upper' must be greater than 'lower' in every direction");
    return box(dimension, lower, upper);
  }
  if (kind == "ball" || kind == "disc") {
    if (kind == "disc" && dimension != 2)
      parent.fail(at, key, "a disc is for dimension 2; use ball or cylinder");
    const Point center = vector("center");
    return ball(center, r.number("radius", lengths));
  }
  if (kind == "cylinder") {
    if (dimension != 3) parent.fail(at, key, "a cylinder is for dimension 3; use disc");
    const bool inclined = r.source().get("axis") && r.source().get("axis")->is_array();
    const Point direction = inclined ? vector("axis") : Point{};
    if (inclined && direction == Point{}) parent.fail(at, key, "the axis must not be zero");
    const std::string axis = inclined ? "" : r.choice("axis", {"x", "y", "z"}, "z");
    const Point center = vector("center");
    const double radius = r.number("radius", lengths);
    const double unlimited = std::numeric_limits<double>::max();
    const double lower = r.number("lower", Range::any(), -unlimited);
    const double upper = r.number("upper", Range::any(), unlimited);
    if (!(upper > lower)) parent.fail(at, key, "'upper' must be greater than 'lower'");
    if (inclined) return inclined_cylinder(direction, center, radius, lower, upper);
    return cylinder(axis[0] - 'x', center, radius, lower, upper);
  }
  if (kind == "ellipse" || kind == "ellipsoid") {
    if (kind == "ellipse" && dimension != 2)
      parent.fail(at, key, "an ellipse is for dimension 2; use ellipsoid");
    const Point center = vector("center");
    return ellipsoid(dimension, center, point_of(r.numbers("semi_axes", d, lengths)));
  }
  const Point on = vector("point"), normal = vector("normal");  // half_space
  if (normal == Point{}) parent.fail(at, key, "the normal must not be zero");
  return half_space(on, normal);
}

Region parse(const toml::node& node, const TableReader& parent, const std::string& key, int dimension) {
  const std::string what = fmt::format("must be a table with one shape: {}", fmt::join(kinds, ", "));
  const auto* table = node.as_table();
  if (!table || table->size() != 1) parent.fail(node, key, what);
  const std::string kind(table->begin()->first.str());
  const toml::node& value = table->begin()->second;
  if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
    parent.fail(node, key, fmt::format("unknown shape '{}'{} ({})", kind, did_you_mean(kind, kinds), what));
  const std::string inner_key = key + "." + kind;
  if (kind == "union") return union_of(parse_parts(value, parent, inner_key, dimension, 1));
  if (kind == "intersection") return intersection_of(parse_parts(value, parent, inner_key, dimension, 1));
  if (kind == "difference") return difference_of(parse_parts(value, parent, inner_key, dimension, 2));
  const auto* inner = value.as_table();
  if (!inner) parent.fail(value, inner_key, "must be a table");
  ResolvedTable unused;
  TableReader r(*inner, parent.name(inner_key), unused);
  Region region = parse_simple(kind, r, value, parent, inner_key, dimension);
  r.finish();
  return region;
}

}  // namespace

Region read_region(TableReader& reader, const std::string& key, int dimension, bool optional) {
  const toml::node* node = reader.node(key);
  if (node) return parse(*node, reader, key, dimension);
  if (!optional) reader.missing(key, fmt::format("a shape: {}", fmt::join(kinds, ", ")));
  return everywhere();
}

}  // namespace vsb::app
