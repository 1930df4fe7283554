// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The pressurised cylinder of Mohr-Coulomb material against physics/exact_mohr_coulomb_cylinder.hpp.
#pragma once

#include <vsb/physics/exact_mohr_coulomb_cylinder.hpp>
#include "engine/particle_reader.hpp"
#include "scene/scene.hpp"

namespace vsb::app {

ExactMohrCoulombCylinder<double> solution_of(const YieldingCylinderComparison& c, const Scene& scene);

/// How far a cylinder has yielded, from its particles with volume, position and plastic strain.
class PlasticZone {
 public:
  void add(const Snapshot& s);
  /// The radius up to which a ring has as large a share of the cylinder as the particles that have yielded,
  /// m.
  double radius(const YieldingCylinderComparison& c) const;
  /// The radius of the particle furthest from the axis that has yielded, m; the inner radius where none has.
  double largest_radius(const YieldingCylinderComparison& c) const;

 private:
  double yielded_ = 0, all_ = 0;  ///< volumes, m^3
  double furthest_ = 0;           ///< m
};

}  // namespace vsb::app
