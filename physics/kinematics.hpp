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

/// sigma + dt (w sigma - sigma w) with the spin w = skew(L): the stress turned with the material over a step,
/// which is what the Jaumann rate adds to its increment. Component (i, j) gets w_ik sigma_kj + w_jk sigma_ki,
/// added up by pairs w_ij = -w_ji.
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION SymmetricTensor<Dim, T> turned_with_material(const SymmetricTensor<Dim, T>& sigma,
                                                                         const Matrix<Dim, T>& L, T dt) {
  auto s = sigma;
  for (int i = 0; i < Dim; ++i)
    for (int j = i + 1; j < Dim; ++j) {
      const T twice = dt * (L(i, j) - L(j, i)), w = T(0.5) * twice;
      s[i] += twice * sigma(i, j);
      s[j] -= twice * sigma(i, j);
      s[symmetric_index(i, j)] += w * (sigma[j] - sigma[i]);
      for (int k = 0; k < Dim; ++k) {
        if (k == i || k == j) continue;
        s[symmetric_index(i, k)] += w * sigma(j, k);
        s[symmetric_index(j, k)] -= w * sigma(i, k);
      }
    }
  return s;
}

/// I + dt L: the deformation of the step.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION Matrix<Dim, T> deformation_increment(const Matrix<Dim, T>& L, T dt) {
  Matrix<Dim, T> f;
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) {
      if (i == j)
        f(i, i) = T(1) + dt * L(i, i);
      else
        f(i, j) = dt * L(i, j);
    }
  return f;
}

/// V <- V det(I + dt L): exact for a velocity gradient that acts on the configuration at the start of the
/// step.
struct DeterminantVolume {
  /// The volume at the end of a step of length dt, in the unit of `volume`.
  template <int Dim, class T>
  KOKKOS_FUNCTION T operator()(T volume, const Matrix<Dim, T>& L, T dt) const {
    return volume * determinant(deformation_increment(L, dt));
  }
};

/// V <- V exp(dt tr L): exact for a velocity gradient that is constant over the step; consistent with a
/// stress that is integrated in rate form, whatever the number of steps.
struct ExponentialVolume {
  /// The volume at the end of a step of length dt, in the unit of `volume`.
  template <int Dim, class T>
  KOKKOS_FUNCTION T operator()(T volume, const Matrix<Dim, T>& L, T dt) const {
    return volume * math::exp(T(dt * trace(L)));
  }
};

}  // namespace vsb
