// SPDX-License-Identifier: BSD-3-Clause
#include "scene/read_stress_field.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace vsb::app {

EllipseSpec read_ellipse(TableReader& r, const EllipseKeys& keys) {
  EllipseSpec e{};
  e.semi_major = r.read(keys.semi_major);
  e.semi_minor = r.read(keys.semi_minor);
  e.pressure = r.read(keys.pressure);
  e.far_stress = r.read(keys.far_stress);
  e.far_ratio = r.read(keys.far_ratio);
  return e;
}

namespace {

Point point_of(const std::vector<double>& values) {
  Point p{};
  std::copy(values.begin(), values.end(), p.begin());
  return p;
}

/// A uniform stress: a pressure, or six components. `others`: what else the table may have in their place.
Stress6 read_stress(TableReader& r, const StressKeys& keys, const std::vector<std::string>& others = {}) {
  Stress6 stress{};
  if (r.has(keys.pressure) && r.has(keys.stress)) r.fail(keys.stress, "give one of pressure, stress");
  const auto told = [&](const auto& key) {
    if (others.empty()) return key;
    return remarked(
        key, fmt::format("or {}, or {}", fmt::join(others.begin(), others.end() - 1, ", "), others.back()));
  };
  if (r.has(keys.stress)) {
    const auto s = r.read(told(keys.stress));
    std::copy(s.begin(), s.end(), stress.begin());
  } else {
    const double p = r.read(told(keys.pressure));
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
  const auto& keys = hydrostatic_keys;
  HydrostaticSpec h{};
  h.unit_weight = r.read(keys.unit_weight);
  h.level = r.read(keys.level);
  std::vector<double> up(d, 0.0);
  up.back() = 1;
  up = r.read(keys.up.of(d), up);
  double length = 0;
  size_t steepest = 0;
  for (size_t i = 0; i < d; ++i) {
    length = std::hypot(length, up[i]);
    if (std::abs(up[i]) > std::abs(up[steepest])) steepest = i;
  }
  if (!(length > 0)) r.fail(keys.up, "the direction must not be zero");
  for (size_t i = 0; i < d; ++i) h.up[i] = up[i] / length;
  h.width = r.read(keys.width, particle_spacing(scene, steepest));
  r.finish();
  return h;
}

/// One end of a blend: its position, and the stress there.
template <class Keys, class Position>
void read_blend_end(TableReader& r, const Key& key, const Keys& keys, const char* coordinates,
                    const Position& read_position, Stress6& stress) {
  if (!r.has(key)) r.missing(key, fmt::format("a table with {}, and pressure or stress", coordinates));
  TableReader t = r.table(key);
  read_position(t, keys);
  stress = read_stress(t, keys.uniform);
  t.finish();
}

RadialBlendSpec read_radial_blend(TableReader r, const Scene& scene) {
  const auto& keys = radial_blend_keys;
  RadialBlendSpec b{};
  b.center = point_of(r.read(keys.center.of(static_cast<size_t>(scene.dimension))));
  b.axis = -1;
  if (scene.dimension == 3) {
    const std::string axis = r.read(keys.axis);
    b.axis = axis == "none" ? -1 : axis[0] - 'x';
  }
  read_blend_end(
      r, keys.inner, blend_inner_keys, "radius",
      [&](TableReader& t, const auto& of) { b.inner_radius = t.read(of.radius); }, b.inner);
  read_blend_end(
      r, keys.outer, blend_outer_keys, "radius",
      [&](TableReader& t, const auto& of) {
        b.outer_radius = t.read(of.radius.within(Range::above(b.inner_radius)));
      },
      b.outer);
  r.finish();
  return b;
}

PlanarBlendSpec read_planar_blend(TableReader r, const Scene& scene) {
  const auto& keys = planar_blend_keys;
  PlanarBlendSpec b{};
  const auto point = [&](Point& to) {
    return [&](TableReader& t, const auto& of) {
      to = point_of(t.read(of.point.of(static_cast<size_t>(scene.dimension))));
    };
  };
  read_blend_end(r, keys.start, blend_start_keys, "point", point(b.start), b.at_start);
  read_blend_end(r, keys.end, blend_end_keys, "point", point(b.end), b.at_end);
  if (b.start == b.end) r.fail(keys.end, "its point must not be that of 'start'");
  r.finish();
  return b;
}

}  // namespace

StressFieldSpec read_stress_field(TableReader& r, const StressFieldKeys& keys, const Scene& scene) {
  const auto all = keys.all();
  const auto names = names_of(all);
  KeyList given;
  std::copy_if(all.begin(), all.end(), std::back_inserter(given),
               [&](const Key* key) { return r.has(*key); });
  if (given.size() > 1)
    r.fail(*given[1], fmt::format("beside '{}': give one of {}", given[0]->name, fmt::join(names, ", ")));
  if (given.empty())
    r.missing(keys.uniform.pressure,
              fmt::format("a number in Pa; or one of {}", fmt::join(names.begin() + 1, names.end(), ", ")));
  if (r.has(keys.affine))
    return read_affine_table<6>(r.table(keys.affine, affine_stress_keys.beyond(scene.dimension)),
                                affine_stress_keys, 6, scene.dimension);
  if (r.has(keys.hydrostatic)) return read_hydrostatic(r.table(keys.hydrostatic), scene);
  if (r.has(keys.radial_blend)) {
    const KeyList axis = {&radial_blend_keys.axis};
    return read_radial_blend(r.table(keys.radial_blend, scene.dimension == 3 ? KeyList() : axis), scene);
  }
  if (r.has(keys.planar_blend)) return read_planar_blend(r.table(keys.planar_blend), scene);
  if (r.has(keys.exact_ellipse)) {
    if (scene.dimension != 2) r.fail(keys.exact_ellipse, "is a field of plane strain, dimension = 2");
    TableReader e = r.table(keys.exact_ellipse);
    const auto ellipse = read_ellipse(e, exact_ellipse_keys.ellipse);
    e.finish();
    return ellipse;
  }
  return read_stress(r, keys.uniform, {names.begin() + 2, names.end()});
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
