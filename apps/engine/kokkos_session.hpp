// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Kokkos and its threads, for sources that include nothing of Kokkos.
#pragma once

#include <functional>
#include <string>

namespace vsb::app {

/// Throws SceneError for more threads than the backend has.
void check_threads(int threads);

/// How many threads, and why, for the screen.
struct ThreadChoice {
  int threads;  ///< 0: as the backend sees fit
  std::string why;
};

/// `asked` threads, where that is not 0, or OMP_NUM_THREADS; else as many as pay (below ten thousand
/// particles each, starting a kernel costs more than it saves), but no more than there are idle cores:
/// threads that share a core with other work are waited for at the end of every kernel.
ThreadChoice choose_threads(int asked, const std::function<int()>& count_particles);

/// Makes threads that wait for others give their core away soon. The OpenMP of GCC lets them spin for
/// milliseconds, which on a core that other work wants too makes a run ten times slower, and asks its
/// environment when the program is loaded: the program starts itself anew with that environment, unless it
/// has been set.
void wait_gently(char** argv);

/// Of the backend; 0 where it has none of its own.
int threads_at_hand();

/// Kokkos for the lifetime of the object, with this many threads (0: OMP_NUM_THREADS, or all cores).
class KokkosSession {
 public:
  explicit KokkosSession(int threads);
  ~KokkosSession();
  KokkosSession(const KokkosSession&) = delete;
  KokkosSession& operator=(const KokkosSession&) = delete;
};

}  // namespace vsb::app
