// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A loop that is unrolled before anything else: body(0), ..., body(N - 1) with each number as a compile-time
/// constant. Small arrays of packs stay in registers this way; after a loop that the compiler unrolls late
/// they lie in memory.
#pragma once

#include <utility>
#include <vsb/views/kokkos_compat.hpp>

/// Stands between the parameter and the braces of a body. Without it compilers leave some of the N calls as
/// calls, with the packs in memory.
#define VSB_UNROLLED __attribute__((always_inline))

namespace vsb {

namespace detail {
/// An integral constant that a device can read.
template <int I>
struct StaticIndex {
  static constexpr int value = I;
  KOKKOS_FORCEINLINE_FUNCTION constexpr operator int() const { return I; }
};

VSB_ANY_CALLABLE
template <class Body, int... I>
KOKKOS_FORCEINLINE_FUNCTION constexpr void static_for(const Body& body, std::integer_sequence<int, I...>) {
  (body(StaticIndex<I>{}), ...);
}
}  // namespace detail

/// Calls body(0), ..., body(N - 1) in this order; the argument converts to a constant int.
VSB_ANY_CALLABLE
template <int N, class Body>
KOKKOS_FORCEINLINE_FUNCTION constexpr void static_for(const Body& body) {
  detail::static_for(body, std::make_integer_sequence<int, N>{});
}

}  // namespace vsb
