// SPDX-License-Identifier: BSD-3-Clause
#include "report/comparison.hpp"

#include <cmath>
#include <map>
#include <vsb/physics/exact_column.hpp>
#include <vsb/physics/exact_cylinder.hpp>
#include <vsb/physics/exact_ellipse.hpp>
#include <vsb/physics/exact_hencky_wall.hpp>
#include <vsb/physics/linear_elastic.hpp>
#include "report/cell_means.hpp"
#include "report/yielding_cylinder.hpp"

namespace vsb::app {

namespace {

/// Root mean square with weights: sqrt(sum w d^2 / sum w), the form of Eq. (30) to Eq. (33).
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

/// By name of the error, without a suffix.
using Norms = std::map<std::string, Norm>;
using Figures = std::vector<std::pair<std::string, double>>;

/// Stresses at positions, each with its weight in a norm.
struct Samples {
  const std::vector<double>& position;       ///< [3 per sample], m
  const std::vector<double>& cauchy_stress;  ///< [6 per sample], Pa
  const std::vector<double>& weight;         ///< [1 per sample]
};

Vector<2, double> in_plane(const std::vector<double>& vectors, size_t p) {
  return {{vectors[3 * p], vectors[3 * p + 1]}};
}

/// Components xx, yy, zz, xy.
SymmetricTensor<2, double> in_plane_stress(const std::vector<double>& stresses, size_t p) {
  SymmetricTensor<2, double> stress;
  for (size_t c = 0; c < 4; ++c) stress[static_cast<int>(c)] = stresses[6 * p + c];
  return stress;
}

void store(const SymmetricTensor<2, double>& stress, std::vector<double>& to, size_t p) {
  for (size_t c = 0; c < 4; ++c) to[6 * p + c] = stress[static_cast<int>(c)];
}

/// A particle's position relative to the axis of a cylinder that has been carried to where it is now.
Vector<2, double> from_axis(const CylinderComparison& c, const std::vector<double>& position, size_t p) {
  return in_plane(position, p) - Vector<2, double>{{c.center[0] + c.moved[0], c.center[1] + c.moved[1]}};
}

ExactColumn<double> solution_of(const ColumnComparison& c, const Scene& scene) {
  const auto& m = scene.bodies.front().material;
  const auto elastic = LinearElastic<double>::from_young(m.youngs_modulus, m.poisson_ratio);
  return {c.traction, elastic.constrained_modulus()};
}
ExactCylinder<double> solution_of(const CylinderComparison& c, const Scene& scene) {
  const auto& m = scene.bodies.front().material;
  return {c.inner_radius, c.outer_radius, c.pressure, m.youngs_modulus, m.poisson_ratio};
}
ExactEllipse<double> solution_of(const EllipseComparison& c, const Scene& scene) {
  return {c.semi_major, c.semi_minor, c.pressure,
          c.far_stress, c.far_ratio,  scene.bodies.front().material.poisson_ratio};
}

/// The wall of a hole under pressure, with the radius of its hole.
class Wall {
 public:
  Wall(const HenckyWallComparison& c, const Scene& scene)
      : compared_(c),
        dimension_(static_cast<size_t>(c.dimension)),
        exact_(solution_of(c, scene)),
        hole_(exact_.hole_radius()) {}

  double hole_displacement() const { return hole_ - compared_.inner_radius; }
  /// The position relative to the centre of the p-th of some points; [2] is 0 in 2D.
  Vector<3, double> from_center(const std::vector<double>& position, size_t p) const {
    auto x = Vector<3, double>::zero();
    for (size_t i = 0; i < dimension_; ++i)
      x[static_cast<int>(i)] = position[3 * p + i] - compared_.center[i];
    return x;
  }
  ExactHenckyWall<double>::State at(double r) const { return exact_.at(r, hole_); }
  /// Radial and hoop component of a stress at x.
  PolarStress<double> components(const std::vector<double>& stresses, size_t p,
                                 const Vector<3, double>& x) const {
    SymmetricTensor<3, double> s;
    for (int c = 0; c < s.size; ++c) s[c] = stresses[6 * p + static_cast<size_t>(c)];
    double rr = 0, trace = 0;
    for (int i = 0; i < compared_.dimension; ++i) {
      trace += s(i, i);
      for (int j = 0; j < compared_.dimension; ++j) rr += x[i] * s(i, j) * x[j];
    }
    rr /= dot(x, x);
    return {rr, (trace - rr) / (compared_.dimension - 1), 0};
  }
  /// The exact stress at x.
  SymmetricTensor<3, double> stress(const Vector<3, double>& x) const {
    const auto state = at(std::sqrt(dot(x, x)));
    auto s = SymmetricTensor<3, double>::zero();
    for (int i = 0; i < 3; ++i) s[i] = i < compared_.dimension ? state.stress.tt : state.axial_stress;
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j)
        s[symmetric_index(i, j)] += (state.stress.rr - state.stress.tt) * x[i] * x[j] / dot(x, x);
    return s;
  }

