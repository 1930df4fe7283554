// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// All differences between Kokkos 3.4 and 5.x that this code must know.
#pragma once

#include <Kokkos_Core.hpp>
#include <limits>
#include <string>

static_assert(KOKKOS_VERSION >= 30400, "vsb needs Kokkos 3.4 or newer");

/// Before a function template that calls its argument: with a callable for the host alone it is a host
/// function.
#if defined(__CUDACC__)
#define VSB_ANY_CALLABLE _Pragma("nv_exec_check_disable")
#else
#define VSB_ANY_CALLABLE
#endif

namespace vsb {

/// Mathematical functions callable on host and device. They live in Kokkos::Experimental before Kokkos 3.7.
namespace math {
#if KOKKOS_VERSION >= 30700
using Kokkos::abs;
using Kokkos::atan2;
using Kokkos::cos;
using Kokkos::exp;
using Kokkos::expm1;
using Kokkos::floor;
using Kokkos::isfinite;
using Kokkos::log;
using Kokkos::log1p;
using Kokkos::sin;
using Kokkos::sqrt;
#else
using Kokkos::Experimental::atan2;
using Kokkos::Experimental::cos;
using Kokkos::Experimental::exp;
using Kokkos::Experimental::expm1;
using Kokkos::Experimental::floor;
using Kokkos::Experimental::isfinite;
using Kokkos::Experimental::log;
using Kokkos::Experimental::log1p;
using Kokkos::Experimental::sin;
using Kokkos::Experimental::sqrt;

/// The absolute value.
template <class T>
KOKKOS_INLINE_FUNCTION T abs(T x) {
  return x < T(0) ? -x : x;
}

#endif

///@{
/// The numbers of std::numeric_limits, whose functions are the host's alone.
template <class T>
constexpr T epsilon = std::numeric_limits<T>::epsilon();
template <class T>
constexpr T infinity = std::numeric_limits<T>::infinity();
template <class T>
constexpr T smallest_normal = std::numeric_limits<T>::min();
///@}

/// The smaller number; a where neither is smaller, as with a NaN.
template <class T>
KOKKOS_INLINE_FUNCTION T min(T a, T b) {
  return b < a ? b : a;
}

/// The larger number; a where neither is larger, as with a NaN.
template <class T>
KOKKOS_INLINE_FUNCTION T max(T a, T b) {
  return a < b ? b : a;
}
}  // namespace math

/// Whether kernels on Exec may touch Views of Device: every door to the kernels asks so, in these words.
template <class Exec, class Device>
constexpr void require_accessible() {
  static_assert(
      Kokkos::SpaceAccessibility<Exec, typename Device::memory_space>::accessible,
      "vsb: the execution space Exec cannot access the memory of Device. Take both from one backend: "
      "`using Device = Exec::device_type;`");
}

/// A named region in Kokkos Tools for the lifetime of the object (Kokkos has its own from 4.1 on).
class ProfilingRegion {
 public:
  /// Opens the region of this name.
  explicit ProfilingRegion(const std::string& label) { Kokkos::Profiling::pushRegion(label); }
  ~ProfilingRegion() { Kokkos::Profiling::popRegion(); }
  ProfilingRegion(const ProfilingRegion&) = delete;
  ProfilingRegion& operator=(const ProfilingRegion&) = delete;
};

}  // namespace vsb
