// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A pack of numbers that one instruction works on. Expressions read like those of a single number, and the
/// same function templates take both.
///
/// A product that is added to or subtracted from something is rounded once, by a fused multiply-add, wherever
/// the machine has one: the source decides, not the compiler, so that every backend computes the same bits.
#pragma once

#include <cstdint>
#include <type_traits>
#include <utility>
#include <vsb/views/pack_native.hpp>

#if defined(__FMA__) && !defined(__CUDACC__) && !defined(__HIPCC__)
#include <immintrin.h>
#define VSB_PACK_FMA 1
#endif

namespace vsb {

template <class T, int W>
struct PackProduct;

/// A truth value per lane: all bits set, or none.
template <class T, int W>
struct PackMask {
  using Word = std::conditional_t<sizeof(T) == 8, std::int64_t, std::int32_t>;  ///< an integer as wide as T
  using Native = typename detail::VectorOf<Word, W>::Aligned;  ///< the compiler's vector of W of them
  Native v;                                                    ///< word l is -1 where lane l is true, else 0

  /// Lane l is true where bit l is set.
  KOKKOS_FORCEINLINE_FUNCTION static PackMask from_bits(std::uint64_t bits) {
    Native lane{};
    for (int l = 0; l < W; ++l) lane[l] = Word(1) << l;
    return {(detail::repeated<Native>(static_cast<Word>(bits)) & lane) != Native{}};
  }
  ///@{
  /// Lane by lane.
  KOKKOS_FORCEINLINE_FUNCTION friend PackMask operator&(PackMask a, PackMask b) { return {a.v & b.v}; }
  KOKKOS_FORCEINLINE_FUNCTION friend PackMask operator|(PackMask a, PackMask b) { return {a.v | b.v}; }
  KOKKOS_FORCEINLINE_FUNCTION PackMask operator!() const { return {~v}; }
  ///@}
  /// Whether a lane in [0, W) is true.
  KOKKOS_FORCEINLINE_FUNCTION bool operator[](int lane) const { return v[lane] != 0; }
};

/// Whether at least one lane is true.
template <class T, int W>
KOKKOS_FORCEINLINE_FUNCTION bool any(PackMask<T, W> mask) {
#if defined(VSB_PACK_FMA)
  if constexpr (W * sizeof(T) == 32)
    return _mm256_testz_si256(reinterpret_cast<__m256i>(mask.v), reinterpret_cast<__m256i>(mask.v)) == 0;
#endif
  typename PackMask<T, W>::Word sum = 0;
  for (int l = 0; l < W; ++l) sum |= mask.v[l];
  return sum != 0;
}

/// Bit l: whether lane l is true.
template <class T, int W>
KOKKOS_FORCEINLINE_FUNCTION std::uint32_t bits_of(PackMask<T, W> mask) {
#if defined(VSB_PACK_FMA)
  if constexpr (sizeof(T) == 8 && W == 4)
    return static_cast<std::uint32_t>(_mm256_movemask_pd(reinterpret_cast<__m256d>(mask.v)));
  if constexpr (sizeof(T) == 4 && W == 8)
    return static_cast<std::uint32_t>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask.v)));
#endif
  std::uint32_t bits = 0;
  for (int l = 0; l < W; ++l) bits |= mask.v[l] != 0 ? std::uint32_t(1) << l : 0;
  return bits;
}

/// W numbers of type float or double, one per lane. Without initialiser they have no value.
template <class T, int W>
struct Pack {
  static constexpr int width = W;                                ///< lanes
  using value_type = T;                                          ///< type of a lane
  using Mask = PackMask<T, W>;                                   ///< what comparisons give
  using Native = typename detail::VectorOf<T, W>::Aligned;       ///< the compiler's vector
  using Unaligned = typename detail::VectorOf<T, W>::Unaligned;  ///< the same, at any address
  Native v;                                                      ///< number l is that of lane l

  Pack() = default;
  /// Of the compiler's own vector.
  KOKKOS_FORCEINLINE_FUNCTION Pack(Native n) : v(n) {}
  /// x in every lane.
  KOKKOS_FORCEINLINE_FUNCTION Pack(T x) : v(detail::repeated<Native>(x)) {}

  /// Of W numbers side by side, wherever they begin.
  KOKKOS_FORCEINLINE_FUNCTION static Pack load(const T* from) {
    return Native(*reinterpret_cast<const Unaligned*>(from));
  }
  /// Writes W numbers side by side, wherever they begin.
  KOKKOS_FORCEINLINE_FUNCTION void store(T* to) const { *reinterpret_cast<Unaligned*>(to) = v; }
  /// The number in a lane in [0, W).
  KOKKOS_FORCEINLINE_FUNCTION T operator[](int lane) const { return v[lane]; }
  /// Replaces the number in a lane in [0, W).
  KOKKOS_FORCEINLINE_FUNCTION void set(int lane, T x) { v[lane] = x; }

