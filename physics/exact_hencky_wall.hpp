// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Exact solution of the thick-walled cylinder in plane strain, or the hollow sphere, of Hencky material
/// (physics/hencky.hpp) under internal pressure at any strain, about the centre; the outer face is free. A
/// particle that was at R is at r; with the stretches a = dr / dR and b = r / R, J = a b^k, k = 1 for the
/// cylinder and 2 for the sphere,
///   J sigma_rr = lambda ln J + 2 mu ln a,   J sigma_tt = lambda ln J + 2 mu ln b,
///   d sigma_rr / dr = -k (sigma_rr - sigma_tt) / r.
/// The radius of the hole is that with which sigma_rr, integrated from -p at the hole (Runge and Kutta's
/// method of fourth order), vanishes at the outer face.
#pragma once

#include <limits>
#include <vsb/physics/polar.hpp>

namespace vsb {

/// Radial places and stresses of the wall; the equations are at the top of this file.
template <class T>
struct ExactHenckyWall {
  T inner_radius;   ///< of the undeformed wall, m
  T outer_radius;   ///< of the undeformed wall, m
  T pressure;       ///< p in the hole, Pa, positive in compression
  T lambda;         ///< Lame's first parameter, Pa
  T shear_modulus;  ///< mu, Pa
  int hoops;        ///< k, directions around the centre: 1: cylinder, 2: sphere

  /// At the current radius r.
  struct State {
    T initial_radius;       ///< R, m
    PolarStress<T> stress;  ///< Pa, tension positive
    T axial_stress;         ///< of the cylinder, sigma_zz, Pa; of the sphere sigma_tt
  };

  /// The radius of the hole under the pressure, m; not a number where none up to `largest` times the initial
  /// one gives equilibrium.
  T hole_radius(T largest = T(3)) const {
    constexpr int parts = 200;
    T low = inner_radius, excess = outer_stress(low);
    for (int n = 1; n <= parts; ++n) {  // the smallest one: beyond the limit load there are others, unstable
      const T high = inner_radius * (1 + (largest - 1) * T(n) / T(parts));
      const T there = outer_stress(high);
      if (!(there == there)) break;
      if (excess <= T(0) && there >= T(0)) return root_between(low, high);
      low = high;
      excess = there;
    }
    return std::numeric_limits<T>::quiet_NaN();
  }

  /// With `hole` from hole_radius().
  State at(T r, T hole) const {
    T R = inner_radius, rr = -pressure;
    const T step = (r - hole) / steps;
    for (int n = 0; n < steps; ++n) {
      const auto slope = [&](T x, T initial, T s) {
        const T a = radial_stretch(s, x / initial);
        return Rates{1 / a, stress_slope(s, x, a, x / initial)};
      };
      advance(slope, hole + T(n) * step, step, R, rr);
    }
    const T b = r / R, a = radial_stretch(rr, b);
    const T tt = hoop_stress(a, b);
    return {R, {rr, tt, T(0)}, hoops == 2 ? tt : lambda * math::log(a * b) / (a * b)};
  }

 private:
  static constexpr int steps = 64;
  struct Rates {
    T place, stress;
  };

  /// sigma_rr at the outer face for a radius of the hole.
  T outer_stress(T hole) const {
    T r = hole, rr = -pressure;
    const T step = (outer_radius - inner_radius) / steps;
    for (int n = 0; n < steps; ++n) {
      const auto slope = [&](T R, T x, T s) {
        const T a = radial_stretch(s, x / R);
        return Rates{a, a * stress_slope(s, x, a, x / R)};
      };
      advance(slope, inner_radius + T(n) * step, step, r, rr);
    }
    return rr;
  }
  T root_between(T low, T high) const {
    while (true) {
      const T middle = low + (high - low) / 2;
      if (!(middle > low && middle < high)) return high;
      (outer_stress(middle) < T(0) ? low : high) = middle;
    }
  }
  /// A step of Runge and Kutta's method for place and stress along t; slope(t, place, stress).
  template <class Slope>
  static void advance(const Slope& slope, T t, T step, T& place, T& stress) {
    const T half = step / 2;
    const Rates k1 = slope(t, place, stress),
                k2 = slope(t + half, place + half * k1.place, stress + half * k1.stress),
                k3 = slope(t + half, place + half * k2.place, stress + half * k2.stress),
                k4 = slope(t + step, place + step * k3.place, stress + step * k3.stress);
    place += step / 6 * (k1.place + 2 * (k2.place + k3.place) + k4.place);
    stress += step / 6 * (k1.stress + 2 * (k2.stress + k3.stress) + k4.stress);
  }
  /// a from sigma_rr and b, by Newton's method for ln a.
  T radial_stretch(T rr, T b) const {
    const T around = T(hoops) * math::log(b);
    T x = 0;
    for (int n = 0; n < 60; ++n) {
      const T pull = rr * math::exp(x + around);
      const T change =
          (lambda * (x + around) + 2 * shear_modulus * x - pull) / (lambda + 2 * shear_modulus - pull);
      x -= change;
      if (math::abs(change) < T(1e-15)) break;
    }
    return math::exp(x);
  }
  T volume_ratio(T a, T b) const { return hoops == 2 ? a * b * b : a * b; }
  T hoop_stress(T a, T b) const {
    const T J = volume_ratio(a, b);
    return (lambda * math::log(J) + 2 * shear_modulus * math::log(b)) / J;
  }
  /// d sigma_rr / dr.
  T stress_slope(T rr, T r, T a, T b) const { return -T(hoops) * (rr - hoop_stress(a, b)) / r; }
};

}  // namespace vsb
