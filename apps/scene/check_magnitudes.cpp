// SPDX-License-Identifier: BSD-3-Clause
#include "scene/check_magnitudes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "scene/limits.hpp"

namespace vsb::app {

namespace {

/// Of the least of a body's particles, about: m, m^2 or m^3.
double particle_volume(const Scene& scene, const BodySpec& body) {
  if (const auto* rings = std::get_if<ConcentricLattice>(&body.lattice)) {
    const double dr = (rings->outer_radius - rings->inner_radius) / rings->rings;
    const double width = (rings->inner_radius + 0.5 * dr) * (rings->last_angle - rings->first_angle);
    const double height = scene.dimension == 3 ? (rings->upper - rings->lower) / rings->layers : 1;
    return dr * width / rings->per_ring * height;
  }
  double volume = 1;
  for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i) {
    const double edge =
        scene.grid.mapped() ? shortest_edge(scene.grid, scene.dimension) : scene.grid.spacing[i];
    const auto* uniform = std::get_if<UniformLattice>(&body.lattice);
    volume *=
        uniform ? uniform->spacing[i] : edge / std::get<CellLattice>(body.lattice).particles_per_cell[i];
  }
  return volume;
}

class Checker {
 public:
  Checker(bool single_precision, const TableReader& document) : document_(document) {
    if (!single_precision) return;
    least_ = std::numeric_limits<float>::min();
    most_ = std::numeric_limits<float>::max();
    precision_ = "float";
  }

  /// `key` is one of the document, to which the message points.
  void check(const std::string& key, const std::string& what, double value) const {
    const double size = std::abs(value);
    if (value == 0 || (size >= least_ && size <= most_)) return;
    fail(key, what, value);
  }
  /// The same of a number that is not 0 unless it is too small.
  void check_positive(const std::string& key, const std::string& what, double value) const {
    if (!(value >= least_ && value <= most_)) fail(key, what, value);
  }

 private:
  [[noreturn]] void fail(const std::string& key, const std::string& what, double value) const {
    document_.fail(*document_.source().get(key), key,
                   fmt::format("{} is {:.3g}; precision = \"{}\" computes with numbers from {:.2g} to {:.2g}",
                               what, value, precision_, least_, most_));
  }

  const TableReader& document_;
  double least_ = std::numeric_limits<double>::min(), most_ = std::numeric_limits<double>::max();
  const char* precision_ = "double";
};

/// Of exact solutions, which take squares in double precision.
struct ComparisonChecker {
  const Checker& run;
  Checker of_double;

  void operator()(const std::monostate&) const {}
  void operator()(const ColumnComparison& c) const {
    positive("the length", c.length);
    positive("the traction", std::abs(c.traction));
  }
  void operator()(const CylinderComparison& c) const {
    ring(c);
    for (const Point& point : {c.center, c.moved})
      for (const double x : point) any("a coordinate", x);
  }
  void operator()(const YieldingCylinderComparison& c) const { ring(c); }
  void operator()(const HenckyWallComparison& c) const {
    ring(c);
    for (const double x : c.center) any("a coordinate", x);
  }
  void operator()(const EllipseComparison& c) const {
    positive("a semi-axis", c.semi_major);
    positive("a semi-axis", c.semi_minor);
    any("the pressure", c.pressure);
    any("the far stress", c.far_stress);
    any("the far stress", c.far_stress * c.far_ratio);
  }

 private:
  template <class Ring>
  void ring(const Ring& c) const {
    positive("the inner radius", c.inner_radius);
    positive("the outer radius", c.outer_radius);
    positive("the pressure", c.pressure);
  }
  void any(const std::string& what, double value) const {
    if (value != 0) positive(what, std::abs(value));
  }
  void positive(const std::string& what, double value) const {
    run.check_positive("compare", what, value);
    of_double.check_positive("compare", "the square of " + what, value * value);
  }
};

}  // namespace

void check_magnitudes(const Scene& scene, const TableReader& document) {
  const Checker checker(scene.single_precision, document);
  const auto box = bounding_box(scene.grid, scene.dimension);
  for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i) {
    checker.check("grid", "a coordinate", box.lower[i]);
    checker.check("grid", "a coordinate", box.upper[i]);
    checker.check("gravity", "a component", scene.gravity[i]);
  }
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    const auto& body = scene.bodies[b];
    const std::string name = fmt::format("body[{}]: ", b);
    const double volume = particle_volume(scene, body);
    checker.check_positive("body", name + "the modulus in uniaxial strain",
                           constrained_modulus(body.material));
    checker.check_positive("body", name + "the volume of a particle", volume);
    checker.check_positive("body", name + "the mass of a particle", body.density * volume);
    for (const Point& x : {box.lower, box.upper}) {
      for (const double v : body.velocity.at(x)) checker.check("body", name + "a velocity", v);
      for (const double s : body.stress.at(x)) checker.check("body", name + "a stress", s);
    }
  }
  for (size_t k = 0; k < scene.tractions.size(); ++k)
    checker.check("traction", fmt::format("traction[{}]: a stress", k),
                  largest_stress(scene.tractions[k].field, box.lower, box.upper));
  checker.check_positive("time", "the time step dt", scene.time.dt);
  checker.check("time", "the time at the last step", scene.time.dt * static_cast<double>(scene.time.steps));
}

void check_comparison(const Scene& scene, const TableReader& document) {
  const Checker checker(scene.single_precision, document);
  std::visit(ComparisonChecker{checker, Checker(false, document)}, scene.compare);
}

}  // namespace vsb::app
