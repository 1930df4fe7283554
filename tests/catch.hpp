// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Catch2, version 2 or 3, with the few names that differ between them.
#pragma once

#if __has_include(<catch2/catch_all.hpp>)
#include <catch2/catch_template_test_macros.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <catch2/matchers/catch_matchers_floating_point.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#else
#include <catch2/catch.hpp>
#endif

namespace vsb::test {

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

/// Matches a text that contains `part`.
inline auto containing(const std::string& part) {
#if __has_include(<catch2/catch_all.hpp>)
  return Catch::Matchers::ContainsSubstring(part);
#else
  return Catch::Matchers::Contains(part);
#endif
}

}  // namespace vsb::test
