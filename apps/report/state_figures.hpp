// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Figures of the state that a run ends in, which need no exact solution: how far it moved, its energies, and
/// its extreme stresses.
#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "engine/particle_reader.hpp"
#include "scene/scene.hpp"

namespace vsb::app {

/// Of all particles; none of a state that was not looked at. Energies are per metre of thickness in 2D, per
/// square metre of cross-section in 1D.
struct StateFigures {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double largest_displacement = none;               ///< m, length of the vector
  double kinetic_energy = none;                     ///< J, sum_p m |v|^2 / 2
  double strain_energy = none;                      ///< J, sum_p V0 tau : C^-1 : tau / 2; the elastic part
  double largest_principal_stress = none;           ///< Pa, tension positive
  double smallest_principal_stress = none;          ///< Pa
  double largest_von_mises = none;                  ///< Pa, sqrt(3 J2)
  double largest_equivalent_plastic_strain = none;  ///< Eq. (34)
};

StateFigures state_figures(const Scene& scene, const ParticleReader& particles);

/// By name, as above; the plastic strain where a body may yield.
std::vector<std::pair<std::string, double>> named(const StateFigures& figures, const Scene& scene);

/// The figures in a line, which says where the particles' kinetic energy is not that of the nodes: of FLIP
/// particles, velocities that cancel at every node move nothing and stay (kernels/readout/balance.hpp).
/// `energy_ratio` is that of the nodes.
void print_state_figures(const StateFigures& figures, double energy_ratio);

}  // namespace vsb::app
