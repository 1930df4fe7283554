// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Principal values and directions of a symmetric tensor in closed form, for stresses that must be taken
/// apart at every step. In a plane that is one Jacobi rotation. In space, with the mean m, the deviator s and
/// r = sqrt(J2 / 3), the values are m + r x with
///   x^3 - 3 x - det(s / r) = 0.
/// The root furthest from the other two, sqrt(3) <= |x| <= 2, is a simple one, found by Newton's method; its
/// direction is orthogonal to the rows of s / r - x I; and what is left is plane. So equal values need no
/// care.
#pragma once

#include <vsb/physics/elastic_cone.hpp>
#include <vsb/physics/symmetric_eigen.hpp>

namespace vsb {

namespace detail {

template <class T>
KOKKOS_INLINE_FUNCTION Vector<3, T> cross(const Vector<3, T>& a, const Vector<3, T>& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

/// The root of x^3 - 3 x = 2 q that is furthest from the others, for |q| <= 1.
template <class T>
KOKKOS_INLINE_FUNCTION T separate_root(T q) {
  const T size = math::min(math::abs(q), T(1));
  // Within 0.004 on the line between the roots for |q| = 0 and 1, and every iteration squares the error.
  constexpr T sqrt_3 = T(1.7320508075688772);
  T x = sqrt_3 + (T(2) - sqrt_3) * size;
  for (int n = 0; n < 3; ++n) x -= ((x * x - T(3)) * x - T(2) * size) / (T(3) * (x * x - T(1)));
  return q < T(0) ? -x : x;
}

/// The unit vector orthogonal to the rows of a symmetric tensor of rank 2.
template <class T>
KOKKOS_INLINE_FUNCTION Vector<3, T> null_direction(const Matrix<3, T>& a) {
  Vector<3, T> row[3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) row[i][j] = a(i, j);
  auto n = cross(row[0], row[1]);
  for (const auto& other : {cross(row[1], row[2]), cross(row[2], row[0])})
    if (dot(other, other) > dot(n, n)) n = other;
  return (T(1) / math::sqrt(dot(n, n))) * n;
}

}  // namespace detail

/// As principal_values.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION PrincipalValues<Dim, T> principal_stresses(const SymmetricTensor<Dim, T>& stress) {
  if constexpr (Dim < 3) {
    return principal_values(stress);
  } else {
    const T mean = mean_stress(stress), r = math::sqrt(second_invariant(stress, mean) / T(3));
    if (!(r > T(0)) || !math::isfinite(r))
      return {{{stress[0], stress[1], stress[2]}}, Matrix<3, T>::identity()};
    Matrix<3, T> s;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) s(i, j) = (stress(i, j) - (i == j ? mean : T(0))) / r;
    const T x = detail::separate_root(T(0.5) * determinant(s));
    auto shifted = s;
    for (int i = 0; i < 3; ++i) shifted(i, i) -= x;
    const auto n = detail::null_direction(shifted);
    // Two directions across n, the first one orthogonal to the axis that is furthest from n.
    int least = 0;
    for (int i = 1; i < 3; ++i)
      if (math::abs(n[i]) < math::abs(n[least])) least = i;
    Vector<3, T> axis = Vector<3, T>::zero();
    axis[least] = T(1);
    auto u = detail::cross(n, axis);
    u *= T(1) / math::sqrt(dot(u, u));
    const auto w = detail::cross(n, u);
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
