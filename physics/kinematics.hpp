// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Strain increment, spin and volume change of a particle over one step, from the velocity gradient L.
#pragma once

#include <vsb/views/pack.hpp>
#include <vsb/views/tensor.hpp>

namespace vsb {

/// dt sym(L): the strain increment; its shear components are those of the tensor (half the engineering
/// shear).
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION SymmetricTensor<Dim, T> strain_increment(const Matrix<Dim, T>& L, T dt) {
  auto e = SymmetricTensor<Dim, T>::zero();
  for (int i = 0; i < Dim; ++i) {
    e[i] = dt * L(i, i);
    for (int j = i + 1; j < Dim; ++j) e[symmetric_index(i, j)] = T(0.5) * dt * (L(i, j) + L(j, i));
  }
  return e;
}

/// dt (w sigma - sigma w) with the spin w = skew(L): what the Jaumann rate adds to a stress increment, so
/// that the stress turns with the material.
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION SymmetricTensor<Dim, T> jaumann_rotation(const SymmetricTensor<Dim, T>& sigma,
                                                                     const Matrix<Dim, T>& L, T dt) {
  auto r = SymmetricTensor<Dim, T>::zero();
  if constexpr (Dim > 1) {
    auto A = Matrix<Dim, T>::zero();  // dt w sigma; -dt sigma w is its transpose
    for (int i = 0; i < Dim; ++i)
      for (int k = 0; k < Dim; ++k) {
        if (i == k) continue;
        const T w = T(0.5) * dt * (L(i, k) - L(k, i));
        for (int j = 0; j < Dim; ++j) A(i, j) += w * sigma(k, j);
      }
    for (int i = 0; i < Dim; ++i)
      for (int j = i; j < Dim; ++j) r[symmetric_index(i, j)] = A(i, j) + A(j, i);
  }
  return r;
}

/// I + dt L: the deformation of the step.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION Matrix<Dim, T> deformation_increment(const Matrix<Dim, T>& L, T dt) {
  auto f = Matrix<Dim, T>::identity();
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) f(i, j) += dt * L(i, j);
  return f;
}

/// V <- V det(I + dt L): exact for a velocity gradient that acts on the configuration at the start of the
/// step.
struct DeterminantVolume {
  template <int Dim, class T>
  KOKKOS_FUNCTION T operator()(T volume, const Matrix<Dim, T>& L, T dt) const {
    return volume * determinant(deformation_increment(L, dt));
  }
};

/// V <- V exp(dt tr L): exact for a velocity gradient that is constant over the step; consistent with a
/// stress that is integrated in rate form, whatever the number of steps.
struct ExponentialVolume {
  template <int Dim, class T>
  KOKKOS_FUNCTION T operator()(T volume, const Matrix<Dim, T>& L, T dt) const {
    return volume * math::exp(T(dt * trace(L)));
  }
};

}  // namespace vsb
