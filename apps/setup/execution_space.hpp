// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Where the program's kernels run, by the backend of its build.
#pragma once

#include <type_traits>
#include <vsb/views/kokkos_compat.hpp>

namespace vsb::app {

#if defined(VSB_BACKEND_CUDA)
using ExecutionSpace = Kokkos::Cuda;
#elif defined(VSB_BACKEND_OPENMP)
using ExecutionSpace = Kokkos::OpenMP;
#else
using ExecutionSpace = Kokkos::Serial;
#endif

/// Whether that is the host. On a device there are no cell lanes as yet: a thread would work on a whole
/// layer.
constexpr bool runs_on_host = std::is_same_v<ExecutionSpace::memory_space, Kokkos::HostSpace>;

}  // namespace vsb::app
