// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Principal values and directions of a symmetric tensor in closed form, for stresses that are decomposed at
/// every step. In a plane this is one Jacobi rotation. In space, with the mean m, the deviator s and
/// r = sqrt(J2 / 3), the values are m + r x with
///   x^3 - 3 x - det(s / r) = 0.
/// The root furthest from the other two, sqrt(3) <= |x| <= 2, is a simple one; an iteration finds it. Its
/// direction is orthogonal to the rows of s / r - x I. The other two are a problem in the plane orthogonal to
/// it. Equal values need no special treatment.
#pragma once

#include <vsb/physics/elastic_cone.hpp>
#include <vsb/physics/symmetric_eigen.hpp>

namespace vsb {

namespace detail {

/// The root of x^3 - 3 x = 2 q that is furthest from the others, for |q| <= 1.
template <class T>
KOKKOS_INLINE_FUNCTION T separate_root(T q) {
  const T size = math::min(math::abs(q), T(1));
  // Within 0.004 on the line between the roots for |q| = 0 and 1; Halley's iteration cubes the error.
  constexpr T sqrt_3 = T(1.7320508075688772);
  T x = sqrt_3 + (T(2) - sqrt_3) * size;
  for (int n = 0; n < 2; ++n) {
    const T f = (x * x - T(3)) * x - T(2) * size, slope = T(3) * (x * x - T(1));
    x -= f * slope / (slope * slope - T(3) * x * f);
  }
  return q < T(0) ? -x : x;
}

/// The unit vector orthogonal to the rows of a symmetric tensor of rank 2, whose cofactors are a multiple of
/// n (x) n: their largest column.
template <class T>
KOKKOS_INLINE_FUNCTION Vector<3, T> null_direction(const Matrix<3, T>& a) {
  const auto c = cofactor(a);
  Vector<3, T> n{{c(0, 0), c(1, 0), c(2, 0)}};
  T largest = math::abs(c(0, 0));
  for (int j = 1; j < 3; ++j) {
    const bool larger = math::abs(c(j, j)) > largest;
    for (int i = 0; i < 3; ++i) n[i] = larger ? c(i, j) : n[i];
    largest = larger ? math::abs(c(j, j)) : largest;
  }
  return (T(1) / math::sqrt(dot(n, n))) * n;
}

/// Two unit vectors orthogonal to n and to each other, without a branch (Duff et al., Building an
/// orthonormal basis, revisited, 2017).
template <class T>
KOKKOS_INLINE_FUNCTION void across(const Vector<3, T>& n, Vector<3, T>& u, Vector<3, T>& w) {
  const T sign = n[2] < T(0) ? T(-1) : T(1), a = T(-1) / (sign + n[2]), b = n[0] * n[1] * a;
  u = {{T(1) + sign * n[0] * n[0] * a, sign * b, -sign * n[0]}};
  w = {{b, sign + n[1] * n[1] * a, -n[1]}};
}

}  // namespace detail

/// As principal_values.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION PrincipalValues<Dim, T> principal_stresses(const SymmetricTensor<Dim, T>& stress) {
  if constexpr (Dim < 3) {
    return principal_values(stress);
  } else {
    const T mean = mean_stress(stress), r = math::sqrt(second_invariant(stress, mean) / T(3));
    const T inverse_r = T(1) / r;
    if (!(r > T(0)) || !math::isfinite(r) || !math::isfinite(inverse_r))
      return {{{stress[0], stress[1], stress[2]}}, Matrix<3, T>::identity()};
    Matrix<3, T> s;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) s(i, j) = (stress(i, j) - (i == j ? mean : T(0))) * inverse_r;
    const T x = detail::separate_root(T(0.5) * determinant(s));
    auto shifted = s;
    for (int i = 0; i < 3; ++i) shifted(i, i) -= x;
    const auto n = detail::null_direction(shifted);
    Vector<3, T> u, w;
    detail::across(n, u, w);
    const auto su = s * u, sw = s * w;
    Matrix<2, T> plane{{{dot(u, su), dot(u, sw)}, {dot(u, sw), dot(w, sw)}}}, turn = Matrix<2, T>::identity();
    detail::jacobi_rotation(plane, turn, 0, 1);
    PrincipalValues<3, T> result;
    const T value[3] = {dot(n, s * n), plane(0, 0), plane(1, 1)};
    for (int k = 0; k < 3; ++k) {
      result.value[k] = mean + r * value[k];
      result.direction(k, 0) = n[k];
      for (int c = 0; c < 2; ++c) result.direction(k, 1 + c) = u[k] * turn(0, c) + w[k] * turn(1, c);
    }
    return result;
  }
}

}  // namespace vsb
