// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Particles that are of one material.
#pragma once

#include <vsb/physics/material.hpp>

namespace vsb {

/// Particles first, ..., last - 1 and what they are made of.
template <class Real>
struct Body {
  ///@{
  /// 0 <= first <= last <= number of particles.
  int first = 0, last = 0;
  ///@}
  Material<Real> material;  ///< its law and constants
  int state_offset = 0;     ///< the state of particle p is row p + state_offset of Particles::material_state
};

}  // namespace vsb
