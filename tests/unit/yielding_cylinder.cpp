// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The exact cylinder of Mohr-Coulomb material: figures of an independent prototype, balance, the yield
/// condition, boundary values, continuity, and the elastic cylinder before anything yields.
#include <vsb/physics/exact_cylinder.hpp>
#include <vsb/physics/exact_mohr_coulomb_cylinder.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

const double degree = std::acos(-1.) / 180;

/// The wellbore of Section 4.4: c = 5 MPa, phi = 25 degrees, nu = 0.15.
ExactMohrCoulombCylinder<double> wellbore(double a, double pressure) {
  return {a, 0.0762, pressure, 5e6, 25 * degree, 0.15};
}

}  // namespace

TEST_CASE("figures of the wellbore, from an independent prototype") {
  const auto hole = wellbore(0.0127, 7e6);
  CHECK_THAT(hole.yield_pressure(), WithinAbs(4.354e6, 1e3));
  CHECK_THAT(hole.plastic_radius(), WithinAbs(16.92e-3, 5e-6));
  CHECK_THAT(hole.collapse_pressure(), WithinAbs(20.368e6, 0.5e3));
  CHECK_THAT(wellbore(0.03271, 0).collapse_pressure(), WithinAbs(7e6, 1e3));
}

TEST_CASE("Tresca: p / (2 c) = ln(rho / a) + (1 - rho^2 / b^2) / 2") {
  ExactMohrCoulombCylinder<double> tube{1, 3, 0, 2, 0, 0.3};
  CHECK_THAT(tube.collapse_pressure(), WithinRel(4 * std::log(3.), 1e-14));
  CHECK_THAT(tube.yield_pressure(), WithinRel(2 * (1 - 1. / 9), 1e-14));
  tube.pressure = 4 * (std::log(1.7) + 0.5 * (1 - 1.7 * 1.7 / 9));
  CHECK_THAT(tube.plastic_radius(), WithinRel(1.7, 1e-14));
}

TEST_CASE("stresses balance, yield inside the plastic radius and only there, and meet at it") {
  for (const double phi : {0., 25 * degree, 40 * degree}) {
    ExactMohrCoulombCylinder<double> tube{1, 5, 0, 2, phi, 0.15};
    const double limit = std::min(tube.collapse_pressure(), tube.largest_pressure());
    tube.pressure = 0.2 * tube.yield_pressure() + 0.8 * limit;
    const double rho = tube.plastic_radius(), sine = std::sin(phi), cosine = std::cos(phi), h = 1e-5;
    CHECK((rho > 1.5 && rho < 4.5));
    CHECK_THAT(tube.stress(1, rho).rr, WithinRel(-tube.pressure, 1e-14));
    CHECK_THAT(tube.stress(5, rho).rr, WithinAbs(0, 1e-14));
    const auto within = tube.stress(rho * (1 - 1e-13), rho), beyond = tube.stress(rho, rho);
    CHECK_THAT(within.rr, WithinAbs(beyond.rr, 1e-10));
    CHECK_THAT(within.tt, WithinAbs(beyond.tt, 1e-10));
    for (double r = 1.01; r < 4.99; r += 0.0317) {
      if (std::abs(r - rho) < 0.01) continue;
      const auto s = tube.stress(r, rho);
      const double slope = (tube.stress(r + h, rho).rr - tube.stress(r - h, rho).rr) / (2 * h);
      CHECK_THAT(r * slope, WithinAbs(s.tt - s.rr, 1e-8));
      const double f = s.tt - s.rr + (s.tt + s.rr) * sine - 4 * cosine;
      if (r < rho)
        CHECK_THAT(f, WithinAbs(0, 1e-12));
      else
        CHECK(f < -1e-6);
      const double zz = tube.axial_stress(s);
      CHECK((s.rr <= zz && zz <= s.tt));
    }
  }
}

TEST_CASE("at the largest pressure sigma_zz is as large as sigma_tt at the hole") {
  ExactMohrCoulombCylinder<double> tube{1, 5, 0, 2, 0, 0.15};
  tube.pressure = tube.largest_pressure();
  CHECK(tube.pressure < tube.collapse_pressure());
  const auto s = tube.stress(1, tube.plastic_radius());
  CHECK_THAT(tube.axial_stress(s), WithinRel(s.tt, 1e-13));
  CHECK(wellbore(0.0127, 0).largest_pressure() > wellbore(0.0127, 0).collapse_pressure());
  tube.poisson_ratio = 0.5;
  CHECK(std::isinf(tube.largest_pressure()));
}

TEST_CASE("below the yield pressure it is the elastic cylinder") {
  auto tube = wellbore(0.0127, 4e6);
  CHECK(tube.plastic_radius() == tube.inner_radius);
  const ExactCylinder<double> elastic{0.0127, 0.0762, 4e6, 3e8, 0.15};
  for (const double r : {0.0127, 0.02, 0.05, 0.0762}) {
    CHECK_THAT(tube.stress(r, 0.0127).rr, WithinAbs(elastic.stress(r).rr, 1e-7));
    CHECK_THAT(tube.stress(r, 0.0127).tt, WithinAbs(elastic.stress(r).tt, 1e-7));
  }
}
