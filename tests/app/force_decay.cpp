// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// When a force ratio that falls exponentially comes to rest, and that one which stands is seen to.
#include "run/force_decay.hpp"

#include <cmath>

#include "catch.hpp"

using vsb::app::ForceDecay;

namespace {

/// Of a vibration of some hundreds of steps whose envelope falls to 1 / e in `decay` steps, on a level.
ForceDecay observed(double decay, double level, int checks, int interval = 100) {
  ForceDecay seen;
  for (int n = 1; n <= checks; ++n) {
    const double step = n * interval;
    seen.observe(n * interval, std::exp(-step / decay) * (1 + 0.5 * std::sin(step / 130)) + level);
  }
  return seen;
}

}  // namespace

TEST_CASE("the step at which an exponential reaches a ratio is foreseen") {
  for (const double decay : {2e3, 1e4})
    for (const int checks : {400, 1000, 4000, 13000}) {
      const auto seen = observed(decay, 0, checks);
      const auto end = seen.reaches(1e-300);
      REQUIRE(end);
      CHECK(std::abs(static_cast<double>(*end) / (decay * 300 * std::log(10)) - 1) < 0.1);
      CHECK(!seen.stands());
    }
}

TEST_CASE("one that is there already is foreseen for the step it is at") {
  const auto seen = observed(1e3, 0, 100);
  CHECK(*seen.reaches(0.5) == 10'000);
}

TEST_CASE("a ratio that stands is told, with its level and the step from which on it is there") {
  for (const int checks : {800, 4000, 50000}) {
    const auto seen = observed(2e3, 1e-4, checks);
    CHECK(!seen.reaches(1e-6));
    const auto level = seen.stands();
    REQUIRE(level);
    CHECK(std::abs(level->ratio / 1e-4 - 1) < 1e-3);
    // exp(-s / 2000) (1 +- 1/2) = 1e-4 / 9
    const int kept = checks < 3000 ? 100 : checks < 6000 ? 200 : 3200;  // steps between those that are kept
    CHECK(level->since > 18'000 - 5 * kept);
    CHECK(level->since < 25'000 + 5 * kept);
  }
}

TEST_CASE("too few checks say nothing") {
  CHECK(!observed(1e4, 1e-4, 5).reaches(1e-6));
  CHECK(!observed(1, 1e-4, 29).stands());
  CHECK(observed(1, 1e-4, 30).stands());
}
