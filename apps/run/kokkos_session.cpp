// SPDX-License-Identifier: BSD-3-Clause
#include "run/kokkos_session.hpp"

#include <algorithm>
#include <cstdlib>
#include <vsb/views/kokkos_compat.hpp>

#include "scene/scene_error.hpp"

#if defined(_OPENMP) && defined(VSB_BACKEND_OPENMP)
#include <omp.h>
#define VSB_HAS_THREADS 1
#endif

namespace vsb::app {

void check_threads([[maybe_unused]] int threads) {
#if !defined(VSB_HAS_THREADS)
  if (threads > 1) throw SceneError("--threads: this program was built for a backend without threads; use 1");
#endif
}

int useful_threads(int particles) {
#if defined(VSB_HAS_THREADS)
  return std::clamp(particles / 10000, 1, omp_get_max_threads());
#else
  return particles > 0 ? 1 : 0;
#endif
}

int threads_at_hand() {
#if defined(VSB_HAS_THREADS)
  return omp_get_max_threads();
#else
  return 0;
#endif
}

KokkosSession::KokkosSession(int threads) {
  // Kokkos warns when nobody has decided about binding; threads of a desktop program are best left unbound.
  setenv("OMP_PROC_BIND", "false", 0);
  check_threads(threads);
#if defined(VSB_HAS_THREADS)
  if (threads > 0) omp_set_num_threads(threads);
#endif
  Kokkos::initialize();
}

KokkosSession::~KokkosSession() {
  Kokkos::finalize();
}

}  // namespace vsb::app
