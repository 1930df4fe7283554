// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The material of a body as the kernels take it.
#pragma once

#include <vsb/physics/material.hpp>
#include "scene/scene.hpp"

namespace vsb::app {

template <class Real>
Material<Real> material_of(const MaterialSpec& m) {
  switch (m.law) {
    case MaterialLaw::hencky:
      return Hencky<Real>::from_young(m.youngs_modulus, m.poisson_ratio);
    case MaterialLaw::mohr_coulomb:
    case MaterialLaw::tresca:
      return MohrCoulomb<Real>::from({m.youngs_modulus, m.poisson_ratio, m.cohesion, m.friction_angle,
                                      m.dilation_angle, m.tensile_strength});
    case MaterialLaw::drucker_prager:
      return DruckerPrager<Real>::from({m.youngs_modulus, m.poisson_ratio, m.cohesion, m.friction_angle,
                                        m.dilation_angle, m.hardening_modulus,
                                        static_cast<DruckerPragerCone>(m.cone)});
    case MaterialLaw::von_mises:
      return DruckerPrager<Real>::von_mises(m.youngs_modulus, m.poisson_ratio, m.yield_stress,
                                            m.hardening_modulus);
    case MaterialLaw::linear_elastic:
      break;
  }
  return LinearElastic<Real>::from_young(m.youngs_modulus, m.poisson_ratio);
}

}  // namespace vsb::app
