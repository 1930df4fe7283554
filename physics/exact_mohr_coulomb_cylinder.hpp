// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Exact solution of the thick-walled cylinder of elastic-perfectly plastic Mohr-Coulomb material in plane
/// strain under internal pressure p, at small strain, about the origin; the outer face is free. The least
/// principal stress is sigma_rr and the largest sigma_tt. Within the plastic radius rho
///   sigma_tt (1 + sin(phi)) - sigma_rr (1 - sin(phi)) = 2 c cos(phi)   and   r dsigma_rr / dr = sigma_tt -
///   sigma_rr
/// give
///   sigma_rr = c cot(phi) - (p + c cot(phi)) (a / r)^beta,   beta = 2 sin(phi) / (1 + sin(phi)),
/// and outside it there is the elastic cylinder of inner radius rho, which is about to yield under
///   q(rho) = c cos(phi) (b^2 / rho^2 - 1) / (b^2 / rho^2 + sin(phi)).
/// The stresses do not depend on the dilation angle.
#pragma once

#include <vsb/physics/polar.hpp>

namespace vsb {

/// Stress and plastic radius of the cylinder; the equations are at the top of this file.
template <class T>
struct ExactMohrCoulombCylinder {
  T inner_radius;    ///< a, m
  T outer_radius;    ///< b, m
  T pressure;        ///< p in the hole, Pa, positive in compression; less than the collapse pressure
  T cohesion;        ///< c, Pa
  T friction_angle;  ///< phi, radians
  T poisson_ratio;   ///< nu

  /// The pressure at which the hole begins to yield, Pa.
  T yield_pressure() const { return holding_pressure(inner_radius); }

  /// The pressure at which all of it yields, Pa.
  T collapse_pressure() const { return pressure_to_yield_up_to(outer_radius); }

  /// rho, m; the inner radius below the yield pressure, the outer one beyond the collapse pressure.
  T plastic_radius() const {
    T low = inner_radius, high = outer_radius;
    while (true) {  // the pressure at which yield extends to a radius grows with the radius
      const T middle = low + (high - low) / 2;
      if (!(middle > low && middle < high)) return pressure <= yield_pressure() ? inner_radius : high;
      (pressure_to_yield_up_to(middle) < pressure ? low : high) = middle;
    }
  }

  /// sigma_rr and sigma_tt at a radius, with rho from plastic_radius(), Pa, tension positive.
  PolarStress<T> stress(T r, T rho) const {
    const T sine = math::sin(friction_angle), cosine = math::cos(friction_angle);
    if (r < rho) {
      const T rr = -pressure_at(r);
      return {rr, (2 * cohesion * cosine + (1 - sine) * rr) / (1 + sine), T(0)};
    }
    const T q = rho > inner_radius ? holding_pressure(rho) : pressure, b = outer_radius / r,
            B = outer_radius / rho;
    const T scale = q / (B * B - 1);
    return {scale * (1 - b * b), scale * (1 + b * b), T(0)};
  }

  /// The pressure beyond which sigma_zz would be the largest principal stress at the hole, so that this
  /// solution is not valid, Pa; infinite where there is none.
  T largest_pressure() const {
    const T sine = math::sin(friction_angle), nu = poisson_ratio;
    const T share = (1 - nu) * (1 - sine) - nu * (1 + sine);
    if (!(share > 0)) return math::infinity<T>;
    return 2 * (1 - nu) * cohesion * math::cos(friction_angle) / share;
  }

  /// sigma_zz, the intermediate principal stress: nothing yields along z.
  T axial_stress(const PolarStress<T>& s) const { return poisson_ratio * (s.rr + s.tt); }

 private:
  /// q(rho).
  T holding_pressure(T rho) const {
    const T B = outer_radius / rho;
    return cohesion * math::cos(friction_angle) * (B * B - 1) / (B * B + math::sin(friction_angle));
  }
  /// -sigma_rr at a radius within rho.
  T pressure_at(T r) const {
    const T l = math::log(r / inner_radius);
    if (friction_angle == 0) return pressure - 2 * cohesion * l;
    const T top = apex();
    return (pressure + top) * math::exp(-exponent() * l) - top;
  }
  /// The pressure for which -sigma_rr = q(rho) at rho.
  T pressure_to_yield_up_to(T rho) const {
    const T l = math::log(rho / inner_radius), q = holding_pressure(rho);
    if (friction_angle == 0) return q + 2 * cohesion * l;
    const T top = apex();
    return (q + top) * math::exp(exponent() * l) - top;
  }
  T apex() const { return cohesion * math::cos(friction_angle) / math::sin(friction_angle); }
  T exponent() const {
    const T sine = math::sin(friction_angle);
    return 2 * sine / (1 + sine);
  }
};

}  // namespace vsb
