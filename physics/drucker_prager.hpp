// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Drucker-Prager plasticity with dilation and linear hardening of the cohesion, in rate form:
///   f = sqrt(J2) + eta sigma_m - xi (c + H kappa) <= 0,
/// sigma_m being the mean stress, tension positive, and J2 the second invariant of the deviator s. The
/// plastic strain rate is dlambda (s / (2 sqrt(J2)) + eta_bar / 3 I), and dkappa = xi dlambda. Von Mises
/// plasticity with linear isotropic hardening is eta = eta_bar = 0, xi = 1 / sqrt(3) and c = yield stress:
/// kappa is then the equivalent plastic strain.
#pragma once

#include <cmath>
#include <vsb/physics/elastic_cone.hpp>
#include <vsb/physics/gap.hpp>
#include <vsb/physics/plastic_strain.hpp>

namespace vsb {

/// How the cone fits the Mohr-Coulomb pyramid: it touches the outer edges (triaxial compression), the inner
/// edges (triaxial extension), or gives the same collapse load in plane strain.
enum class DruckerPragerCone { outer, inner, plane_strain };

/// What a Drucker-Prager material is made from; angles in radians.
struct DruckerPragerConstants {
  ///@{
  /// E > 0 in Pa, and -1 < nu < 1/2.
  double youngs_modulus, poisson_ratio;
  ///@}
  double cohesion;                                    ///< c, Pa
  double friction_angle = 0;                          ///< phi
  double dilation_angle = 0;                          ///< psi
  double hardening_modulus = 0;                       ///< H, Pa: increase of the cohesion per kappa
  DruckerPragerCone cone = DruckerPragerCone::outer;  ///< how the cone fits the pyramid
};

/// A Drucker-Prager or von Mises material; the equations are at the top of this file. Its state per particle
/// is the plastic strain, the gap of physics/gap.hpp, and kappa.
template <class Real>
struct DruckerPrager {
  static constexpr bool plastic = true;  ///< see material.hpp

  LinearElastic<Real> elastic;  ///< law of the trial stress
  Real friction;                ///< eta
  Real dilation;                ///< eta_bar
  Real cohesion_factor;         ///< xi
  Real cohesion;                ///< c, Pa; von Mises: the yield stress
  Real hardening_modulus;       ///< H, Pa

  /// Throws std::invalid_argument unless E and nu suit LinearElastic, c >= 0, 0 <= psi <= phi < pi/2, c and
  /// phi are not both zero, and H >= 0.
  static DruckerPrager from(const DruckerPragerConstants& m) {
    check(m);
    const auto friction = factors(m.friction_angle, m.cone), dilation = factors(m.dilation_angle, m.cone);
    return {LinearElastic<Real>::from_young(m.youngs_modulus, m.poisson_ratio),
            static_cast<Real>(friction.eta),
            static_cast<Real>(dilation.eta),
            static_cast<Real>(friction.xi),
            static_cast<Real>(m.cohesion),
            static_cast<Real>(m.hardening_modulus)};
  }

  /// Throws std::invalid_argument unless the yield stress is positive and H >= 0, Pa; and as LinearElastic.
  static DruckerPrager von_mises(double youngs_modulus, double poisson_ratio, double yield_stress,
                                 double hardening_modulus) {
    check({youngs_modulus, poisson_ratio, yield_stress, 0, 0, hardening_modulus, {}});
    return {LinearElastic<Real>::from_young(youngs_modulus, poisson_ratio),
            0,
            0,
            static_cast<Real>(std::sqrt(1. / 3)),
            static_cast<Real>(yield_stress),
            static_cast<Real>(hardening_modulus)};
  }

