// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Stress fields of any kind, one per traction, as one virtual stress field for the kernels.
#pragma once

#include <type_traits>
#include <vsb/physics/exact_ellipse.hpp>
#include <vsb/physics/stress_fields.hpp>

namespace vsb {

/// A stress field of one of the kinds there are.
template <int Dim, class Real>
class StressField {
  /// An exact stress in equilibrium, such as that of an infinite body around the modelled part; plane strain.
  struct None {};
  using Ellipse = std::conditional_t<Dim == 2, ExactEllipse<Real>, None>;

 public:
  KOKKOS_FUNCTION StressField() : StressField(UniformStress<Dim, Real>{SymmetricTensor<Dim, Real>::zero()}) {}
  ///@{
  /// Holds one field of the given kind.
  KOKKOS_FUNCTION StressField(const UniformStress<Dim, Real>& f) : kind_(Kind::uniform), uniform_(f) {}
  KOKKOS_FUNCTION StressField(const AffineStress<Dim, Real>& f) : kind_(Kind::affine), affine_(f) {}
  KOKKOS_FUNCTION StressField(const HydrostaticStress<Dim, Real>& f)
      : kind_(Kind::hydrostatic), hydrostatic_(f) {}
  KOKKOS_FUNCTION StressField(const RadialBlend<Dim, Real>& f) : kind_(Kind::radial), radial_(f) {}
  KOKKOS_FUNCTION StressField(const PlanarBlend<Dim, Real>& f) : kind_(Kind::planar), planar_(f) {}
  KOKKOS_FUNCTION StressField(const Ellipse& f) : kind_(Kind::ellipse), ellipse_(f) {}
  ///@}

  ///@{
  /// Whether the field is affine in x, and then the field.
  bool is_affine() const { return kind_ == Kind::uniform || kind_ == Kind::affine; }
  AffineStress<Dim, Real> as_affine() const {
    if (kind_ == Kind::affine) return affine_;
    AffineStress<Dim, Real> constant{uniform_.stress, {}};
    for (int j = 0; j < Dim; ++j) constant.gradient[j] = SymmetricTensor<Dim, Real>::zero();
    return constant;
  }
  ///@}

  /// The field and its divergence at x in m.
  KOKKOS_FUNCTION VirtualStressValue<Dim, Real> at(const Vector<Dim, Real>& x) const {
    switch (kind_) {
      case Kind::affine:
        return affine_.at(x);
      case Kind::hydrostatic:
        return hydrostatic_.at(x);
      case Kind::radial:
        return radial_.at(x);
      case Kind::planar:
        return planar_.at(x);
      case Kind::ellipse:
        if constexpr (Dim == 2) return {ellipse_.stress(x), Vector<Dim, Real>::zero()};
        break;
      case Kind::uniform:
        break;
    }
    return uniform_.at(x);
  }

 private:
  enum class Kind { uniform, affine, hydrostatic, radial, planar, ellipse };
  Kind kind_;
  union {
    UniformStress<Dim, Real> uniform_;
    AffineStress<Dim, Real> affine_;
    HydrostaticStress<Dim, Real> hydrostatic_;
    RadialBlend<Dim, Real> radial_;
    PlanarBlend<Dim, Real> planar_;
    Ellipse ellipse_;
  };
};

/// A body force that varies as the velocity of a rigid motion: c + S (x - x_c), S skew.
template <int Dim, class Real>
struct RigidBodyForce {
  ///@{
  /// x_c in m, and c in N/m^3.
  Vector<Dim, Real> about, constant;
  ///@}
  Matrix<Dim, Real> spin;  ///< S, N/m^4

  /// No force anywhere.
  KOKKOS_FUNCTION static RigidBodyForce zero() {
    return {Vector<Dim, Real>::zero(), Vector<Dim, Real>::zero(), Matrix<Dim, Real>::zero()};
  }
  /// The force at x in m, N/m^3.
  KOKKOS_FUNCTION Vector<Dim, Real> at(const Vector<Dim, Real>& x) const {
    return constant + spin * (x - about);
  }
};

/// Stress fields of any kind; tractions add up where their surfaces overlap.
template <int Dim, class Real>
struct TractionFields : ActsOnParticles {
  static constexpr int capacity = UniformVirtualStress<Dim, Real>::capacity;  ///< the largest `count`
  StressField<Dim, Real> field[capacity];                                     ///< of traction k
  Real factor[capacity];      ///< on the field of traction k, at this time
  int count = 0;              ///< of tractions, 0 to capacity
  TractionMask balanced = 0;  ///< the tractions to which `balance` belongs, all at the same nodes
  RigidBodyForce<Dim, Real> balance =
      RigidBodyForce<Dim, Real>::zero();  ///< see kernels/boundary/self_balance.hpp

  /// The tractions 0, ..., count - 1. Throws std::invalid_argument for a count beyond the capacity.
  TractionMask known() const { return first_tractions(count, capacity); }
  /// The same field less the tractions in the mask.
  TractionFields without(TractionMask tractions) const {
    auto rest = *this;
    for (int k = 0; k < count; ++k)
      if (tractions >> k & 1u) rest.field[k] = StressField<Dim, Real>();
    rest.balanced &= ~tractions;
    return rest;
  }

