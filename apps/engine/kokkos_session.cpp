// SPDX-License-Identifier: BSD-3-Clause
#include "engine/kokkos_session.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <vsb/views/kokkos_compat.hpp>

#include "engine/idle_cores.hpp"
#include "scene/scene_error.hpp"

#if defined(_OPENMP) && defined(VSB_BACKEND_OPENMP)
#include <omp.h>
#define VSB_HAS_THREADS 1
#endif

namespace vsb::app {

#if defined(VSB_HAS_THREADS)
namespace {

bool set_by_environment() {
  const char* threads = std::getenv("OMP_NUM_THREADS");
  return threads && threads[0] != '\0';
}

/// Kokkos keeps its threads in a table of this size (OpenMPInternal::MAX_THREAD_COUNT).
int most_threads() {
  return std::min(512, omp_get_thread_limit());
}

}  // namespace
#endif

void check_threads([[maybe_unused]] int threads) {
#if !defined(VSB_HAS_THREADS)
  if (threads > 1) throw SceneError("--threads: this program was built for a backend without threads; use 1");
#else
  const bool by_environment = threads == 0 && set_by_environment();
  const int asked = by_environment ? omp_get_max_threads() : threads, most = most_threads();
  if (asked > most)
    throw SceneError(
        fmt::format("{}: {} threads; this machine has {} cores, and at most {} threads are possible",
                    by_environment ? "OMP_NUM_THREADS" : "--threads", asked, omp_get_num_procs(), most));
#endif
}

#if defined(VSB_HAS_THREADS)
namespace {

std::string counted(int n, const char* what) {
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
}

/// Others' choice, beside what is idle.
ThreadChoice as_asked(int threads, const char* who) {
  ThreadChoice choice{threads, fmt::format("{}, by {}", counted(threads, "thread"), who)};
  const auto idle = threads > 1 ? idle_cores() : std::nullopt;
  if (idle && *idle < threads - 0.5)
    choice.why += fmt::format("; {:.1f} of {} are idle, so that fewer may be faster", *idle,
                              counted(omp_get_num_procs(), "core"));
  return choice;
}

}  // namespace
#endif

ThreadChoice choose_threads(int asked, [[maybe_unused]] const std::function<int()>& count_particles) {
  check_threads(asked);
#if defined(VSB_HAS_THREADS)
  if (asked > 0) return as_asked(asked, "--threads");
  if (set_by_environment()) return as_asked(omp_get_max_threads(), "OMP_NUM_THREADS");
  const int cores = std::min(omp_get_max_threads(), most_threads());
  if (cores == 1) return {1, "1 thread: there is 1 core"};
  const int particles = count_particles(), pay = particles / 10000;
  if (pay < 2) return {1, "1 thread: more do not pay below 20000 particles"};
  const int wanted = std::min(pay, cores);
  const auto idle = idle_cores();
  const int threads = idle ? std::clamp(static_cast<int>(std::lround(*idle)), 1, wanted) : wanted;
  if (threads < wanted)
    return {threads, fmt::format("{}: {:.1f} of {} are idle (--threads takes more)",
                                 counted(threads, "thread"), *idle, counted(cores, "core"))};
  return {threads, fmt::format("{} of {}", counted(threads, "thread"),
                               wanted == cores ? fmt::format("{}, which are idle", counted(cores, "core"))
                                               : fmt::format("{}: more do not pay for {} particles",
                                                             counted(cores, "core"), particles))};
#else
  return {asked, ""};
#endif
}

void wait_gently([[maybe_unused]] char** argv) {
#if defined(VSB_HAS_THREADS) && defined(__linux__) && !defined(__clang__)
  if (std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT")) return;
  setenv("GOMP_SPINCOUNT", "3000", 0);
  std::array<char, 4096> program{};  // its own name, not that of the link: it is what ps shows
  if (readlink("/proc/self/exe", program.data(), program.size() - 1) > 0) execv(program.data(), argv);
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
