// SPDX-License-Identifier: BSD-3-Clause
#include "scene/limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <vsb/physics/exact_column.hpp>
#include <vsb/physics/exact_hencky_wall.hpp>
#include <vsb/physics/exact_mohr_coulomb_cylinder.hpp>
#include <vsb/physics/explicit_dynamics.hpp>
#include <vsb/physics/linear_elastic.hpp>
#include <vsb/physics/mohr_coulomb.hpp>

namespace vsb::app {

double constrained_modulus(const MaterialSpec& m) {
  return LinearElastic<double>::from_young(m.youngs_modulus, m.poisson_ratio).constrained_modulus();
}

double critical_time(const Scene& scene) {
  const double smallest = shortest_edge(scene.grid, scene.dimension);
  double shortest = std::numeric_limits<double>::infinity();
  for (const auto& body : scene.bodies)
    shortest = std::min(shortest, time_step(1.0, smallest, constrained_modulus(body.material), body.density));
  return shortest;
}

double apex(const MaterialSpec& m) {
  return MohrCoulombConstants{0, 0, m.cohesion, m.friction_angle}.apex();
}

double largest_column_tension(const MaterialSpec& m) {
  return m.law == MaterialLaw::hencky ? ExactHenckyColumn<double>::limit() * constrained_modulus(m)
                                      : std::numeric_limits<double>::infinity();
}

bool bears_pressure(const HenckyWallComparison& wall, const MaterialSpec& material) {
  const auto law = LinearElastic<double>::from_young(material.youngs_modulus, material.poisson_ratio);
  return std::isfinite(ExactHenckyWall<double>{wall.inner_radius, wall.outer_radius, wall.pressure,
                                               law.lambda, law.shear_modulus, wall.dimension - 1}
                           .hole_radius());
}

double collapse_pressure(const YieldingCylinderComparison& c, const MaterialSpec& m) {
  return ExactMohrCoulombCylinder<double>{c.inner_radius, c.outer_radius,   0,
                                          m.cohesion,     m.friction_angle, m.poisson_ratio}
      .collapse_pressure();
}

}  // namespace vsb::app
