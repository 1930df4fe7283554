// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The plastic strain tensor in the state of a material, and its measure, Eq. (34). Shear components are
/// those of the tensor, half the engineering shear.
#pragma once

#include <vsb/physics/kinematics.hpp>
#include <vsb/physics/linear_elastic.hpp>

namespace vsb {

/// eps_q = sqrt(2/3 e : e), e = eps - tr(eps) / 3 I, Eq. (34).
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION T equivalent_plastic_deviatoric_strain(const SymmetricTensor<Dim, T>& plastic_strain) {
  const T mean = (plastic_strain[0] + plastic_strain[1] + plastic_strain[2]) / T(3);
  T ee = T(0);
  for (int c = 0; c < SymmetricTensor<Dim, T>::size; ++c) {
    const T e = plastic_strain[c] - (c < 3 ? mean : T(0));
    ee += (c < 3 ? T(1) : T(2)) * e * e;
  }
  return math::sqrt(T(2) / T(3) * ee);
}

/// The plastic strain with which the state of a plastic material begins.
template <int Dim, int N, class T>
KOKKOS_FORCEINLINE_FUNCTION SymmetricTensor<Dim, T> plastic_strain_in(const Vector<N, T>& state) {
  SymmetricTensor<Dim, T> e;
  for (int c = 0; c < e.size; ++c) e[c] = state[c];
  return e;
}

/// Turns the plastic strain with the material, as the Jaumann rate turns the stress. The increments of all
/// steps are then sums in axes of the material, and a rotation of the body does not change their measure.
template <int Dim, int N, class T>
KOKKOS_FORCEINLINE_FUNCTION void turn_plastic_strain(Vector<N, T>& state, const Matrix<Dim, T>& L, T dt) {
  const auto turned = turned_with_material(plastic_strain_in<Dim>(state), L, dt);
  for (int c = 0; c < turned.size; ++c) state[c] = turned[c];
}

/// Removes the excess of a trial stress: sigma = sigma_trial - excess, and the plastic strain grows by
/// C^-1 : (sigma_trial - sigma).
template <int Dim, int N, class Real>
KOKKOS_FUNCTION void release(const LinearElastic<Real>& elastic, const SymmetricTensor<Dim, Real>& excess,
                             SymmetricTensor<Dim, Real>& stress, Vector<N, Real>& state) {
  stress -= excess;
  const auto strain = elastic.strain_of(excess);
  for (int c = 0; c < strain.size; ++c) state[c] += strain[c];
}

/// One step of a plastic material: the elastic trial stress, and the return to the yield surface where the
/// trial may lie beyond it.
template <class Material, int Dim, int N, class Real>
KOKKOS_FORCEINLINE_FUNCTION SymmetricTensor<Dim, Real> advance_plastic(
    const Material& material, const SymmetricTensor<Dim, Real>& sigma, Vector<N, Real>& state,
    const Matrix<Dim, Real>& L, Real dt) {
  auto stress = material.elastic.advance(sigma, L, dt);
  turn_plastic_strain(state, L, dt);
  if (material.may_yield(stress, state)) material.return_stress(stress, state);
  return stress;
}

}  // namespace vsb
