// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Kokkos and its threads, for sources that include nothing of Kokkos.
#pragma once

namespace vsb::app {

/// Throws SceneError for more threads than the backend has.
void check_threads(int threads);

/// Threads that pay: below ten thousand particles each, starting a kernel costs more than it saves. 0: as the
/// backend sees fit.
int useful_threads(int particles);

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