  /// Numbers to remember per particle: the plastic strain, the gap and kappa.
  template <int Dim>
  KOKKOS_FUNCTION static constexpr int state_size() {
    return symmetric_components(Dim) + 2;
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

  /// Whether a trial stress is beyond the cone; on packs for every lane.
  template <int Dim, int N, class T>
  KOKKOS_FORCEINLINE_FUNCTION auto may_yield(const SymmetricTensor<Dim, T>& trial,
                                             const Vector<N, T>& state) const {
    const T mean = mean_stress(trial);
    return outside_cone(second_invariant(trial, mean), mean, T(friction), strength(state[N - 1])) |
           (gap_in<Dim>(state) > T(0));
  }

  /// Returns a trial stress beyond the cone to it: along the flow direction, or to the apex.
  template <int Dim>
  [[gnu::noinline]] KOKKOS_FUNCTION void return_stress(SymmetricTensor<Dim, Real>& stress,
                                                       Vector<state_size<Dim>(), Real>& state) const {
    press_into_gap(elastic, stress, state);
    Real& kappa = state[state_size<Dim>() - 1];
    const Real mean = mean_stress(stress), J = math::sqrt(second_invariant(stress, mean));
    const Real G = elastic.shear_modulus, K = elastic.bulk_modulus();
    const Real hardening = cohesion_factor * cohesion_factor * hardening_modulus;
    const Real beyond = J + friction * mean - strength(kappa);
    if (!(beyond > 0)) return;
    // The decrease of the deviator, as a share, and of the mean stress.
    Real multiplier = beyond / (G + K * friction * dilation + hardening);
    Real share = G * multiplier / J, mean_excess = K * dilation * multiplier;
    if (!(G * multiplier <= J)) {  // the apex: friction (mean - K dilation multiplier) = strength
      share = 1;
      multiplier = dilation > 0
                       ? (friction * mean - strength(kappa)) / (K * friction * dilation + hardening)
                       : J / G;  // the flow direction misses the apex; hardening by the deviator alone
      // Without friction there is no apex: here round-off has taken the whole deviator.
      const Real left = strength(kappa + cohesion_factor * multiplier);
      mean_excess = friction > 0 ? mean - left / friction : Real(0);
      if (friction > 0 && left == Real(0)) open_gap<Dim>(elastic, mean, state);
    }
    kappa += cohesion_factor * multiplier;
    auto excess = share * stress;
    for (int i = 0; i < 3; ++i) excess[i] += mean_excess - share * mean;
    release(elastic, excess, stress, state);
  }

 private:
  template <class T>
  KOKKOS_FORCEINLINE_FUNCTION T strength(T kappa) const {
    return T(cohesion_factor) * (T(cohesion) + T(hardening_modulus) * kappa);
  }

  struct Factors {
    double eta, xi;
  };
  static Factors factors(double angle, DruckerPragerCone cone) {
    const double sine = std::sin(angle), cosine = std::cos(angle), tangent = std::tan(angle);
    if (cone == DruckerPragerCone::plane_strain) {
      const double root = std::sqrt(9 + 12 * tangent * tangent);
      return {3 * tangent / root, 3 / root};
    }
    const double below = std::sqrt(3.) * (3 + (cone == DruckerPragerCone::inner ? sine : -sine));
    return {6 * sine / below, 6 * cosine / below};
  }

  static void check(const DruckerPragerConstants& m) {
    const double right_angle = std::acos(0.);
    if (m.cohesion >= 0 && m.friction_angle >= 0 && m.friction_angle < right_angle && m.dilation_angle >= 0 &&
        m.dilation_angle <= m.friction_angle && m.cohesion + m.friction_angle > 0 && m.hardening_modulus >= 0)
      return;
    std::ostringstream text;
    text << "vsb::DruckerPrager: cohesion or yield stress " << m.cohesion << " Pa, friction angle "
         << m.friction_angle << ", dilation angle " << m.dilation_angle << ", hardening modulus "
         << m.hardening_modulus
         << " Pa; allowed are c >= 0, 0 <= psi <= phi < pi/2, not c = phi = 0, and H >= 0";
    throw std::invalid_argument(text.str());
  }
};

}  // namespace vsb
