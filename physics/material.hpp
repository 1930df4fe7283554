// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The materials and volume updates a body can choose from; the choice is made once per launch of a kernel,
/// by visiting.
///
/// state_size<Dim>() is the number of state variables of a material per particle beside the stress. Without
/// any, advance(stress, L, dt) returns the stress at the end of the step; else advance(stress, state, L, dt)
/// does, and changes the state. A state of zeros is that of a particle without stress and deformation. At
/// small strain around that state every material is linear elastic, small_strain_law().
///
/// The state of a `plastic` material begins with its plastic strain, in the order of SymmetricTensor; the gap
/// of physics/gap.hpp and hardening variables follow. Such a material has an elastic law for the trial
/// stress, `elastic`; a test without branches, may_yield(trial, state), which is false only for elastic
/// states; and return_stress(stress, state).
#pragma once

#include <variant>
#include <vsb/physics/drucker_prager.hpp>
#include <vsb/physics/hencky.hpp>
#include <vsb/physics/linear_elastic.hpp>
#include <vsb/physics/mohr_coulomb.hpp>

namespace vsb {

/// The material of a body: one of four laws, whose members the top of this file lists.
template <class Real>
using Material = std::variant<LinearElastic<Real>, Hencky<Real>, MohrCoulomb<Real>, DruckerPrager<Real>>;

/// The linear elastic law of a material at small strain around a state of zeros.
template <class Real>
LinearElastic<Real> small_strain_law(const Material<Real>& material) {
  return std::visit([](const auto& m) { return m.small_strain_law(); }, material);
}

/// Whether a material has a yield surface.
template <class Real>
bool is_plastic(const Material<Real>& material) {
  return std::visit([](const auto& m) { return m.plastic; }, material);
}

/// How the volume of a particle follows from the velocity gradient: see physics/kinematics.hpp.
using VolumeUpdate = std::variant<DeterminantVolume, ExponentialVolume>;

}  // namespace vsb
