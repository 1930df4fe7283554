// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Stress fields sbar(x) with their exact divergence fbar = div sbar, one small value type each. A field need
/// not be in equilibrium: fbar enters the nodal forces as a body force, Eq. (27). physics/fields.md explains
/// how to choose a field.
#pragma once

#include <vsb/physics/virtual_stress.hpp>

namespace vsb {

/// The same stress everywhere.
template <int Dim, class T>
struct UniformStress {
  SymmetricTensor<Dim, T> stress;  ///< Pa, tension positive

  /// The field and its divergence, at any x.
  KOKKOS_FUNCTION VirtualStressValue<Dim, T> at(const Vector<Dim, T>&) const {
    return {stress, Vector<Dim, T>::zero()};
  }
};

/// sbar = value + sum_k gradient[k] x_k, so that fbar_i = sum_k gradient[k]_ik.
template <int Dim, class T>
struct AffineStress {
  SymmetricTensor<Dim, T> value;          ///< at the origin, Pa, tension positive
  SymmetricTensor<Dim, T> gradient[Dim];  ///< d sbar / d x_k, Pa/m

  /// The field and its divergence at x in m.
  KOKKOS_FUNCTION VirtualStressValue<Dim, T> at(const Vector<Dim, T>& x) const {
    VirtualStressValue<Dim, T> bar{value, Vector<Dim, T>::zero()};
    for (int k = 0; k < Dim; ++k) {
      bar.stress += x[k] * gradient[k];
      for (int i = 0; i < Dim; ++i) bar.divergence[i] += gradient[k](i, k);
    }
    return bar;
  }
};

/// A fluid at rest below its free surface: sbar = -gamma D I, fbar = gamma D' up. D is the depth with the
/// kink at the free surface averaged over `width`, the particles' spacing along `up`:
///   D = d for d >= w/2,  (d + w/2)^2 / (2 w) for |d| < w/2,  0 for d <= -w/2,
/// with the depth d of x. D' is the part of the width that is under water. The buoyancy of a column of
/// particles is therefore the weight of the water that it displaces. The averaging leaves a pressure of gamma
/// w / 8 at the free surface. w = 0: no averaging; a particle is under water or not.
template <int Dim, class T>
struct HydrostaticStress {
  T unit_weight;      ///< gamma, N/m^3
  T level;            ///< of the free surface: x . up, m
  T width;            ///< w, m
  Vector<Dim, T> up;  ///< unit vector

  /// The field and its divergence at x in m.
  KOKKOS_FUNCTION VirtualStressValue<Dim, T> at(const Vector<Dim, T>& x) const {
    const T d = level - dot(x, up), above = d + width / 2;
    const bool dry = above <= T(0), wet = d >= width / 2;
    const T depth = dry ? T(0) : wet ? d : above * above / (2 * width);
    const T slope = dry ? T(0) : wet ? T(1) : above / width;
    return {pressure_stress<Dim>(unit_weight * depth), unit_weight * slope * up};
  }
};

/// From one stress at an inner radius to another at an outer one, linear in between and constant beyond:
///   sbar = S_outer + phi (S_inner - S_outer),  phi = (b - r) / (b - a),
///   fbar = -1 / (b - a) (S_inner - S_outer) e_r  between a and b.
/// r counts the directions of `across` alone: all of them (a circle, a sphere, in 1D two planes), or those
/// normal to an axis.
template <int Dim, class T>
struct RadialBlend {
  Vector<Dim, T> center;  ///< m
  Vector<Dim, T> across;  ///< 1, or 0 for the direction of the axis
  ///@{
  /// a < b, m.
  T inner_radius, outer_radius;
  ///@}
  ///@{
  /// S_inner and S_outer, Pa, tension positive.
  SymmetricTensor<Dim, T> inner, outer;
  ///@}

  /// The field and its divergence at x in m.
  KOKKOS_FUNCTION VirtualStressValue<Dim, T> at(const Vector<Dim, T>& x) const {
    Vector<Dim, T> from_axis;
    for (int i = 0; i < Dim; ++i) from_axis[i] = across[i] * (x[i] - center[i]);
    const T r = math::sqrt(dot(from_axis, from_axis));
    if (r <= inner_radius) return {inner, Vector<Dim, T>::zero()};
    if (r >= outer_radius) return {outer, Vector<Dim, T>::zero()};
    const auto difference = inner - outer;
    const T slope = T(-1) / (outer_radius - inner_radius);
    return {outer + (slope * (r - outer_radius)) * difference, (slope / r) * (difference * from_axis)};
  }
};

/// From one stress at a plane to another at a parallel one, linear in between and constant beyond.
template <int Dim, class T>
struct PlanarBlend {
  Vector<Dim, T> start;   ///< a point of the first plane, m
  Vector<Dim, T> across;  ///< from plane to plane along their normal, m
  ///@{
  /// On the first plane and before it, and on the second and beyond; Pa, tension positive.
  SymmetricTensor<Dim, T> at_start, at_end;
  ///@}

  /// The field and its divergence at x in m.
  KOKKOS_FUNCTION VirtualStressValue<Dim, T> at(const Vector<Dim, T>& x) const {
    const T length2 = dot(across, across);
    const T s = dot(x - start, across) / length2;
    if (s <= T(0)) return {at_start, Vector<Dim, T>::zero()};
    if (s >= T(1)) return {at_end, Vector<Dim, T>::zero()};
    const auto difference = at_end - at_start;
    return {at_start + s * difference, (T(1) / length2) * (difference * across)};
  }
};

}  // namespace vsb
