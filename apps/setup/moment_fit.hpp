// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Particle volumes with which sums over the particles of a cell are integrals over the body's share of it.
///
/// In every cell c the volumes V_p of a body's particles become those with
///     sum_p V_p m(x_p) = int_{c cap body} m dV
/// for the products m of different coordinates (1, x, y, xy in 2D) that change the lattice's own volumes V0
/// least,
///     sum_p (V_p - V0_p)^2 / V0_p -> min,   V_p = V0_p (1 + sum_k lambda_k m_k(x_p)).
/// The gradients of the linear basis are among these products, so that in a cell that lies in the body as a
/// whole sum_p V_p grad N_I is exact, as it is on a lattice of equal boxes. What the modified method lacks in
/// the resultant of a closed surface comes from such cells, next to those of the boundary nodes, and is gone:
/// of the free cylinder of rings (apps/scenes/cylinder-free.toml) 5.0e-2 p a, with the fit 4e-16 p a, and
/// 1.4e-6 p a after one step of kappa = 0.2. Particles that move into other cells leave the fit behind.
///
/// Where particles are too few, or one would keep less than a tenth of what the volume alone gives it,
/// products of most coordinates are left out, then of fewer, until the volume is left. Masses follow the
/// volumes. The fit is made once, at the start; volumes then change with the deformation, as ever. Cells
/// without a particle, and particles in cells where the body is not (as a jitter may move them), are left
/// alone.
#pragma once

#include "setup/place_particles.hpp"

namespace vsb::app {

/// Fits the volumes of the irregular bodies' particles, on a uniform grid.
MomentFit fit_moments(const Scene& scene, PlacedParticles& placed);

}  // namespace vsb::app
