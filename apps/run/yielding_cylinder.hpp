// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The pressurised cylinder of Mohr-Coulomb material against physics/exact_mohr_coulomb_cylinder.hpp.
#pragma once

#include <vsb/physics/exact_mohr_coulomb_cylinder.hpp>
#include "run/simulation.hpp"
#include "scene/scene.hpp"

namespace vsb::app {

ExactMohrCoulombCylinder<double> solution_of(const YieldingCylinderComparison& c, const Scene& scene);

/// The radius up to which a ring has as large a share of the cylinder as the particles that have yielded, m.
double plastic_radius(const YieldingCylinderComparison& c, const Snapshot& s);

/// The radius of the particle furthest from the axis that has yielded, m; the inner radius where none has.
double plastic_reach(const YieldingCylinderComparison& c, const Snapshot& s);

}  // namespace vsb::app
