// SPDX-License-Identifier: BSD-3-Clause
#include "run/comparison.hpp"

#include <cmath>
#include <vsb/physics/exact_column.hpp>
#include <vsb/physics/exact_cylinder.hpp>
#include <vsb/physics/exact_ellipse.hpp>
#include <vsb/physics/linear_elastic.hpp>

namespace vsb::app {

namespace {

/// Root mean square with weights: sqrt(sum w d^2 / sum w), the form of Eqs. (30)-(33).
class Norm {
 public:
  void add(double difference, double weight) {
    sum_ += weight * difference * difference;
    weight_ += weight;
  }
  double value() const { return std::sqrt(sum_ / weight_); }

 private:
  double sum_ = 0, weight_ = 0;
};

/// Eqs. (30), (31): particles count alike, lengths over L0, stresses over the traction. e_u is against (A1)
/// as printed, as in Table 2; e_u_exact against the solution that the paper's own volumes imply.
ComparisonResult compare(const ColumnComparison& c, const Scene& scene, const Snapshot& s) {
  const auto& m = scene.bodies.front().material;
  const auto elastic = LinearElastic<double>::from_young(m.youngs_modulus, m.poisson_ratio);
  const ExactColumn<double> solution{c.traction, elastic.constrained_modulus()};
  Norm printed, exact, stress;
  ComparisonResult result;
  result.exact.displacement.assign(3 * s.count(), 0.0);
  result.exact.cauchy_stress.assign(6 * s.count(), 0.0);
  for (size_t p = 0; p < s.count(); ++p) {
    const double x0 = s.initial_position[3 * p] - scene.grid.lower[0];
    const double u = s.position[3 * p] - s.initial_position[3 * p];
    printed.add((solution.displacement_as_printed(x0) - u) / c.length, 1);
    exact.add((solution.displacement(x0) - u) / c.length, 1);
    stress.add((solution.stress() - s.cauchy_stress[6 * p]) / c.traction, 1);
    result.exact.displacement[3 * p] = solution.displacement(x0);
    result.exact.cauchy_stress[6 * p] = solution.stress();
  }
  result.errors = {{"e_u", printed.value()}, {"e_u_exact", exact.value()}, {"e_sigma", stress.value()}};
  return result;
}

Vector<2, double> in_plane(const std::vector<double>& vectors, size_t p) {
  return {{vectors[3 * p], vectors[3 * p + 1]}};
}

/// Components xx, yy, zz, xy.
SymmetricTensor<2, double> in_plane_stress(const Snapshot& s, size_t p) {
  SymmetricTensor<2, double> stress;
  for (size_t c = 0; c < 4; ++c) stress[static_cast<int>(c)] = s.cauchy_stress[6 * p + c];
  return stress;
}

void store(const SymmetricTensor<2, double>& stress, std::vector<double>& to, size_t p) {
  for (size_t c = 0; c < 4; ++c) to[6 * p + c] = stress[static_cast<int>(c)];
}

/// Eqs. (32), (33): particles count by volume, lengths over a, stresses over p_i; at current positions. e_u
/// is of the radial displacement.
ComparisonResult compare(const CylinderComparison& c, const Scene& scene, const Snapshot& s) {
  const auto& m = scene.bodies.front().material;
  const ExactCylinder<double> solution{c.inner_radius, c.outer_radius, c.pressure, m.youngs_modulus,
                                       m.poisson_ratio};
  Norm rr, tt, u;
  double hoop = 0, exact_hoop = 0;
  ComparisonResult result;
  result.exact.displacement.assign(3 * s.count(), 0.0);
  result.exact.cauchy_stress.assign(6 * s.count(), 0.0);
  for (size_t p = 0; p < s.count(); ++p) {
    const auto x = in_plane(s.position, p), x0 = in_plane(s.initial_position, p);
    const double r = std::sqrt(dot(x, x)), V = s.volume[p];
    const auto exact = solution.stress(r);
    const auto ours = to_polar(in_plane_stress(s, p), x[0], x[1]);
    rr.add((exact.rr - ours.rr) / c.pressure, V);
    tt.add((exact.tt - ours.tt) / c.pressure, V);
    hoop += V * ours.tt;
    exact_hoop += V * exact.tt;
    u.add((solution.radial_displacement(r) - dot(x - x0, x) / r) / c.inner_radius, V);
    for (size_t i = 0; i < 2; ++i)
      result.exact.displacement[3 * p + i] = solution.radial_displacement(r) * x[static_cast<int>(i)] / r;
    auto cartesian = from_polar<2>(exact, x[0], x[1]);
    cartesian[2] = m.poisson_ratio * (exact.rr + exact.tt);
    store(cartesian, result.exact.cauchy_stress, p);
  }
  result.errors = {{"e_rr", rr.value()}, {"e_tt", tt.value()}, {"e_u", u.value()}};
  result.figures = {{"hoop_ratio", hoop / exact_hoop}};  // of the mean hoop stresses
  return result;
}

/// Eq. (33) for the Cartesian components.
ComparisonResult compare(const EllipseComparison& c, const Scene& scene, const Snapshot& s) {
  const ExactEllipse<double> solution{c.semi_major, c.semi_minor,
                                      c.pressure,   c.far_stress,
                                      c.far_ratio,  scene.bodies.front().material.poisson_ratio};
  Norm xx, yy, xy;
  ComparisonResult result;
  result.exact.cauchy_stress.assign(6 * s.count(), 0.0);
  for (size_t p = 0; p < s.count(); ++p) {
    const auto exact = solution.stress(in_plane(s.position, p));
    const auto difference = exact - in_plane_stress(s, p);
    const double V = s.volume[p];
    xx.add(difference(0, 0) / c.pressure, V);
    yy.add(difference(1, 1) / c.pressure, V);
    xy.add(difference(0, 1) / c.pressure, V);
    store(exact, result.exact.cauchy_stress, p);
  }
  result.errors = {{"e_xx", xx.value()}, {"e_yy", yy.value()}, {"e_xy", xy.value()}};
  return result;
}

ComparisonResult compare(const std::monostate&, const Scene&, const Snapshot&) {
  return {};
}

}  // namespace

std::vector<std::string> comparison_figure_names(const Comparison& comparison) {
  if (std::holds_alternative<CylinderComparison>(comparison)) return {"hoop_ratio"};
  return {};
}

ComparisonResult compare_with_exact(const Scene& scene, const Snapshot& snapshot) {
  return std::visit([&](const auto& c) { return compare(c, scene, snapshot); }, scene.compare);
}

}  // namespace vsb::app
