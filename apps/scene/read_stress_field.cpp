// SPDX-License-Identifier: BSD-3-Clause
#include "scene/read_stress_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/read_affine.hpp"

namespace vsb::app {

const std::vector<std::string> stress_field_keys = {
    "pressure", "stress", "affine", "hydrostatic", "radial_blend", "planar_blend", "exact_ellipse"};
const std::vector<std::string> ellipse_keys = {"semi_major", "semi_minor", "pressure", "far_stress",
                                               "far_ratio"};

EllipseSpec read_ellipse(TableReader& r) {
  EllipseSpec e{};
  e.semi_major = r.number("semi_major", Range::positive(), {}, "m, along x");
  e.semi_minor = r.number("semi_minor", Range::positive(), {}, "m");
  e.pressure = r.number("pressure", Range::positive(), {}, "Pa in the hole, positive in compression");
  e.far_stress = r.number("far_stress", Range::any(), {}, "Pa, -sigma_yy far away");
  e.far_ratio = r.number("far_ratio", Range::any(), {}, "K = sigma_xx / sigma_yy far away");
  return e;
}

namespace {

Point point_of(const std::vector<double>& values) {
  Point p{};
  std::copy(values.begin(), values.end(), p.begin());
  return p;
}

/// A uniform stress: a pressure, or six components.
Stress6 read_stress(TableReader& r, const std::string& others = "") {
  Stress6 stress{};
  if (r.has("pressure") && r.has("stress"))
    r.fail(*r.source().get("stress"), "stress", "give one of pressure, stress");
  if (r.has("stress")) {
    const auto s = r.numbers("stress", 6, Range::any(), {},
                             "Pa, virtual stress, tension positive: xx yy zz xy yz xz; or pressure" + others);
    std::copy(s.begin(), s.end(), stress.begin());
  } else {
    const double p = r.number("pressure", Range::any(), {},
                              "Pa, positive in compression; or stress (xx yy zz xy yz xz)" + others);
    stress = {-p, -p, -p, 0, 0, 0};
  }
  return stress;
}

/// The distance of the first body's particles along an axis, about.
double particle_spacing(const Scene& scene, size_t axis) {
  const auto& lattice = scene.bodies.front().lattice;
  if (const auto* uniform = std::get_if<UniformLattice>(&lattice)) return uniform->spacing[axis];
  if (const auto* rings = std::get_if<ConcentricLattice>(&lattice))
    return (rings->outer_radius - rings->inner_radius) / rings->rings;
  const double h =
      scene.grid.mapped() ? shortest_edge(scene.grid, scene.dimension) : scene.grid.spacing[axis];
  return h / std::get<CellLattice>(lattice).particles_per_cell[axis];
}

HydrostaticSpec read_hydrostatic(TableReader r, const Scene& scene) {
  const auto d = static_cast<size_t>(scene.dimension);
  HydrostaticSpec h{};
  r.allow_only({"unit_weight", "level", "up", "width"});
  h.unit_weight = r.number("unit_weight", Range::positive(), {}, "N/m^3, of the fluid");
  h.level = r.number("level", Range::any(), {}, "m, of the free surface along 'up'");
  std::vector<double> up(d, 0.0);
  up.back() = 1;
  up = r.numbers("up", d, Range::any(), up, "direction");
  double length = 0;
  size_t steepest = 0;
  for (size_t i = 0; i < d; ++i) {
    length = std::hypot(length, up[i]);
    if (std::abs(up[i]) > std::abs(up[steepest])) steepest = i;
  }
  if (!(length > 0)) r.fail(*r.source().get("up"), "up", "the direction must not be zero");
  for (size_t i = 0; i < d; ++i) h.up[i] = up[i] / length;
  h.width = r.number("width", Range::at_least(0), particle_spacing(scene, steepest),
                     "m, over which the kink at the free surface is averaged: the particles' spacing");
  r.finish();
  return h;
}

RadialBlendSpec read_radial_blend(TableReader r, const Scene& scene) {
  RadialBlendSpec b{};
  std::vector<std::string> keys = {"center", "inner", "outer"};
  if (scene.dimension == 3) keys.emplace_back("axis");
  r.allow_only(keys);
  b.center = point_of(r.numbers("center", static_cast<size_t>(scene.dimension), Range::any(), {}, "m"));
  b.axis = -1;
  if (scene.dimension == 3) {
    const std::string axis = r.choice("axis", {"none", "x", "y", "z"});
    b.axis = axis == "none" ? -1 : axis[0] - 'x';
  }
  const auto side = [&](const char* key, double& radius, const Range& range, Stress6& stress) {
    if (!r.has(key)) r.missing(key, "a table with radius, and pressure or stress");
    TableReader t = r.table(key);
    t.allow_only({"radius", "pressure", "stress"});
    radius = t.number("radius", range, {}, "m");
    stress = read_stress(t);
    t.finish();
  };
  side("inner", b.inner_radius, Range::at_least(0), b.inner);
  side("outer", b.outer_radius, {b.inner_radius, Range::any().max, true, false}, b.outer);
  r.finish();
  return b;
}

PlanarBlendSpec read_planar_blend(TableReader r, const Scene& scene) {
  PlanarBlendSpec b{};
  r.allow_only({"start", "end"});
  const auto side = [&](const char* key, Point& point, Stress6& stress) {
    if (!r.has(key)) r.missing(key, "a table with point, and pressure or stress");
    TableReader t = r.table(key);
    t.allow_only({"point", "pressure", "stress"});
    point = point_of(t.numbers("point", static_cast<size_t>(scene.dimension), Range::any(), {},
                               "m; the planes are normal to the line between the two points"));
    stress = read_stress(t);
    t.finish();
  };
  side("start", b.start, b.at_start);
  side("end", b.end, b.at_end);
  if (b.start == b.end) r.fail(*r.source().get("end"), "end", "its point must not be that of 'start'");
  r.finish();
  return b;
}

}  // namespace

StressFieldSpec read_stress_field(TableReader& r, const Scene& scene) {
  std::vector<std::string> given;
  std::copy_if(stress_field_keys.begin(), stress_field_keys.end(), std::back_inserter(given),
               [&](const auto& key) { return r.has(key); });
  if (given.size() > 1)
    r.fail(*r.source().get(given[1]), given[1],
           fmt::format("beside '{}': give one of {}", given[0], fmt::join(stress_field_keys, ", ")));
  if (given.empty())
    r.missing("pressure",
              fmt::format("a number in Pa; or one of {}",
                          fmt::join(stress_field_keys.begin() + 1, stress_field_keys.end(), ", ")));
  if (r.has("affine"))
    return read_affine_table<6>(r.table("affine"), 6, scene.dimension,
                                "Pa, tension positive: xx yy zz xy yz xz");
  if (r.has("hydrostatic")) return read_hydrostatic(r.table("hydrostatic"), scene);
  if (r.has("radial_blend")) return read_radial_blend(r.table("radial_blend"), scene);
  if (r.has("planar_blend")) return read_planar_blend(r.table("planar_blend"), scene);
  if (r.has("exact_ellipse")) {
    if (scene.dimension != 2)
      r.fail(*r.source().get("exact_ellipse"), "exact_ellipse", "is a field of plane strain, dimension = 2");
    TableReader e = r.table("exact_ellipse");
    e.allow_only(ellipse_keys);
    const auto ellipse = read_ellipse(e);
    e.finish();
    return ellipse;
  }
  return read_stress(r, ", or affine, hydrostatic, radial_blend, planar_blend, or exact_ellipse");
}

double largest_stress(const StressFieldSpec& field, const Point& lower, const Point& upper) {
  const auto largest = [](const Stress6& stress) {
    double most = 0;
    for (const double s : stress) most = std::max(most, std::abs(s));
    return most;
  };
  const auto at_corners = [&](const auto& value_at) {
    double most = 0;
    for (unsigned corner = 0; corner < 8; ++corner) {
      Point x;
      for (size_t i = 0; i < 3; ++i) x[i] = corner >> i & 1 ? upper[i] : lower[i];
      most = std::max(most, value_at(x));
    }
    return most;
  };
  return std::visit(
      Overloaded{
          [&](const Stress6& stress) { return largest(stress); },
          [&](const Affine<Stress6>& affine) {
            return at_corners([&](const Point& x) { return largest(affine.at(x)); });
          },
          [&](const HydrostaticSpec& h) {
            return at_corners([&](const Point& x) {
              return h.unit_weight * (h.level - x[0] * h.up[0] - x[1] * h.up[1] - x[2] * h.up[2]);
            });
          },
          [&](const RadialBlendSpec& b) { return std::max(largest(b.inner), largest(b.outer)); },
          [&](const PlanarBlendSpec& b) { return std::max(largest(b.at_start), largest(b.at_end)); },
          [](const EllipseSpec& e) {
            return std::max({e.pressure, std::abs(e.far_stress), std::abs(e.far_ratio * e.far_stress)});
          }},
      field);
}

}  // namespace vsb::app
