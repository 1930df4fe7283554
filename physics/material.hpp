// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The materials and volume updates a body can choose from; the choice is made once per launch of a kernel,
/// by visiting.
///
/// A material says with state_size<Dim>() how many numbers it remembers per particle beside the stress. Where
/// that is none, it advances (stress, L, dt) to the stress at the end of the step; else (stress, state, L,
/// dt), and changes the state. A state of zeros is that of a particle without stress and deformation. At
/// small strain around that state every material is a linear elastic one, small_strain_law().
#pragma once

#include <variant>
#include <vsb/physics/hencky.hpp>
#include <vsb/physics/linear_elastic.hpp>

namespace vsb {

template <class Real>
using Material = std::variant<LinearElastic<Real>, Hencky<Real>>;

template <class Real>
LinearElastic<Real> small_strain_law(const Material<Real>& material) {
  return std::visit([](const auto& m) { return m.small_strain_law(); }, material);
}

using VolumeUpdate = std::variant<DeterminantVolume, ExponentialVolume>;

}  // namespace vsb
