// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// In-plane stress in polar components about the origin, and back.
#pragma once

#include <vsb/views/tensor.hpp>

namespace vsb {

/// Components along the radial and circumferential directions.
template <class T>
struct PolarStress {
  ///@{
  /// sigma_rr, sigma_tt and sigma_rt in Pa, tension positive.
  T rr, tt, rt;
  ///@}
};

/// The polar components of a stress at (x, y), which must not be the origin. Uses only the in-plane part.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION PolarStress<T> to_polar(const SymmetricTensor<Dim, T>& s, T x, T y) {
  static_assert(Dim >= 2, "polar components need a plane");
  const T r = math::sqrt(x * x + y * y), c = x / r, n = y / r;
  return {c * c * s[0] + n * n * s[1] + 2 * c * n * s[3], n * n * s[0] + c * c * s[1] - 2 * c * n * s[3],
          c * n * (s[1] - s[0]) + (c * c - n * n) * s[3]};
}

/// The in-plane Cartesian components at (x, y); out-of-plane components are zero.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION SymmetricTensor<Dim, T> from_polar(const PolarStress<T>& p, T x, T y) {
  static_assert(Dim >= 2, "polar components need a plane");
  const T r = math::sqrt(x * x + y * y), c = x / r, n = y / r;
  auto s = SymmetricTensor<Dim, T>::zero();
  s[0] = c * c * p.rr + n * n * p.tt - 2 * c * n * p.rt;
  s[1] = n * n * p.rr + c * c * p.tt + 2 * c * n * p.rt;
  s[3] = c * n * (p.rr - p.tt) + (c * c - n * n) * p.rt;
  return s;
}

}  // namespace vsb
