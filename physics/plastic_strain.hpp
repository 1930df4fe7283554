// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The plastic shear that a material has seen: Eq. (34).
#pragma once

#include <vsb/views/tensor.hpp>

namespace vsb {

/// sqrt(2/3 e^p : e^p), e^p the deviatoric part of the plastic strain.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION T equivalent_plastic_deviatoric_strain(const SymmetricTensor<Dim, T>& plastic) {
  using math::sqrt;
  const T mean = (plastic[0] + plastic[1] + plastic[2]) / T(3);
  T sum = 0;
  for (int c = 0; c < SymmetricTensor<Dim, T>::size; ++c) {
    const T e = c < 3 ? plastic[c] - mean : plastic[c];
    sum += (c < 3 ? T(1) : T(2)) * e * e;
  }
  return sqrt(T(2) / T(3) * sum);
}

}  // namespace vsb
