// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The Mohr-Coulomb yield surface with tension cut-off in sorted principal stresses s1 >= s2 >= s3, and the
/// return of a trial stress to it.
///
/// The surface is made of planes n_i . s = k_i with flow directions m_i. Where the planes of a set A are
/// active,
///   s = s_trial - sum_j lambda_j D m_j,   n_i . s = k_i for i in A,   lambda_j >= 0,
/// D being the elastic stiffness among principal directions. The return is the set whose solution satisfies
/// all this, keeps the order of the principal stresses and lies within the surface: the main plane, an edge
/// or a vertex. For psi = phi it is the point of the surface that is closest to the trial stress in the
/// energy norm.
#pragma once

#include <vsb/views/tensor.hpp>

namespace vsb {

/// The yield surface f <= 0, s1 <= tensile strength of physics/mohr_coulomb.hpp.
template <class Real>
struct MohrCoulombSurface {
  Real coupling;  ///< nu / (1 - 2 nu): D / (2 mu) v = v + coupling (v1 + v2 + v3) (1, 1, 1)
  ///@{
  /// sin(phi) and sin(psi), 0 <= psi <= phi < pi/2.
  Real sin_friction, sin_dilation;
  ///@}
  Real strength;          ///< 2 c cos(phi), Pa
  Real apex;              ///< c cot(phi), Pa; infinite without friction
  Real tensile_strength;  ///< Pa, below the apex; infinite: no cut-off

  /// Whether principal stresses lie beyond the surface.
  KOKKOS_FUNCTION bool exceeded(const Vector<3, Real>& s) const {
    return s[0] - s[2] + sin_friction * (s[0] + s[2]) > strength || s[0] > tensile_strength;
  }

  /// Whether `returned`, to which a trial stress returned, is the apex of a surface that ends at zero stress.
  KOKKOS_FUNCTION bool apart(const Vector<3, Real>& returned, const Vector<3, Real>& trial) const {
    return math::min(apex, tensile_strength) == Real(0) && returned[2] >= -round_off(trial);
  }

  /// The point of the surface to which a trial stress beyond it returns. Both are sorted, s1 >= s2 >= s3, in
  /// Pa.
  KOKKOS_FUNCTION Vector<3, Real> returned(const Vector<3, Real>& trial) const {
    // The main plane f(s1, s3), then the edges s2 = s3 and s1 = s2 of the pyramid; then the faces, edges and
    // vertices of the cut-off, alone and with the pyramid. At the vertex s1 = s2 = tensile strength four
    // planes meet, of which a sorted trial stress needs one of two sets of three.
    Vector<3, Real> s;
    if (solve<1>(trial, {main}, s) || solve<2>(trial, {main, right}, s) || solve<2>(trial, {main, left}, s))
      return s;
    if (tensile_strength < apex &&
        (solve<1>(trial, {tension_1}, s) || solve<2>(trial, {main, tension_1}, s) ||
         solve<2>(trial, {tension_1, tension_2}, s) || solve<3>(trial, {main, right, tension_1}, s) ||
         solve<3>(trial, {main, tension_1, tension_2}, s) || solve<3>(trial, {main, left, tension_1}, s) ||
         solve<3>(trial, {tension_1, tension_2, tension_3}, s)))
      return s;
    // The apex, also where no flow direction leads to it (psi = 0): no other state is admissible.
    const Real vertex = math::min(apex, tensile_strength);
    return vertex < math::infinity<Real> ? Vector<3, Real>{{vertex, vertex, vertex}} : trial;
  }

 private:
  /// Of the stresses to which `trial` may return, Pa.
  KOKKOS_FUNCTION Real round_off(const Vector<3, Real>& trial) const {
    return 64 * math::epsilon<Real> * (math::abs(trial[0]) + math::abs(trial[2]) + strength);
  }

  enum : int { main, right, left, tension_1, tension_2, tension_3 };
  struct Plane {
    Vector<3, Real> normal, flow;
    Real limit;
  };

  KOKKOS_FUNCTION Plane plane(int which) const {
    Plane p{Vector<3, Real>::zero(), Vector<3, Real>::zero(), tensile_strength};
    if (which >= tension_1) {
      p.normal[which - tension_1] = p.flow[which - tension_1] = 1;
      return p;
    }
    const int larger = which == left ? 1 : 0, smaller = which == right ? 1 : 2;
    p.normal[larger] = 1 + sin_friction;
    p.normal[smaller] = sin_friction - 1;
    p.flow[larger] = 1 + sin_dilation;
    p.flow[smaller] = sin_dilation - 1;
    p.limit = strength;
    return p;
  }

  /// The stress with the planes of a set active. Returns whether it satisfies all conditions.
  template <int Count>
  KOKKOS_FUNCTION bool solve(const Vector<3, Real>& trial, const int (&set)[Count],
                             Vector<3, Real>& s) const {
    Vector<3, Real> normal[Count], step[Count];  // step: D m_j / (2 mu), so that multipliers are stresses
    Vector<Count, Real> excess;
    for (int j = 0; j < Count; ++j) {
      const Plane p = plane(set[j]);
      normal[j] = p.normal;
      const Real isotropic = coupling * (p.flow[0] + p.flow[1] + p.flow[2]);
      for (int k = 0; k < 3; ++k) step[j][k] = p.flow[k] + isotropic;
      excess[j] = dot(p.normal, trial) - p.limit;
    }
    Matrix<Count, Real> A;
    for (int i = 0; i < Count; ++i)
      for (int j = 0; j < Count; ++j) A(i, j) = dot(normal[i], step[j]);
    const auto multiplier = inverse(A) * excess;
    const Real round_off = this->round_off(trial);
    s = trial;
    for (int j = 0; j < Count; ++j) {
      if (!(multiplier[j] >= -round_off)) return false;
      s -= multiplier[j] * step[j];
    }
    return s[0] >= s[1] - round_off && s[1] >= s[2] - round_off &&
           s[0] - s[2] + sin_friction * (s[0] + s[2]) <= strength + round_off &&
           s[0] <= tensile_strength + round_off;
  }
};

}  // namespace vsb
