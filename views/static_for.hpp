// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A loop that is unrolled before anything else: body(0), ..., body(N - 1) with each number as a compile-time
/// constant. Small arrays of packs stay in registers this way; after a loop that the compiler unrolls late
/// they lie in memory.
#pragma once

#include <type_traits>
#include <utility>
#include <vsb/views/kokkos_compat.hpp>

/// Stands between the parameter and the braces of a body: compilers judge each of the N calls by itself, and
/// would leave some of them as calls, with the packs in memory.
#define VSB_UNROLLED __attribute__((always_inline))

namespace vsb {

namespace detail {
template <class Body, int... I>
KOKKOS_FORCEINLINE_FUNCTION constexpr void static_for(const Body& body, std::integer_sequence<int, I...>) {
  (body(std::integral_constant<int, I>{}), ...);
}
}  // namespace detail

template <int N, class Body>
KOKKOS_FORCEINLINE_FUNCTION constexpr void static_for(const Body& body) {
  detail::static_for(body, std::make_integer_sequence<int, N>{});
}

}  // namespace vsb
