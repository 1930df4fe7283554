// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Virtual stress fields sbar with their divergence fbar = div sbar, Eq. (16). A traction t on a boundary of
/// normal n is replaced by any field with sbar . n = t there, Eq. (14). A pressure p, positive in
/// compression, is sbar = -p I.
///
/// What a step asks of a field: known(), the tractions that it has a stress for; on cell lanes also
/// without(mask), the same field less some tractions.
///
/// What a kernel asks of a field: `loaded` (whether the sum over particles has a term), `uniform` (whether it
/// is the same everywhere), `affine` (whether it is affine in x; then sum(mask) returns it),
/// `cell_quadrature` (whether the sum over whole cells has a term), acting_at(x), the tractions that may act
/// on a particle at x, and at(x, mask), the sum of the fields of the tractions in the mask at x. A kernel
/// calls at() where a node's mask differs from that of the node before it: a field that differs from surface
/// to surface is taken per node.
#pragma once

#include <stdexcept>
#include <string>
#include <vsb/views/masks.hpp>
#include <vsb/views/tensor.hpp>

namespace vsb {

/// A virtual stress and its divergence at a point.
template <int Dim, class T>
struct VirtualStressValue {
  SymmetricTensor<Dim, T> stress;  ///< sbar, Pa, tension positive
  Vector<Dim, T> divergence;       ///< fbar, N/m^3

  /// No stress and no divergence.
  KOKKOS_FUNCTION static VirtualStressValue zero() {
    return {SymmetricTensor<Dim, T>::zero(), Vector<Dim, T>::zero()};
  }
};

/// Tractions 0, ..., count - 1. Throws std::invalid_argument for more than the capacity of a field.
inline TractionMask first_tractions(int count, int capacity) {
  if (count < 0 || count > capacity)
    throw std::invalid_argument("vsb: the `count` of a load is " + std::to_string(count) +
                                "; allowed are 0 to " + std::to_string(capacity) + " tractions");
  return count == 0 ? 0 : ~TractionMask(0) >> (32 - count);
}

/// Base of most fields: they act on particles, and on all of them.
struct ActsOnParticles {
  ///@{
  /// What kernels ask at compile time; see the top of this file.
  static constexpr bool loaded = true, uniform = false, affine = false, cell_quadrature = false;
  ///@}
  /// All tractions, at any position.
  template <class Position>
  KOKKOS_FUNCTION TractionMask acting_at(const Position&) const {
    return ~TractionMask(0);
  }
  /// All tractions.
  TractionMask known() const { return ~TractionMask(0); }
};

/// No traction anywhere; kernels skip the virtual stress at compile time.
struct NoVirtualStress {
  ///@{
  /// What kernels ask at compile time; see the top of this file.
  static constexpr bool loaded = false, cell_quadrature = false;
  ///@}
  /// Zero.
  template <int Dim, class T>
  KOKKOS_FUNCTION VirtualStressValue<Dim, T> at(const Vector<Dim, T>&, TractionMask) const {
    return VirtualStressValue<Dim, T>::zero();
  }
};

/// The virtual stress of a pressure p in Pa, positive in compression: sbar = -p I.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION SymmetricTensor<Dim, T> pressure_stress(T p) {
  return SymmetricTensor<Dim, T>::isotropic(-p);
}

/// One uniform tensor per traction; tractions add up where their surfaces overlap.
template <int Dim, class Real>
struct UniformVirtualStress : ActsOnParticles {
  static constexpr bool uniform = true;         ///< see the top of this file
  static constexpr int capacity = 8;            ///< the largest `count`
  SymmetricTensor<Dim, Real> stress[capacity];  ///< sbar of traction k at this time, Pa, tension positive
  int count = 0;                                ///< of tractions, 0 to capacity

  /// The tractions 0, ..., count - 1. Throws std::invalid_argument for a count beyond the capacity.
  TractionMask known() const { return first_tractions(count, capacity); }
  /// The same field less the tractions in the mask.
  UniformVirtualStress without(TractionMask tractions) const {
    auto rest = *this;
    for (int k = 0; k < count; ++k)
      if (tractions >> k & 1u) rest.stress[k] = SymmetricTensor<Dim, Real>::zero();
    return rest;
  }
  /// The sum of the tensors of the tractions in the mask, at any position; its divergence is zero.
  KOKKOS_FUNCTION VirtualStressValue<Dim, Real> at(const Vector<Dim, Real>&, TractionMask mask) const {
    auto value = VirtualStressValue<Dim, Real>::zero();
    for (int k = 0; k < count; ++k)
      if (mask >> k & 1u) value.stress += stress[k];
    return value;
  }
};

/// Tractions of `field` that act on surface points only; particles skip the virtual stress at compile time.
template <class Field>
struct OnSurfacePoints {
  ///@{
  /// What kernels ask at compile time; see the top of this file.
  static constexpr bool loaded = false, cell_quadrature = false;
  ///@}
  Field field;  ///< the virtual stress of the tractions
  /// The tractions that `field` has a stress for.
  TractionMask known() const { return field.known(); }
  /// The sum of the fields of the tractions in the mask at x in m.
  template <int Dim, class T>
  KOKKOS_FUNCTION VirtualStressValue<Dim, T> at(const Vector<Dim, T>& x, TractionMask mask) const {
    return field.at(x, mask);
  }
};

}  // namespace vsb