 private:
  static ExactHenckyWall<double> solution_of(const HenckyWallComparison& c, const Scene& scene) {
    const auto& m = scene.bodies.front().material;
    const auto law = LinearElastic<double>::from_young(m.youngs_modulus, m.poisson_ratio);
    return {c.inner_radius, c.outer_radius, c.pressure, law.lambda, law.shear_modulus, c.dimension - 1};
  }

  const HenckyWallComparison& compared_;
  size_t dimension_;
  ExactHenckyWall<double> exact_;
  double hole_;
};

/// Eq. (31), Eq. (33): stresses over the traction or the pressure.
void add_stress_errors(const ColumnComparison& c, const Scene& scene, const Samples& s, Norms& norms) {
  const auto solution = solution_of(c, scene);
  Norm& stress = norms["e_sigma"];
  for (size_t p = 0; p < s.weight.size(); ++p)
    stress.add((solution.stress() - s.cauchy_stress[6 * p]) / c.traction, s.weight[p]);
}
void add_stress_errors(const CylinderComparison& c, const Scene& scene, const Samples& s, Norms& norms) {
  const auto solution = solution_of(c, scene);
  Norm &rr = norms["e_rr"], &tt = norms["e_tt"];
  for (size_t p = 0; p < s.weight.size(); ++p) {
    const auto x = from_axis(c, s.position, p);
    const auto exact = solution.stress(std::sqrt(dot(x, x)));
    const auto ours = to_polar(in_plane_stress(s.cauchy_stress, p), x[0], x[1]);
    rr.add((exact.rr - ours.rr) / c.pressure, s.weight[p]);
    tt.add((exact.tt - ours.tt) / c.pressure, s.weight[p]);
  }
}
void add_stress_errors(const YieldingCylinderComparison& c, const Scene& scene, const Samples& s,
                       Norms& norms) {
  const auto solution = solution_of(c, scene);
  const double rho = solution.plastic_radius();
  Norm &rr = norms["e_rr"], &tt = norms["e_tt"];
  for (size_t p = 0; p < s.weight.size(); ++p) {
    const auto x = in_plane(s.position, p);
    const auto exact = solution.stress(std::sqrt(dot(x, x)), rho);
    const auto ours = to_polar(in_plane_stress(s.cauchy_stress, p), x[0], x[1]);
    rr.add((exact.rr - ours.rr) / c.pressure, s.weight[p]);
    tt.add((exact.tt - ours.tt) / c.pressure, s.weight[p]);
  }
}
void add_stress_errors(const EllipseComparison& c, const Scene& scene, const Samples& s, Norms& norms) {
  const auto solution = solution_of(c, scene);
  Norm &xx = norms["e_xx"], &yy = norms["e_yy"], &xy = norms["e_xy"];
  for (size_t p = 0; p < s.weight.size(); ++p) {
    const auto exact = solution.stress(in_plane(s.position, p));
    const auto difference = exact - in_plane_stress(s.cauchy_stress, p);
    xx.add(difference(0, 0) / c.pressure, s.weight[p]);
    yy.add(difference(1, 1) / c.pressure, s.weight[p]);
    xy.add(difference(0, 1) / c.pressure, s.weight[p]);
  }
}

void add_stress_errors(const HenckyWallComparison& c, const Scene& scene, const Samples& s, Norms& norms) {
  const Wall wall(c, scene);
  Norm &rr = norms["e_rr"], &tt = norms["e_tt"];
  for (size_t p = 0; p < s.weight.size(); ++p) {
    const auto x = wall.from_center(s.position, p);
    const auto exact = wall.at(std::sqrt(dot(x, x))).stress, ours = wall.components(s.cauchy_stress, p, x);
    rr.add((exact.rr - ours.rr) / c.pressure, s.weight[p]);
    tt.add((exact.tt - ours.tt) / c.pressure, s.weight[p]);
  }
}

/// u / x0 of the exact solution for the body's law.
double stretching(const ColumnComparison& c, const Scene& scene) {
  const auto solution = solution_of(c, scene);
  if (scene.bodies.front().material.law != MaterialLaw::hencky) return solution.displacement(1.0);
  return ExactHenckyColumn<double>{solution.traction, solution.modulus}.displacement(1.0);
}

/// Eq. (30): particles count alike, lengths over L0. e_u is against (A1) as printed, as in Table 2; e_u_exact
/// against the solution for the body's law, which for the rate form is the one that the paper's own volumes
/// imply.
void add_displacement_errors(const ColumnComparison& c, const Scene& scene, const Snapshot& s, Norms& norms) {
  const auto solution = solution_of(c, scene);
  const double exact_ratio = stretching(c, scene);
  Norm &printed = norms["e_u"], &exact = norms["e_u_exact"];
  for (size_t p = 0; p < s.count(); ++p) {
    const double x0 = s.initial_position[3 * p] - scene.grid.lower[0];
    const double u = s.position[3 * p] - s.initial_position[3 * p];
    if (c.printed_solution) printed.add((solution.displacement_as_printed(x0) - u) / c.length, 1);
    exact.add((exact_ratio * x0 - u) / c.length, 1);
  }
}
/// Eq. (32) for the radial displacement: particles count by volume, lengths over a; at current positions.
void add_displacement_errors(const CylinderComparison& c, const Scene& scene, const Snapshot& s,
                             Norms& norms) {
  const auto solution = solution_of(c, scene);
  Norm& u = norms["e_u"];
  for (size_t p = 0; p < s.count(); ++p) {
    const auto x = from_axis(c, s.position, p),
               x0 = in_plane(s.initial_position, p) - Vector<2, double>{{c.center[0], c.center[1]}};
    const double r = std::sqrt(dot(x, x));
    u.add((solution.radial_displacement(r) - dot(x - x0, x) / r) / c.inner_radius, s.volume[p]);
  }
}

/// The radial displacement over that of the hole: particles count by volume; at current positions.
void add_displacement_errors(const HenckyWallComparison& c, const Scene& scene, const Snapshot& s,
                             Norms& norms) {
  const Wall wall(c, scene);
  Norm& u = norms["e_u"];
  for (size_t p = 0; p < s.count(); ++p) {
    const auto x = wall.from_center(s.position, p), moved = x - wall.from_center(s.initial_position, p);
    const double r = std::sqrt(dot(x, x)), exact = r - wall.at(r).initial_radius;
    u.add((exact - dot(moved, x) / r) / wall.hole_displacement(), s.volume[p]);
  }
}

/// The displacements of the ellipse and of the cylinder that yields are not in closed form here.
void add_displacement_errors(const EllipseComparison&, const Scene&, const Snapshot&, Norms&) {}
void add_displacement_errors(const YieldingCylinderComparison&, const Scene&, const Snapshot&, Norms&) {}

ExactFields exact_fields(const ColumnComparison& c, const Scene& scene, const Snapshot& s) {
  const auto solution = solution_of(c, scene);
  const double exact_ratio = stretching(c, scene);
  ExactFields exact{std::vector<double>(3 * s.count()), std::vector<double>(6 * s.count())};
  for (size_t p = 0; p < s.count(); ++p) {
    exact.displacement[3 * p] = exact_ratio * (s.initial_position[3 * p] - scene.grid.lower[0]);
    exact.cauchy_stress[6 * p] = solution.stress();
  }
  return exact;
}
ExactFields exact_fields(const CylinderComparison& c, const Scene& scene, const Snapshot& s) {
  const auto solution = solution_of(c, scene);
  ExactFields exact{std::vector<double>(3 * s.count()), std::vector<double>(6 * s.count())};
  for (size_t p = 0; p < s.count(); ++p) {
    const auto x = from_axis(c, s.position, p);
    const double r = std::sqrt(dot(x, x));
    for (size_t i = 0; i < 2; ++i)
      exact.displacement[3 * p + i] =
          c.moved[i] + solution.radial_displacement(r) * x[static_cast<int>(i)] / r;
    const auto polar = solution.stress(r);
    auto cartesian = from_polar<2>(polar, x[0], x[1]);
    cartesian[2] = scene.bodies.front().material.poisson_ratio * (polar.rr + polar.tt);
    store(cartesian, exact.cauchy_stress, p);
  }
  return exact;
}
ExactFields exact_fields(const YieldingCylinderComparison& c, const Scene& scene, const Snapshot& s) {
  const auto solution = solution_of(c, scene);
  const double rho = solution.plastic_radius();
  ExactFields exact{{}, std::vector<double>(6 * s.count())};
  for (size_t p = 0; p < s.count(); ++p) {
    const auto x = in_plane(s.position, p);
    const auto polar = solution.stress(std::sqrt(dot(x, x)), rho);
    auto cartesian = from_polar<2>(polar, x[0], x[1]);
    cartesian[2] = solution.axial_stress(polar);
    store(cartesian, exact.cauchy_stress, p);
  }
  return exact;
}
ExactFields exact_fields(const EllipseComparison& c, const Scene& scene, const Snapshot& s) {
  const auto solution = solution_of(c, scene);
  ExactFields exact{{}, std::vector<double>(6 * s.count())};
  for (size_t p = 0; p < s.count(); ++p)
    store(solution.stress(in_plane(s.position, p)), exact.cauchy_stress, p);
  return exact;
}

ExactFields exact_fields(const HenckyWallComparison& c, const Scene& scene, const Snapshot& s) {
  const Wall wall(c, scene);
  ExactFields exact{std::vector<double>(3 * s.count()), std::vector<double>(6 * s.count())};
  for (size_t p = 0; p < s.count(); ++p) {
    const auto x = wall.from_center(s.position, p);
    const double r = std::sqrt(dot(x, x)), moved = r - wall.at(r).initial_radius;
    const auto stress = wall.stress(x);
    for (size_t i = 0; i < 3; ++i) exact.displacement[3 * p + i] = moved * x[static_cast<int>(i)] / r;
    for (size_t k = 0; k < 6; ++k) exact.cauchy_stress[6 * p + k] = stress[static_cast<int>(k)];
  }
  return exact;
}

/// What is compared but is no error: the mean hoop stress over the exact one.
struct HoopRatio {
  double hoop = 0, exact = 0;
  void add(const CylinderComparison& c, const Scene& scene, const Snapshot& s) {
    const auto solution = solution_of(c, scene);
    for (size_t p = 0; p < s.count(); ++p) {
      const auto x = from_axis(c, s.position, p);
      hoop += s.volume[p] * to_polar(in_plane_stress(s.cauchy_stress, p), x[0], x[1]).tt;
      exact += s.volume[p] * solution.stress(std::sqrt(dot(x, x))).tt;
    }
  }
  Figures figures(const CylinderComparison&, const Scene&) const { return {{"hoop_ratio", hoop / exact}}; }
};
/// How far the hole has widened over the exact widening, by the particles of the innermost eighth of the
/// wall.
struct HoleRatio {
  double moved = 0, exact = 0;
  void add(const HenckyWallComparison& c, const Scene& scene, const Snapshot& s) {
    const Wall wall(c, scene);
    const double innermost = c.inner_radius + (c.outer_radius - c.inner_radius) / 8;
    for (size_t p = 0; p < s.count(); ++p) {
      const auto x = wall.from_center(s.position, p), x0 = wall.from_center(s.initial_position, p);
      const double r = std::sqrt(dot(x, x)), R = std::sqrt(dot(x0, x0));
      if (R > innermost) continue;
      moved += s.mass[p] * (r - R);
      exact += s.mass[p] * (r - wall.at(r).initial_radius);
    }
  }
  Figures figures(const HenckyWallComparison&, const Scene&) const { return {{"hole_ratio", moved / exact}}; }
};
/// How far it has yielded: the mean radius, that of the furthest particle, and the exact one.
struct PlasticRadii {
  PlasticZone zone;
  void add(const YieldingCylinderComparison&, const Scene&, const Snapshot& s) { zone.add(s); }
  Figures figures(const YieldingCylinderComparison& c, const Scene& scene) const {
    return {{"plastic_radius", zone.radius(c)},
            {"largest_plastic_radius", zone.largest_radius(c)},
            {"exact_radius", solution_of(c, scene).plastic_radius()}};
  }
};
struct NoFigures {
  template <class Solution>
  void add(const Solution&, const Scene&, const Snapshot&) {}
  template <class Solution>
  Figures figures(const Solution&, const Scene&) const {
    return {};
  }
};
HoopRatio figures_of(const CylinderComparison&) {
  return {};
}
HoleRatio figures_of(const HenckyWallComparison&) {
  return {};
}
PlasticRadii figures_of(const YieldingCylinderComparison&) {
  return {};
}
template <class Solution>
NoFigures figures_of(const Solution&) {
  return {};
}

/// The weights of particles in norms of the stress.
std::vector<double> weights(const ColumnComparison&, const Snapshot& s) {
  return std::vector<double>(s.count(), 1);
}
template <class InThePlane>
std::vector<double> weights(const InThePlane&, const Snapshot& s) {
  return s.volume;
}

template <class Solution>
ComparisonResult compare(const Solution& c, const Scene& scene, const ParticleReader& particles) {
  Norms norms, of_recovered, of_means;
  auto others = figures_of(c);
  unsigned fields = field::initial_position | field::position | field::cauchy_stress | field::volume;
  if (std::holds_alternative<YieldingCylinderComparison>(scene.compare)) fields |= field::plastic_strain;
  if (std::holds_alternative<HenckyWallComparison>(scene.compare)) fields |= field::mass;
  if (scene.more_norms.recovered) fields |= field::recovered_stress;
  particles.for_each_range(fields, [&](const Snapshot& s) {
    const auto weight = weights(c, s);
    add_displacement_errors(c, scene, s, norms);
    add_stress_errors(c, scene, {s.position, s.cauchy_stress, weight}, norms);
    if (scene.more_norms.recovered)
      add_stress_errors(c, scene, {s.position, s.recovered_stress, weight}, of_recovered);
    others.add(c, scene, s);
  });
  if (scene.more_norms.cell_means) {
    const CellMeans means = cell_means(scene, particles);
    add_stress_errors(c, scene, {means.position, means.cauchy_stress, means.volume}, of_means);
  }
  std::map<std::string, double> errors;
  const auto enter = [&](const Norms& of, const char* suffix) {
    for (const auto& [name, norm] : of) errors[name + suffix] = norm.value();
  };
  enter(norms, "");
  enter(of_recovered, "_recovered");
  enter(of_means, "_cell_mean");
  ComparisonResult result{{}, others.figures(c, scene)};
  for (const auto& name : error_names(scene)) result.errors.emplace_back(name, errors.at(name));
  return result;
}
ComparisonResult compare(const std::monostate&, const Scene&, const ParticleReader&) {
  return {};
}

ExactFields exact_fields(const std::monostate&, const Scene&, const Snapshot&) {
  return {};
}

}  // namespace

std::vector<std::string> comparison_figure_names(const Comparison& comparison) {
  if (std::holds_alternative<CylinderComparison>(comparison)) return {"hoop_ratio"};
  if (std::holds_alternative<HenckyWallComparison>(comparison)) return {"hole_ratio"};
  if (std::holds_alternative<YieldingCylinderComparison>(comparison))
    return {"plastic_radius", "largest_plastic_radius", "exact_radius"};
  return {};
}

KnownExactly known_exactly(const Scene& scene) {
  const auto& c = scene.compare;
  if (std::holds_alternative<std::monostate>(c)) return {};
  if (std::holds_alternative<ColumnComparison>(c)) return {true, true, field::initial_position};
  const bool displacement =
      std::holds_alternative<CylinderComparison>(c) || std::holds_alternative<HenckyWallComparison>(c);
  return {displacement, true, field::position};
}

ExactFields exact_at(const Scene& scene, const Snapshot& snapshot) {
  return std::visit([&](const auto& c) { return exact_fields(c, scene, snapshot); }, scene.compare);
}

ComparisonResult compare_with_exact(const Scene& scene, const ParticleReader& particles) {
  return std::visit([&](const auto& c) { return compare(c, scene, particles); }, scene.compare);
}

}  // namespace vsb::app
