// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The recovered stress: the continuous field sum_I N_I s_I that is nearest to the particles' stress, its L2
/// projection on the multilinear basis with the consistent mass matrix,
///   sum_J M_IJ s_J = sum_p V_p N_I(x_p) sigma_p,   M_IJ = sum_p V_p N_I(x_p) N_J(x_p),
/// taken back to the particles. A linear field comes back as it was. It is for output alone: where the linear
/// basis gives a stress that is first order at the particles, the recovered one is nearly second order.
///
/// Every body has its own field, since stresses may jump between bodies.
#pragma once

#include "engine/particle_reader.hpp"

namespace vsb::app {

/// The recovered stress of all particles, 6 components each, from their position, stress and volume. Throws
/// Diverged where the system cannot be solved, as with stresses that are not finite.
std::vector<double> recovered_stress(const Scene& scene, const Snapshot& particles);

}  // namespace vsb::app
