// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Runs the test cases of a program between Kokkos::initialize and Kokkos::finalize.
#if __has_include(<catch2/catch_all.hpp>)
#include <catch2/catch_session.hpp>
#else
#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>
#endif
#include <Kokkos_Core.hpp>

int main(int argc, char** argv) {
  Kokkos::initialize(argc, argv);  // takes its own arguments out of argv
  const int failures = Catch::Session().run(argc, argv);
  Kokkos::finalize();
  return failures;
}
