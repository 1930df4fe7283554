// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What a static solution, which is linear in the displacement, cannot be trusted with.
#pragma once

#include <string>
#include <vector>

#include "engine/particle_reader.hpp"
#include "scene/scene.hpp"

namespace vsb::app {

/// The particles of a static solution beside the affine motion u(x) of those in their cell and the cells
/// around it, fitted by least squares.
struct LocalMotion {
  double rotation = 0;       ///< the largest, of the affine motions, rad
  double unlike = 0;         ///< the largest distance of a particle's displacement from u(x), m
  double unlike_strain = 0;  ///< the same over the radius of the neighbourhood
  Point at{};                ///< where that particle began
  Point lower{}, upper{};    ///< of where all particles began, along the grid's axes
};
LocalMotion local_motion(const Scene& scene, const ParticleReader& particles);

/// What is doubtful about the solution that the particles have, a sentence each. largest_strain: of its
/// linear strains, the largest component.
std::vector<std::string> static_advice(const Scene& scene, const ParticleReader& particles,
                                       double largest_strain);

/// The most that the residual of conjugate gradients can be of the one at the start where the matrix is
/// regular in double precision: it grows by the root of the condition number at most.
constexpr double regular_residual = 1e8;

}  // namespace vsb::app
