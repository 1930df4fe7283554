// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Rates and extrapolated values from three values of a figure: those of f(h) = f* + C h^p, in any order of
/// h.
#include "study/convergence.hpp"

#include <cmath>

#include "support.hpp"

using vsb::app::convergence_of;

TEST_CASE("three values of a power law give its rate and its limit") {
  const std::array<std::array<double, 3>, 4> meshes = {
      {{0.5, 0.25, 0.125}, {0.125, 0.5, 0.25}, {0.3, 0.2, 0.1}, {1, 0.9, 0.2}}};
  for (const double p : {0.25, 1.0, 2.0, 4.3})
    for (const double C : {1.5, -0.7})
      for (const auto& h : meshes) {
        const auto f = [&](double x) { return -3 + C * std::pow(x, p); };
        const auto found = convergence_of(h, {f(h[0]), f(h[1]), f(h[2])});
        REQUIRE(found.rate);
        REQUIRE(found.extrapolated);
        CHECK(std::abs(*found.rate - p) < 1e-8);
        CHECK(std::abs(*found.extrapolated + 3) < 1e-8);
        CHECK(found.note.empty());
      }
}

TEST_CASE("values without a rate say why") {
  const std::array<double, 3> h = {1, 0.5, 0.25};
  CHECK(convergence_of(h, {1, 2, 1.5}).note == "not monotone: no rate");
  CHECK(convergence_of(h, {1, 2, 3}).note == "differences do not fall: no rate");
  CHECK(convergence_of(h, {1, 2, 4}).note == "differences do not fall: no rate");
  CHECK(convergence_of(h, {1, 2, 2 + 1e-9}).note == "differences fall too fast for a rate");
  for (const auto& values : {std::array<double, 3>{1, 2, 1.5}, {1, 2, 3}, {1, 2, 2}, {1, 2, 2 + 1e-9}}) {
    CHECK(!convergence_of(h, values).rate);
    CHECK(!convergence_of(h, values).extrapolated);
  }
  const auto same = convergence_of(h, {5, 5 + 1e-15, 5});
  CHECK(!same.rate);
  CHECK(same.extrapolated == 5.0);
}
