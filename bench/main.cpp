// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// vsb_bench [--threads N] [options of Google Benchmark]: see README.md. Exit code 6 where a result is wrong.

#include "context.hpp"
#include "registry.hpp"

#include <cstdio>
#include <cstdlib>
#if defined(VSB_BACKEND_OPENMP)
#include <omp.h>
#endif

namespace {

/// Sets the number of threads that Kokkos will start with. False where that is not possible.
bool set_threads(const char* text) {
  char* end = nullptr;
  const long n = std::strtol(text, &end, 10);
  if (end == text || *end != '\0' || n < 1 || n > 4096) return false;
#if defined(VSB_BACKEND_OPENMP)
  omp_set_num_threads(static_cast<int>(n));
  return true;
#else
  return n == 1;
#endif
}

}  // namespace

int main(int argc, char** argv) {
  using namespace vsb::bench;
  const std::string filter = std::string("--benchmark_filter=") + default_filter;
  // Defaults first: an option given on the command line overrides them.
  std::vector<std::string> words{argv[0], filter, "--benchmark_min_time=0.3",
                                 "--benchmark_counters_tabular=true"};
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) != "--threads") {
      words.emplace_back(argv[i]);
    } else if (++i == argc || !set_threads(argv[i])) {
      std::fprintf(stderr, "vsb_bench: --threads wants a number of threads that the backend can have\n");
      return 2;
    }
  }
  std::vector<char*> pointers;
  for (auto& word : words) pointers.push_back(word.data());
  int count = static_cast<int>(pointers.size());
  benchmark::Initialize(&count, pointers.data());
  if (benchmark::ReportUnrecognizedArguments(count, pointers.data())) return 2;

  setenv("OMP_PROC_BIND", "false", 0);  // Kokkos warns where it is not set
  Kokkos::initialize();
  for (const auto& [name, value] : describe_build(Exec::name(), Exec().concurrency()))
    benchmark::AddCustomContext(name, value);
  register_kernels();
  register_steps();
  register_extra_cost();
  if constexpr (runs_on_host) {
    register_lanes();
    register_spline_lanes();
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  Kokkos::finalize();
  if (failed_checks() == 0) return 0;
  std::fprintf(stderr, "vsb_bench: %d benchmarks found wrong results and were not timed\n", failed_checks());
  return 6;
}