  ///@{
  /// Lane by lane. A product stays open until it is added to something, so that both are rounded once.
  KOKKOS_FORCEINLINE_FUNCTION friend Pack operator+(Pack a, Pack b) { return a.v + b.v; }
  KOKKOS_FORCEINLINE_FUNCTION friend Pack operator-(Pack a, Pack b) { return a.v - b.v; }
  KOKKOS_FORCEINLINE_FUNCTION friend PackProduct<T, W> operator*(Pack a, Pack b) { return {a, b}; }
  KOKKOS_FORCEINLINE_FUNCTION friend Pack operator/(Pack a, Pack b) { return a.v / b.v; }
  KOKKOS_FORCEINLINE_FUNCTION Pack operator-() const { return -v; }
  KOKKOS_FORCEINLINE_FUNCTION Pack& operator+=(Pack b) { return *this = *this + b; }
  KOKKOS_FORCEINLINE_FUNCTION Pack& operator-=(Pack b) { return *this = *this - b; }
  KOKKOS_FORCEINLINE_FUNCTION Pack& operator*=(Pack b) { return *this = v * b.v; }
  KOKKOS_FORCEINLINE_FUNCTION Pack& operator+=(const PackProduct<T, W>& p) {
    return *this = fused(p.a, p.b, *this);
  }
  KOKKOS_FORCEINLINE_FUNCTION Pack& operator-=(const PackProduct<T, W>& p) {
    return *this = fused(-p.a, p.b, *this);
  }
  ///@}

  ///@{
  /// Lane by lane; false where a lane is a NaN.
  KOKKOS_FORCEINLINE_FUNCTION friend Mask operator<(Pack a, Pack b) { return {a.v < b.v}; }
  KOKKOS_FORCEINLINE_FUNCTION friend Mask operator>(Pack a, Pack b) { return {a.v > b.v}; }
  KOKKOS_FORCEINLINE_FUNCTION friend Mask operator>=(Pack a, Pack b) { return {a.v >= b.v}; }
  KOKKOS_FORCEINLINE_FUNCTION friend Mask operator<=(Pack a, Pack b) { return {a.v <= b.v}; }
  KOKKOS_FORCEINLINE_FUNCTION friend Mask operator==(Pack a, Pack b) { return {a.v == b.v}; }
  ///@}

  /// a b + c, rounded once where the machine can.
  KOKKOS_FORCEINLINE_FUNCTION static Pack fused(Pack a, Pack b, Pack c) {
#if defined(VSB_PACK_FMA)
    if constexpr (sizeof(T) == 8 && W == 4) return Native(_mm256_fmadd_pd(a.v, b.v, c.v));
    if constexpr (sizeof(T) == 4 && W == 8) return Native(_mm256_fmadd_ps(a.v, b.v, c.v));
    if constexpr (sizeof(T) == 8 && W == 2) return Native(_mm_fmadd_pd(a.v, b.v, c.v));
    if constexpr (sizeof(T) == 4 && W == 4) return Native(_mm_fmadd_ps(a.v, b.v, c.v));
#endif
#if defined(__CUDACC__)
    for (int l = 0; l < W; ++l) c.set(l, Kokkos::fma(a[l], b[l], c[l]));
    return c;
#else
    return a.v * b.v + c.v;
#endif
  }
};

/// The product of two packs, not yet rounded; becomes one where nothing is added to it.
template <class T, int W>
struct PackProduct {
  using P = Pack<T, W>;  ///< what the product becomes
  ///@{
  /// The factors.
  P a, b;
  ///@}

  /// The product, rounded.
  KOKKOS_FORCEINLINE_FUNCTION operator P() const { return a.v * b.v; }
  ///@{
  /// Lane by lane. A product and what it is added to are rounded once (Pack::fused). Of two products, the one
  /// that is no longer open is rounded by itself before.
  KOKKOS_FORCEINLINE_FUNCTION PackProduct operator-() const { return {-a, b}; }

  KOKKOS_FORCEINLINE_FUNCTION friend P operator+(PackProduct p, P c) { return P::fused(p.a, p.b, c); }
  KOKKOS_FORCEINLINE_FUNCTION friend P operator+(P c, PackProduct p) { return P::fused(p.a, p.b, c); }
  KOKKOS_FORCEINLINE_FUNCTION friend P operator+(PackProduct p, PackProduct q) { return p + P(q); }
  KOKKOS_FORCEINLINE_FUNCTION friend P operator-(PackProduct p, P c) { return P::fused(p.a, p.b, -c); }
  KOKKOS_FORCEINLINE_FUNCTION friend P operator-(P c, PackProduct p) { return P::fused(-p.a, p.b, c); }
  KOKKOS_FORCEINLINE_FUNCTION friend P operator-(PackProduct p, PackProduct q) { return P(p) - q; }
  KOKKOS_FORCEINLINE_FUNCTION friend PackProduct operator*(PackProduct p, P c) { return {P(p), c}; }
  KOKKOS_FORCEINLINE_FUNCTION friend PackProduct operator*(P c, PackProduct p) { return {c, P(p)}; }
  KOKKOS_FORCEINLINE_FUNCTION friend PackProduct operator*(PackProduct p, PackProduct q) {
    return {P(p), P(q)};
  }
  ///@}
};

