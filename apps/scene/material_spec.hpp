// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What a body is made of, as a scene says it.
#pragma once

#include <limits>
#include <tuple>

namespace vsb::app {

/// How stress follows from deformation.
enum class MaterialLaw {
  linear_elastic,  ///< rate form, physics/linear_elastic.hpp
  hencky,          ///< from the deformation gradient, physics/hencky.hpp
  mohr_coulomb,    ///< physics/mohr_coulomb.hpp
  tresca,          ///< Mohr-Coulomb without friction
  drucker_prager,  ///< physics/drucker_prager.hpp
  von_mises        ///< Drucker-Prager without friction
};

inline bool is_plastic(MaterialLaw law) {
  return law != MaterialLaw::linear_elastic && law != MaterialLaw::hencky;
}

/// What a law does not have stays as it is here.
struct MaterialSpec {
  MaterialLaw law;
  double youngs_modulus, poisson_ratio;
  double cohesion = 0, yield_stress = 0;                              ///< Pa
  double friction_angle = 0, dilation_angle = 0;                      ///< radians
  double tensile_strength = std::numeric_limits<double>::infinity();  ///< Pa; infinite: no cut-off
  double hardening_modulus = 0;                                       ///< Pa
  int cone = 0;                                                       ///< index in drucker_prager_cones

  friend bool operator==(const MaterialSpec& a, const MaterialSpec& b) {
    const auto tie = [](const MaterialSpec& m) {
      return std::tie(m.law, m.youngs_modulus, m.poisson_ratio, m.cohesion, m.yield_stress, m.friction_angle,
                      m.dilation_angle, m.tensile_strength, m.hardening_modulus, m.cone);
    };
    return tie(a) == tie(b);
  }
};

/// The cones of physics/drucker_prager.hpp, in its order.
constexpr const char* drucker_prager_cones[] = {"outer", "inner", "plane_strain"};

}  // namespace vsb::app
