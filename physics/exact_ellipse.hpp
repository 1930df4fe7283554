// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Exact stress in an infinite plate with a pressurised elliptic hole under far-field stress, plane strain,
/// Eq. (A6) to Eq. (A12). The hole is centred at the origin with its major axis along x.
#pragma once

#include <Kokkos_Complex.hpp>
#include <vsb/views/tensor.hpp>

namespace vsb {

/// Stress in an infinite linear elastic plate with an elliptic hole of semi-axes a_0 along x and b_0 along y;
/// Eq. (A6) to Eq. (A12).
template <class T>
struct ExactEllipse {
  T semi_major;     ///< a_0, m
  T semi_minor;     ///< b_0, m
  T pressure;       ///< p_i in the hole, Pa, positive in compression
  T far_stress;     ///< sigma_0, Pa, positive in compression: -sigma_yy far away
  T far_ratio;      ///< K = sigma_xx / sigma_yy far away
  T poisson_ratio;  ///< nu, for sigma_zz = nu (sigma_xx + sigma_yy)

  /// Stress at a point outside the hole, Pa, tension positive.
  KOKKOS_FUNCTION SymmetricTensor<2, T> stress(const Vector<2, T>& x) const {
    using Complex = Kokkos::complex<T>;
    const T R = (semi_major + semi_minor) / 2;                          // Eq. (A7)
    const T m = (semi_major - semi_minor) / (semi_major + semi_minor);  // Eq. (A8)
    const T K = far_ratio, s0 = far_stress, p = pressure;
    const Complex one(T(1));

    // zeta inside the unit disk with m zeta^2 - (z / R) zeta + 1 = 0, from Eq. (A6): the smaller of the two
    // roots, whose product is 1 / m. This form is valid for m = 0 too.
    const Complex z(x[0] / R, x[1] / R);
    const Complex root = Kokkos::sqrt(z * z - Complex(4 * m));
    const Complex sum = z + root, difference = z - root;
    const Complex zeta = Complex(T(2)) / (norm2(sum) >= norm2(difference) ? sum : difference);

    const Complex z2 = zeta * zeta;
    const T rho2 = norm2(zeta);
    const Complex denominator = m * z2 - one;

    // Eq. (A11): sigma_xx + sigma_yy
    const Complex trace_part =
        (-4 * p * m * z2 + s0 * (Complex(1 + K) + K * (m - 2) * z2 + (m + 2) * z2)) / (T(4) * denominator);
    const T trace_sum = 4 * trace_part.real();

    // Eq. (A12): sigma_yy - sigma_xx + 2 i sigma_xy
    const Complex cube = denominator * denominator * denominator;
    const Complex hole = (1 + m * m) * (one + m * z2) * z2 / cube;
    const Complex deviator =
        T(-4) * z2 * (z2 + Complex(m * rho2 * rho2)) / (rho2 * cube) *
            (-p * m + (1 + K) * s0 * m / 2 + (1 - K) * s0 / 2) -
        Complex((1 - K) * s0) - 2 * p * hole + (1 + K) * s0 * hole +
        (1 - K) * s0 * z2 * ((m * m - 1) * m * z2 * z2 + (3 - m * m) * z2 + Complex(2 * m)) / cube;

    auto s = SymmetricTensor<2, T>::zero();
    s[0] = (trace_sum - deviator.real()) / 2;
    s[1] = (trace_sum + deviator.real()) / 2;
    s[2] = poisson_ratio * trace_sum;
    s[3] = deviator.imag() / 2;
    return s;
  }

 private:
  KOKKOS_FUNCTION static T norm2(const Kokkos::complex<T>& c) {
    return c.real() * c.real() + c.imag() * c.imag();
  }
};

}  // namespace vsb
