// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// W numbers side by side, as the compiler has them: vectors of its own, and arrays for nvcc, whose device
/// code has no such vectors.
#pragma once

#include <cstdint>
#include <type_traits>
#include <vsb/views/kokkos_compat.hpp>

namespace vsb::detail {

#if defined(__CUDACC__)

/// As much of the compilers' vectors as packs use. The words of comparisons have all bits set, or none.
template <class T, int W>
struct NumberArray {
  using Word = std::conditional_t<sizeof(T) == 8, std::int64_t, std::int32_t>;
  using Words = NumberArray<Word, W>;
  T data[W];

  KOKKOS_FORCEINLINE_FUNCTION T& operator[](int l) { return data[l]; }
  KOKKOS_FORCEINLINE_FUNCTION const T& operator[](int l) const { return data[l]; }

  KOKKOS_FORCEINLINE_FUNCTION friend NumberArray operator+(NumberArray a, const NumberArray& b) {
    for (int l = 0; l < W; ++l) a[l] += b[l];
    return a;
  }
  KOKKOS_FORCEINLINE_FUNCTION friend NumberArray operator-(NumberArray a, const NumberArray& b) {
    for (int l = 0; l < W; ++l) a[l] -= b[l];
    return a;
  }
  KOKKOS_FORCEINLINE_FUNCTION friend NumberArray operator*(NumberArray a, const NumberArray& b) {
    for (int l = 0; l < W; ++l) a[l] *= b[l];
    return a;
  }
  KOKKOS_FORCEINLINE_FUNCTION friend NumberArray operator/(NumberArray a, const NumberArray& b) {
    for (int l = 0; l < W; ++l) a[l] /= b[l];
    return a;
  }
  KOKKOS_FORCEINLINE_FUNCTION friend NumberArray operator&(NumberArray a, const NumberArray& b) {
    for (int l = 0; l < W; ++l) a[l] &= b[l];
    return a;
  }
  KOKKOS_FORCEINLINE_FUNCTION friend NumberArray operator|(NumberArray a, const NumberArray& b) {
    for (int l = 0; l < W; ++l) a[l] |= b[l];
    return a;
  }
  KOKKOS_FORCEINLINE_FUNCTION NumberArray operator-() const {
    NumberArray a;
    for (int l = 0; l < W; ++l) a[l] = -data[l];
    return a;
  }
  KOKKOS_FORCEINLINE_FUNCTION NumberArray operator~() const {
    NumberArray a;
    for (int l = 0; l < W; ++l) a[l] = ~data[l];
    return a;
  }
  KOKKOS_FORCEINLINE_FUNCTION friend Words operator<(const NumberArray& a, const NumberArray& b) {
    Words w;
    for (int l = 0; l < W; ++l) w[l] = -Word(a[l] < b[l]);
    return w;
  }
  KOKKOS_FORCEINLINE_FUNCTION friend Words operator>(const NumberArray& a, const NumberArray& b) {
    return b < a;
  }
  KOKKOS_FORCEINLINE_FUNCTION friend Words operator<=(const NumberArray& a, const NumberArray& b) {
    Words w;
    for (int l = 0; l < W; ++l) w[l] = -Word(a[l] <= b[l]);
    return w;
  }
  KOKKOS_FORCEINLINE_FUNCTION friend Words operator>=(const NumberArray& a, const NumberArray& b) {
    return b <= a;
  }
  KOKKOS_FORCEINLINE_FUNCTION friend Words operator!=(const NumberArray& a, const NumberArray& b) {
    Words w;
    for (int l = 0; l < W; ++l) w[l] = -Word(a[l] != b[l]);
    return w;
  }
  KOKKOS_FORCEINLINE_FUNCTION friend Words operator==(const NumberArray& a, const NumberArray& b) {
    Words w;
    for (int l = 0; l < W; ++l) w[l] = -Word(a[l] == b[l]);
    return w;
  }
};

template <class T, int W>
struct VectorOf {
  using Aligned = NumberArray<T, W>;
  using Unaligned = Aligned;
};

/// The same number W times.
template <class Native, class T>
KOKKOS_FORCEINLINE_FUNCTION Native repeated(T x) {
  Native a;
  for (auto& number : a.data) number = x;
  return a;
}

/// Lane by lane, a where the word is not zero, else b.
template <class Words, class Native>
KOKKOS_FORCEINLINE_FUNCTION Native chosen(const Words& words, Native a, const Native& b) {
  int l = 0;
  for (auto& number : a.data) {
    if (words[l] == 0) number = b[l];
    ++l;
  }
  return a;
}

#else

template <class T, int W>
struct VectorOf {
  typedef T Aligned __attribute__((vector_size(W * sizeof(T))));
  typedef T Unaligned __attribute__((vector_size(W * sizeof(T)), aligned(sizeof(T))));
};

template <class Native, class T>
KOKKOS_FORCEINLINE_FUNCTION Native repeated(T x) {
  return x - Native{};  // x - 0 is x, also for a zero of either sign
}

template <class Words, class Native>
KOKKOS_FORCEINLINE_FUNCTION Native chosen(Words words, Native a, Native b) {
  return words ? a : b;
}

#endif

}  // namespace vsb::detail
