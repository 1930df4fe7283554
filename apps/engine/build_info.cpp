// SPDX-License-Identifier: BSD-3-Clause
#include "engine/build_info.hpp"

#include <fmt/format.h>

#include <vsb/views/kokkos_compat.hpp>

#include "vsb_commit.hpp"

namespace vsb::app {

namespace {

std::string devices() {
  std::string names;
#ifdef KOKKOS_ENABLE_SERIAL
  names += " Serial";
#endif
#ifdef KOKKOS_ENABLE_OPENMP
  names += " OpenMP";
#endif
#ifdef KOKKOS_ENABLE_CUDA
  names += " Cuda";
#endif
  return names.substr(1);
}

std::string instruction_set() {
#if defined(__AVX512F__)
  return "x86-64 with AVX-512";
#elif defined(__AVX2__)
  return "x86-64 with AVX2";
#elif defined(__x86_64__)
  return "x86-64 base";
#elif defined(__ARM_FEATURE_SVE)
  return "AArch64 with SVE";
#elif defined(__aarch64__)
  return "AArch64";
#else
  return "unknown";
#endif
}

}  // namespace

const std::vector<std::pair<std::string, std::string>>& build_info() {
  static const std::vector<std::pair<std::string, std::string>> info = {
      {"version", VSB_VERSION},
      {"commit", VSB_COMMIT},
      {"compiler", VSB_COMPILER},
      {"build_type", VSB_BUILD_TYPE},
      {"kokkos",
       fmt::format("{}.{}.{}", KOKKOS_VERSION / 10000, KOKKOS_VERSION / 100 % 100, KOKKOS_VERSION % 100)},
      {"kokkos_devices", devices()},
      {"backend", VSB_BACKEND_NAME},
      {"instruction_set", instruction_set()},
  };
  return info;
}

std::string apps_directory() {
  return VSB_APPS_DIRECTORY;
}

}  // namespace vsb::app
