// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Isotropic Hencky (logarithmic) elasticity from the deformation gradient F:
///   F <- (I + dt L) F,   eps = 1/2 ln(F F^T),   J = det F,   J sigma = lambda tr(eps) I + 2 mu eps.
/// The stress is a function of the deformation: a rotation or a closed path of deformation leaves no stress.
/// In rate form it leaves some. In plane strain F33 = 1.
///
/// The state is H = F - I, and the decomposed tensor F F^T - I = H + H^T + H H^T. Small strains keep all
/// their digits, and a state of zeros is undeformed.
#pragma once

#include <vsb/physics/kinematics.hpp>
#include <vsb/physics/linear_elastic.hpp>
#include <vsb/physics/symmetric_eigen.hpp>

namespace vsb {

/// 1/2 ln(F F^T) for F = I + H.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION SymmetricTensor<Dim, T> logarithmic_strain(const Matrix<Dim, T>& H) {
  auto C = SymmetricTensor<Dim, T>::zero();
  for (int i = 0; i < Dim; ++i)
    for (int j = i; j < Dim; ++j) {
      T c = H(i, j) + H(j, i);
      for (int k = 0; k < Dim; ++k) c += H(i, k) * H(j, k);
      C[symmetric_index(i, j)] = c;
    }
  auto principal = principal_values(C);
  for (int i = 0; i < Dim; ++i) principal.value[i] = T(0.5) * math::log1p(principal.value[i]);
  return from_principal_values(principal);
}

/// A Hencky material; the equations are at the top of this file. Its state per particle is H = F - I, row by
/// row.
template <class Real>
struct Hencky {
  static constexpr bool plastic = false;  ///< see material.hpp

  Real lambda;         ///< Lame's first parameter, Pa
  Real shear_modulus;  ///< Pa

  /// Throws std::invalid_argument unless E > 0 Pa and -1 < nu < 1/2.
  static Hencky from_young(double youngs_modulus, double poisson_ratio) {
    const auto small_strain = LinearElastic<Real>::from_young(youngs_modulus, poisson_ratio);
    return {small_strain.lambda, small_strain.shear_modulus};
  }

  /// Numbers to remember per particle: H, row by row.
  template <int Dim>
  KOKKOS_FUNCTION static constexpr int state_size() {
    return Dim * Dim;
  }

  /// M of Eq. (29), Pa: stiffness in uniaxial strain, of the undeformed material.
  KOKKOS_FUNCTION Real constrained_modulus() const { return lambda + 2 * shear_modulus; }

  /// See material.hpp.
  KOKKOS_FUNCTION LinearElastic<Real> small_strain_law() const { return {lambda, shear_modulus}; }

  /// The Cauchy stress of F = I + H.
  template <int Dim, class T>
  KOKKOS_FUNCTION SymmetricTensor<Dim, T> stress(const Matrix<Dim, T>& H) const {
    const auto strain = logarithmic_strain(H);
    const T J = determinant(deformation_increment(H, T(1)));
    auto tau = T(2 * shear_modulus) * strain;
    const T isotropic = T(lambda) * (strain[0] + strain[1] + strain[2]);
    for (int i = 0; i < 3; ++i) tau[i] += isotropic;
    return (T(1) / J) * tau;
  }

  /// The stress at the end of a step of length dt with velocity gradient L; the stress before it does not
  /// matter.
  template <int Dim, class T>
  KOKKOS_FUNCTION SymmetricTensor<Dim, T> advance(const SymmetricTensor<Dim, T>&, Vector<Dim * Dim, T>& state,
                                                  const Matrix<Dim, T>& L, T dt) const {
    Matrix<Dim, T> H;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) {
        T increment = L(i, j);
        for (int k = 0; k < Dim; ++k) increment += L(i, k) * state[k * Dim + j];
        H(i, j) = state[i * Dim + j] + dt * increment;
      }
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) state[i * Dim + j] = H(i, j);
    return stress(H);
  }
};

}  // namespace vsb
