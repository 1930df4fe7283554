// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Isotropic linear elasticity in rate form (hypoelastic, Jaumann rate):
///   sigma <- sigma + dt (w sigma - sigma w) + lambda tr(de) I + 2 mu de,
/// and its linear part, sigma + C : de, for static states at small strain.
#pragma once

#include <sstream>
#include <stdexcept>
#include <vsb/physics/kinematics.hpp>

namespace vsb {

/// A linear elastic material in rate form; the equations are at the top of this file. It has no state beside
/// the stress.
template <class Real>
struct LinearElastic {
  static constexpr bool plastic = false;  ///< see material.hpp

  Real lambda;         ///< Lame's first parameter, Pa
  Real shear_modulus;  ///< Pa

  /// Throws std::invalid_argument unless E > 0 Pa and -1 < nu < 1/2.
  static LinearElastic from_young(double youngs_modulus, double poisson_ratio) {
    const double E = youngs_modulus, nu = poisson_ratio;
    if (!(E > 0) || !(nu > -1 && nu < 0.5)) {
      std::ostringstream text;
      text << "vsb::LinearElastic: Young's modulus " << E << " Pa and Poisson ratio " << nu
           << "; allowed are E > 0 and -1 < nu < 0.5";
      throw std::invalid_argument(text.str());
    }
    return {static_cast<Real>(E * nu / ((1 + nu) * (1 - 2 * nu))), static_cast<Real>(E / (2 * (1 + nu)))};
  }

  /// Numbers to remember per particle.
  template <int Dim>
  KOKKOS_FUNCTION static constexpr int state_size() {
    return 0;
  }

  /// M of Eq. (29), Pa: stiffness in uniaxial strain.
  KOKKOS_FUNCTION Real constrained_modulus() const { return lambda + 2 * shear_modulus; }

  /// K, Pa.
  KOKKOS_FUNCTION Real bulk_modulus() const { return lambda + 2 * shear_modulus / 3; }

  /// The stress at the end of a step of length dt with velocity gradient L.
  template <int Dim, class T>
  KOKKOS_FORCEINLINE_FUNCTION SymmetricTensor<Dim, T> advance(const SymmetricTensor<Dim, T>& sigma,
                                                              const Matrix<Dim, T>& L, T dt) const {
    return strained(turned_with_material(sigma, L, dt), L, dt);
  }

  /// Itself; see material.hpp.
  KOKKOS_FUNCTION LinearElastic small_strain_law() const { return *this; }

  /// sigma + C : de, de = dt sym(L), in a frame that does not turn.
  template <int Dim, class T>
  KOKKOS_FORCEINLINE_FUNCTION SymmetricTensor<Dim, T> strained(const SymmetricTensor<Dim, T>& sigma,
                                                               const Matrix<Dim, T>& L, T dt) const {
    const T G_dt = T(shear_modulus) * dt, isotropic = T(lambda) * dt * trace(L);
    auto s = sigma;
    for (int i = 0; i < 3; ++i) s[i] += isotropic;
    for (int i = 0; i < Dim; ++i) {
      s[i] += T(2) * G_dt * L(i, i);
      for (int j = i + 1; j < Dim; ++j) s[symmetric_index(i, j)] += G_dt * (L(i, j) + L(j, i));
    }
    return s;
  }

  /// C^-1 : sigma.
  template <int Dim, class T>
  KOKKOS_FUNCTION SymmetricTensor<Dim, T> strain_of(const SymmetricTensor<Dim, T>& sigma) const {
    const T mu = T(shear_modulus), l = T(lambda);
    const T isotropic = l / (T(3) * l + T(2) * mu) * (sigma[0] + sigma[1] + sigma[2]);
    auto e = sigma - SymmetricTensor<Dim, T>::isotropic(isotropic);
    return e *= T(1) / (T(2) * mu);
  }
};

}  // namespace vsb
