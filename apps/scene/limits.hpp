// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What physics says of a scene's numbers, for the readers: the sources that read TOML include nothing of
/// Kokkos, so that a build for a device leaves them to the host's own compiler.
#pragma once

#include "scene/scene.hpp"

namespace vsb::app {

/// In uniaxial strain, Pa.
double constrained_modulus(const MaterialSpec& material);

/// The shortest of the bodies' times for a compression wave to cross a cell, s: dt of Eq. (29) for kappa = 1.
double critical_time(const Scene& scene);

/// The largest mean stress that a material with cohesion and friction bears, Pa.
double apex(const MaterialSpec& material);

/// The largest axial tension of a column, Pa; infinite where there is none.
double largest_column_tension(const MaterialSpec& material);

/// Whether a wall of the material has an equilibrium under its pressure.
bool bears_pressure(const HenckyWallComparison& wall, const MaterialSpec& material);

/// The pressure at which a cylinder yields as a whole, Pa.
double collapse_pressure(const YieldingCylinderComparison& cylinder, const MaterialSpec& material);

}  // namespace vsb::app
