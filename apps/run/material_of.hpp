// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The material of a body as the kernels take it.
#pragma once

#include <vsb/physics/material.hpp>
#include "scene/scene.hpp"

namespace vsb::app {

template <class Real>
Material<Real> material_of(const ElasticSpec& m) {
  if (m.law == MaterialLaw::hencky) return Hencky<Real>::from_young(m.youngs_modulus, m.poisson_ratio);
  return LinearElastic<Real>::from_young(m.youngs_modulus, m.poisson_ratio);
}

}  // namespace vsb::app
