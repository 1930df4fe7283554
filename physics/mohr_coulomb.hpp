// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Mohr-Coulomb plasticity with dilation and tension cut-off, elastic-perfectly plastic, in rate form. With
/// the principal stresses s1 >= s2 >= s3, tension positive,
///   f = (s1 - s3) + (s1 + s3) sin(phi) - 2 c cos(phi) <= 0,    s1 <= tensile strength.
/// The plastic strain rate is normal to the cut-off, and to f with the dilation angle psi in place of phi.
/// Tresca's criterion is phi = 0.
#pragma once

#include <cmath>
#include <limits>
#include <vsb/physics/elastic_cone.hpp>
#include <vsb/physics/gap.hpp>
#include <vsb/physics/mohr_coulomb_return.hpp>
#include <vsb/physics/plastic_strain.hpp>
#include <vsb/physics/principal_stresses.hpp>

namespace vsb {

/// What a Mohr-Coulomb material is made from; angles in radians.
struct MohrCoulombConstants {
  ///@{
  /// E > 0 in Pa, and -1 < nu < 1/2.
  double youngs_modulus, poisson_ratio;
  ///@}
  double cohesion;                                                    ///< c, Pa
  double friction_angle = 0;                                          ///< phi
  double dilation_angle = 0;                                          ///< psi
  double tensile_strength = std::numeric_limits<double>::infinity();  ///< Pa; infinite: no cut-off

  /// c cot(phi), the largest mean stress without a cut-off, Pa.
  double apex() const { return cohesion / std::tan(friction_angle); }
};

/// A Mohr-Coulomb or Tresca material; the equations are at the top of this file. Its state per particle is
/// the plastic strain and the gap of physics/gap.hpp.
template <class Real>
struct MohrCoulomb {
  static constexpr bool plastic = true;  ///< see material.hpp

  LinearElastic<Real> elastic;       ///< law of the trial stress
  MohrCoulombSurface<Real> surface;  ///< in principal stresses
  ///@{
  /// Of the largest cone within f; see elastic_cone.hpp. The strength is in Pa.
  Real cone_slope, cone_strength;
  ///@}

  /// Throws std::invalid_argument unless E and nu suit LinearElastic, c >= 0, 0 <= psi <= phi < pi/2, c and
  /// phi are not both zero, and the tensile strength is not negative.
  static MohrCoulomb from(const MohrCoulombConstants& m) {
    check(m);
    const double sine = std::sin(m.friction_angle), cosine = std::cos(m.friction_angle);
    MohrCoulomb result;
    result.elastic = LinearElastic<Real>::from_young(m.youngs_modulus, m.poisson_ratio);
    auto& f = result.surface;
    f.coupling = static_cast<Real>(m.poisson_ratio / (1 - 2 * m.poisson_ratio));
    f.sin_friction = static_cast<Real>(sine);
    f.sin_dilation = static_cast<Real>(std::sin(m.dilation_angle));
    f.strength = static_cast<Real>(2 * m.cohesion * cosine);
    f.apex = m.friction_angle > 0 ? static_cast<Real>(m.apex()) : std::numeric_limits<Real>::infinity();
    // A cut-off beyond the apex has no effect.
    f.tensile_strength = m.tensile_strength < m.apex() * (1 - 1e-6) ? static_cast<Real>(m.tensile_strength)
                                                                    : std::numeric_limits<Real>::infinity();
    // f / 2 = sqrt(J2) (cos(theta) - sin(theta) sin(phi) / sqrt(3)) + sigma_m sin(phi) - c cos(phi) has its
    // largest value over all Lode angles theta where tan(theta) = -sin(phi) / sqrt(3).
    const double most = std::sqrt(1 + sine * sine / 3);
    result.cone_slope = static_cast<Real>(sine / most);
    result.cone_strength = static_cast<Real>(m.cohesion * cosine / most);
    return result;
  }

  /// Numbers to remember per particle: the plastic strain and the gap.
  template <int Dim>
  KOKKOS_FUNCTION static constexpr int state_size() {
    return symmetric_components(Dim) + 1;
  }

  /// M of Eq. (29), Pa: stiffness in uniaxial strain, elastic.
  KOKKOS_FUNCTION Real constrained_modulus() const { return elastic.constrained_modulus(); }

  /// See material.hpp.
  KOKKOS_FUNCTION LinearElastic<Real> small_strain_law() const { return elastic; }

  /// The stress at the end of a step of length dt with velocity gradient L.
  template <int Dim>
  KOKKOS_FUNCTION SymmetricTensor<Dim, Real> advance(const SymmetricTensor<Dim, Real>& sigma,
                                                     Vector<state_size<Dim>(), Real>& state,
                                                     const Matrix<Dim, Real>& L, Real dt) const {
    return advance_plastic(*this, sigma, state, L, dt);
  }

  /// False only where a trial stress is elastic; on packs for every lane.
  template <int Dim, int N, class T>
  KOKKOS_FORCEINLINE_FUNCTION auto may_yield(const SymmetricTensor<Dim, T>& trial,
                                             const Vector<N, T>& state) const {
    const T mean = mean_stress(trial), J2 = second_invariant(trial, mean);
    return outside_cone(J2, mean, T(cone_slope), T(cone_strength)) |
           may_exceed_tension(J2, mean, T(surface.tensile_strength)) | (gap_in<Dim>(state) > T(0));
  }

  /// Returns a trial stress to the yield surface, if it lies beyond.
  template <int Dim>
  [[gnu::noinline]] KOKKOS_FUNCTION void return_stress(SymmetricTensor<Dim, Real>& stress,
                                                       Vector<state_size<Dim>(), Real>& state) const {
    press_into_gap(elastic, stress, state);
    auto principal = principal_stresses(stress);
    auto& value = principal.value;
    int at[3] = {0, 1, 2};  // of the largest, the middle, the smallest
    const auto sort = [&](int a, int b) {
      if (value[at[a]] < value[at[b]]) {
        const int larger = at[b];
        at[b] = at[a];
        at[a] = larger;
      }
    };
    sort(0, 1);
    sort(1, 2);
    sort(0, 1);
    const Vector<3, Real> trial{{value[at[0]], value[at[1]], value[at[2]]}};
    if (!surface.exceeded(trial)) return;
    const auto returned = surface.returned(trial);
    if (surface.apart(returned, trial)) open_gap<Dim>(elastic, mean_stress(stress), state);
    for (int k = 0; k < 3; ++k) value[at[k]] = trial[k] - returned[k];
    release(elastic, from_principal_values(principal), stress, state);
  }

 private:
  static void check(const MohrCoulombConstants& m) {
    const double right_angle = std::acos(0.);
    if (m.cohesion >= 0 && m.friction_angle >= 0 && m.friction_angle < right_angle && m.dilation_angle >= 0 &&
        m.dilation_angle <= m.friction_angle && m.cohesion + m.friction_angle > 0 && m.tensile_strength >= 0)
      return;
    std::ostringstream text;
    text << "vsb::MohrCoulomb: cohesion " << m.cohesion << " Pa, friction angle " << m.friction_angle
         << ", dilation angle " << m.dilation_angle << ", tensile strength " << m.tensile_strength
         << " Pa; allowed are c >= 0, 0 <= psi <= phi < pi/2, not c = phi = 0, and a tensile strength >= 0";
    throw std::invalid_argument(text.str());
  }
};

}  // namespace vsb
