// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Where the program's kernels run, by the backend of its build.
#pragma once

#include <vsb/views/kokkos_compat.hpp>

namespace vsb::app {

#if defined(VSB_BACKEND_CUDA)
using ExecutionSpace = Kokkos::Cuda;
#elif defined(VSB_BACKEND_OPENMP)
using ExecutionSpace = Kokkos::OpenMP;
#else
using ExecutionSpace = Kokkos::Serial;
#endif

}  // namespace vsb::app