  /// The sum of the fields of the tractions in the mask, and of `balance` where it belongs, at x in m.
  KOKKOS_FUNCTION VirtualStressValue<Dim, Real> at(const Vector<Dim, Real>& x, TractionMask mask) const {
    auto sum = VirtualStressValue<Dim, Real>::zero();
    for (int k = 0; k < count; ++k) {
      if (!(mask >> k & 1u)) continue;
      const auto bar = field[k].at(x);
      sum.stress += factor[k] * bar.stress;
      sum.divergence += factor[k] * bar.divergence;
    }
    if (mask & balanced) sum.divergence += balance.at(x);
    return sum;
  }
};

/// Affine stress fields, one per traction; tractions add up where their surfaces overlap.
template <int Dim, class Real>
struct AffineVirtualStress : ActsOnParticles {
  static constexpr bool affine = true;  ///< see the top of virtual_stress.hpp
  static constexpr int capacity = UniformVirtualStress<Dim, Real>::capacity;  ///< the largest `count`
  AffineStress<Dim, Real> field[capacity];                                    ///< of traction k
  Real factor[capacity];  ///< on the field of traction k, at this time
  int count = 0;          ///< of tractions, 0 to capacity

  /// The tractions 0, ..., count - 1. Throws std::invalid_argument for a count beyond the capacity.
  TractionMask known() const { return first_tractions(count, capacity); }
  /// The same field less the tractions in the mask.
  AffineVirtualStress without(TractionMask tractions) const {
    auto rest = *this;
    for (int k = 0; k < count; ++k)
      if (tractions >> k & 1u) rest.factor[k] = Real(0);
    return rest;
  }

  int axis = -1;  ///< the one direction along which all of them vary, without shear; -1: no such direction

  /// Sets `axis` where there is such a direction, as for the pressure of water and of soil at rest.
  void find_axis() {
    int found = 0, axes = 0;
    bool shear = false;
    for (int j = 0; j < Dim; ++j) {
      bool varies = false;
      for (int k = 0; k < count; ++k) {
        const auto& g = field[k].gradient[j];
        for (int c = 0; c < g.size; ++c) {
          varies = varies || g[c] != Real(0);
          shear = shear || (c >= 3 && (g[c] != Real(0) || field[k].value[c] != Real(0)));
        }
      }
      if (!varies) continue;
      found = j;
      ++axes;
    }
    axis = shear || axes > 1 ? -1 : found;
  }
  /// Normal stress a of the sum where x_j = 0, and its gradient along j; for j = axis.
  KOKKOS_FORCEINLINE_FUNCTION void sum_along(TractionMask mask, int j, int a, Real& value,
                                             Real& slope) const {
    value = slope = Real(0);
    for (int k = 0; k < count; ++k) {
      if (!(mask >> k & 1u)) continue;
      value += factor[k] * field[k].value[a];
      slope += factor[k] * field[k].gradient[j][a];
    }
  }
  /// The sum of the fields of the tractions in the mask, by their factors.
  KOKKOS_FUNCTION AffineStress<Dim, Real> sum(TractionMask mask) const {
    AffineStress<Dim, Real> total;
    total.value = SymmetricTensor<Dim, Real>::zero();
    for (int j = 0; j < Dim; ++j) total.gradient[j] = total.value;
    for (int k = 0; k < count; ++k) {
      if (!(mask >> k & 1u)) continue;
      total.value += factor[k] * field[k].value;
      for (int j = 0; j < Dim; ++j) total.gradient[j] += factor[k] * field[k].gradient[j];
    }
    return total;
  }
  /// The same sum and its divergence at x in m.
  KOKKOS_FUNCTION VirtualStressValue<Dim, Real> at(const Vector<Dim, Real>& x, TractionMask mask) const {
    return sum(mask).at(x);
  }
};

/// See virtual_stress_of.
template <class Functor>
struct FunctorVirtualStress : ActsOnParticles {
  Functor functor;                         ///< from x to VirtualStressValue
  TractionMask acting = ~TractionMask(0);  ///< the tractions that have this field

  /// The same field less the tractions in the mask.
  FunctorVirtualStress without(TractionMask tractions) const { return {{}, functor, acting & ~tractions}; }
  /// The field at x in m, once for all tractions of the mask; zero if none of them has it.
  template <int Dim, class T>
  KOKKOS_FUNCTION VirtualStressValue<Dim, T> at(const Vector<Dim, T>& x, TractionMask mask) const {
    return (mask & acting) != 0 ? functor(x) : VirtualStressValue<Dim, T>::zero();
  }
};

/// The virtual stress of a function of one's own: functor(x) gives sbar and its divergence at x as a
/// VirtualStressValue, and acts at the nodes where any traction is declared. On a device it must be callable
/// there (KOKKOS_FUNCTION). The divergence must be that of the stress: a difference acts as a body force.
template <class Functor>
FunctorVirtualStress<Functor> virtual_stress_of(const Functor& functor) {
  return {{}, functor, ~TractionMask(0)};
}

}  // namespace vsb
