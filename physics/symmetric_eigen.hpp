// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Principal values and directions of a symmetric tensor by Jacobi rotations, and tensors from them:
///   s = sum_k value_k n_k (x) n_k.
/// Rotations are orthogonal to round-off for all values, so that equal values need no special treatment. The
/// error of each value is round-off of the largest. In a plane one rotation is exact.
#pragma once

#include <vsb/views/tensor.hpp>

namespace vsb {

/// Values 0, ..., Dim - 1 belong to the in-plane directions, the columns of `direction`; the others to the
/// axes left out. They are not sorted.
template <int Dim, class T>
struct PrincipalValues {
  Vector<3, T> value;        ///< in the unit of the tensor
  Matrix<Dim, T> direction;  ///< column k: the unit vector n_k
};

namespace detail {

/// Turns the axes p and q so that a(p, q) vanishes, and the columns of n with them.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void jacobi_rotation(Matrix<Dim, T>& a, Matrix<Dim, T>& n, int p, int q) {
  const T off = a(p, q);
  if (off == T(0)) return;
  // tan of the smaller angle: t^2 + 2 t d - 1 = 0 with d = (a_qq - a_pp) / (2 a_pq), without overflow.
  const T half_gap = (a(q, q) - a(p, p)) / 2;
  const T scale = math::max(math::abs(half_gap), math::abs(off));
  const T x = half_gap / scale, y = off / scale;
  const T root = math::abs(x) + math::sqrt(x * x + y * y);
  const T t = (x < T(0) ? -y : y) / root;
  const T c = T(1) / math::sqrt(T(1) + t * t), s = t * c;
  a(p, p) -= t * off;
  a(q, q) += t * off;
  a(p, q) = a(q, p) = T(0);
  for (int k = 0; k < Dim; ++k) {
    if (k != p && k != q) {
      const T kp = a(k, p), kq = a(k, q);
      a(k, p) = a(p, k) = c * kp - s * kq;
      a(k, q) = a(q, k) = s * kp + c * kq;
    }
    const T np = n(k, p), nq = n(k, q);
    n(k, p) = c * np - s * nq;
    n(k, q) = s * np + c * nq;
  }
}

}  // namespace detail

/// The principal values of s and their directions.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION PrincipalValues<Dim, T> principal_values(const SymmetricTensor<Dim, T>& s) {
  PrincipalValues<Dim, T> result;
  auto& n = result.direction = Matrix<Dim, T>::identity();
  Matrix<Dim, T> a;
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) a(i, j) = s(i, j);
  // Convergence is quadratic, in 4 or 5 sweeps. The bound ends the loop for values that are not finite.
  constexpr int most_sweeps = Dim == 3 ? 12 : 1;
  if constexpr (Dim > 1) {
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      T on = T(0), off = T(0);
      for (int i = 0; i < Dim; ++i) {
        on += math::abs(a(i, i));
        for (int j = i + 1; j < Dim; ++j) off += math::abs(a(i, j));
      }
      if (on + off == on) break;
      for (int p = 0; p < Dim; ++p)
        for (int q = p + 1; q < Dim; ++q) detail::jacobi_rotation(a, n, p, q);
    }
  }
  for (int i = 0; i < 3; ++i) result.value[i] = i < Dim ? a(i % Dim, i % Dim) : s[i];
  return result;
}

/// The tensor with given principal values and directions.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION SymmetricTensor<Dim, T> from_principal_values(const PrincipalValues<Dim, T>& p) {
  auto s = SymmetricTensor<Dim, T>::zero();
  for (int i = 0; i < 3; ++i) s[i] = i < Dim ? T(0) : p.value[i];
  for (int i = 0; i < Dim; ++i)
    for (int j = i; j < Dim; ++j)
      for (int k = 0; k < Dim; ++k)
        s[symmetric_index(i, j)] += p.value[k] * p.direction(i, k) * p.direction(j, k);
  return s;
}

}  // namespace vsb
