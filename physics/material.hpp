// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The materials and volume updates a body can choose from; the choice is made once per launch of a kernel,
/// by visiting.
///
/// A material says with state_size<Dim>() how many numbers it remembers per particle beside the stress. Where
/// that is none, it advances (stress, L, dt) to the stress at the end of the step; else (stress, state, L,
/// dt), and changes the state. A state of zeros is that of a particle without stress and deformation. At
/// small strain around that state every material is a linear elastic one, small_strain_law().
///
/// A `plastic` material's state begins with its plastic strain, in the order of SymmetricTensor; hardening
/// variables follow. It is made of an elastic law for the trial stress, `elastic`, of a test that needs no
/// branches and may be too strict, may_yield(trial, state), and of return_stress(stress, state).
#pragma once

#include <variant>
#include <vsb/physics/drucker_prager.hpp>
#include <vsb/physics/hencky.hpp>
#include <vsb/physics/linear_elastic.hpp>
#include <vsb/physics/mohr_coulomb.hpp>

namespace vsb {

template <class Real>
using Material = std::variant<LinearElastic<Real>, Hencky<Real>, MohrCoulomb<Real>, DruckerPrager<Real>>;

template <class Real>
LinearElastic<Real> small_strain_law(const Material<Real>& material) {
  return std::visit([](const auto& m) { return m.small_strain_law(); }, material);
}

template <class Real>
bool is_plastic(const Material<Real>& material) {
  return std::visit([](const auto& m) { return m.plastic; }, material);
}

using VolumeUpdate = std::variant<DeterminantVolume, ExponentialVolume>;

}  // namespace vsb
