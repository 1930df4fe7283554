// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Context of the benchmarks.

#include "context.hpp"

#include <Kokkos_Macros.hpp>
#include <build_info.hpp>
#include <fstream>

namespace vsb::bench {
namespace {

std::string cpu_model() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown";
}

std::string compiler() {
#if defined(__clang__)
  return "clang " __clang_version__;
#elif defined(__GNUC__)
  return "gcc " __VERSION__;
#else
  return "unknown";
#endif
}

/// The widest vector instructions that the compiler was allowed to use.
std::string instruction_set() {
#if defined(__AVX512F__)
  return "AVX-512";
#elif defined(__AVX2__) && defined(__FMA__)
  return "AVX2, FMA";
#elif defined(__AVX__)
  return "AVX";
#elif defined(__aarch64__)
  return "AArch64";
#elif defined(__x86_64__)
  return "x86-64";
#else
  return "unknown";
#endif
}

std::string kokkos_version() {
  return std::to_string(KOKKOS_VERSION / 10000) + "." + std::to_string(KOKKOS_VERSION / 100 % 100) + "." +
         std::to_string(KOKKOS_VERSION % 100);
}

}  // namespace

std::vector<std::pair<std::string, std::string>> describe_build(const std::string& backend, int threads) {
  return {{"vsb version", build_info::version},
          {"git commit", build_info::commit},
          {"Kokkos", kokkos_version() + ", " + backend + ", threads: " + std::to_string(threads)},
          {"compiler", compiler()},
          {"build type", build_info::build_type},
          {"flags", build_info::flags},
          {"instruction set", instruction_set()},
          {"CPU", cpu_model()}};
}

}  // namespace vsb::bench