/// What kernels on cell lanes compute with: `bytes` bytes' worth of numbers.
template <class Real>
struct Lanes {
  static constexpr int bytes = 32;                                      ///< of a register with AVX2
  static constexpr int width = bytes / static_cast<int>(sizeof(Real));  ///< lanes: 4 of double, 8 of float
  using Pack = vsb::Pack<Real, width>;                                  ///< one number in each lane
};

namespace detail {
/// Lane l is lane number L of a and, from W on, of b.
template <class T, int W, int... L>
KOKKOS_FORCEINLINE_FUNCTION Pack<T, W> shuffled(Pack<T, W> a, Pack<T, W> b,
                                                std::integer_sequence<int, L...>) {
#if defined(__CUDACC__)  // whose front end does not expand L in the builtin
  const int from[W] = {L...};
  Pack<T, W> p;
  for (int l = 0; l < W; ++l) p.set(l, from[l] < W ? a[from[l]] : b[from[l] - W]);
  return p;
#else
  return typename Pack<T, W>::Native(__builtin_shufflevector(a.v, b.v, L...));
#endif
}

template <class T, int W, int... L>
KOKKOS_FORCEINLINE_FUNCTION Pack<T, W> shift_in(Pack<T, W> a, Pack<T, W> b,
                                                std::integer_sequence<int, L...>) {
  return shuffled(a, b, std::integer_sequence<int, (W - 1 + L)...>{});
}
}  // namespace detail

/// Lane 0 is the last lane of `before`, lane l the lane l - 1 of p.
template <class T, int W>
KOKKOS_FORCEINLINE_FUNCTION Pack<T, W> shift_in(Pack<T, W> before, Pack<T, W> p) {
  return detail::shift_in(before, p, std::make_integer_sequence<int, W>{});
}

namespace detail {
template <int By, class T, int W, int... L>
KOKKOS_FORCEINLINE_FUNCTION Pack<T, W> rotated(Pack<T, W> p, std::integer_sequence<int, L...>) {
  return shuffled(p, p, std::integer_sequence<int, ((L - By + W) % W)...>{});
}
}  // namespace detail

/// Lane l + By is lane l of p; what goes beyond one end comes in at the other.
template <int By, class T, int W>
KOKKOS_FORCEINLINE_FUNCTION Pack<T, W> rotated(Pack<T, W> p) {
  return detail::rotated<By>(p, std::make_integer_sequence<int, W>{});
}

namespace detail {
template <class P, int... L>
KOKKOS_FORCEINLINE_FUNCTION P lane_numbers(std::integer_sequence<int, L...>) {
  P p(0);
  (p.set(L, L), ...);
  return p;
}
}  // namespace detail

/// 0, 1, 2, ...
template <class P>
KOKKOS_FORCEINLINE_FUNCTION P lane_numbers() {
  return detail::lane_numbers<P>(std::make_integer_sequence<int, P::width>{});
}

/// p in the lanes whose bit is set, zero in the others.
template <class T, int W>
KOKKOS_FORCEINLINE_FUNCTION Pack<T, W> keep_lanes(std::uint64_t bits, Pack<T, W> p) {
#if defined(VSB_PACK_FMA) && defined(__AVX512VL__)
  if constexpr (sizeof(T) == 8 && W == 4)
    return typename Pack<T, W>::Native(_mm256_maskz_mov_pd(static_cast<__mmask8>(bits), p.v));
  if constexpr (sizeof(T) == 4 && W == 8)
    return typename Pack<T, W>::Native(_mm256_maskz_mov_ps(static_cast<__mmask8>(bits), p.v));
#endif
  const auto mask = PackMask<T, W>::from_bits(bits).v;
  return detail::chosen(mask, p.v, typename Pack<T, W>::Native{});
}

namespace math {
///@{
/// a where the condition holds, else b.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION T select(bool condition, T a, T b) {
  return condition ? a : b;
}
template <class T, int W>
KOKKOS_FORCEINLINE_FUNCTION Pack<T, W> select(PackMask<T, W> condition, Pack<T, W> a, Pack<T, W> b) {
  return detail::chosen(condition.v, a.v, b.v);
}
///@}
/// The absolute value, lane by lane.
template <class T, int W>
KOKKOS_FORCEINLINE_FUNCTION Pack<T, W> abs(Pack<T, W> x) {
  return select(x < Pack<T, W>(T(0)), -x, x);
}
/// The exponential, by the scalar function in each lane.
template <class T, int W>
KOKKOS_INLINE_FUNCTION Pack<T, W> exp(Pack<T, W> x) {
  for (int l = 0; l < W; ++l) x.set(l, exp(x[l]));
  return x;
}
}  // namespace math

}  // namespace vsb
