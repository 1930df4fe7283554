// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Exact solutions: each satisfies its differential equations and boundary conditions, and known special
/// cases.
#include <vsb/physics/exact_column.hpp>
#include <vsb/physics/exact_cylinder.hpp>
#include <vsb/physics/exact_ellipse.hpp>
#include <vsb/physics/exact_hencky_wall.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

const double pi = 3.14159265358979323846;

/// f'(x) by central differences of fourth order; round-off near 1e-12 f / x, truncation below it.
template <class F>
double derivative(const F& f, double x, double h = 1e-3) {
  return (8 * (f(x + h) - f(x - h)) - (f(x + 2 * h) - f(x - 2 * h))) / (12 * h);
}

}  // namespace

TEST_CASE("column: a stress rate E du'/u' integrated in small steps gives the displacement") {
  const ExactColumn<double> column{300, 1e3};
  CHECK(column.stress() == -300);
  const auto integrated = [&](int steps) {  // a fibre of length 2 shortened by d(ln l) = d(sigma) / E
    double length = 2;
    for (int n = 0; n < steps; ++n) length -= length * 0.3 / steps;
    return length - 2;
  };
  const double coarse = integrated(1000) - column.displacement(2),
               fine = integrated(2000) - column.displacement(2);
  CHECK(std::abs(fine) < 1e-4);
  CHECK_THAT(coarse / fine, WithinAbs(2, 0.01));
}

TEST_CASE("column: small loads give the linear answer; the printed formula differs in the third order") {
  CHECK_THAT(ExactColumn<double>({1e-6, 1e3}).displacement(3), WithinRel(-3e-9, 1e-8));
  CHECK_THAT(ExactColumn<double>({1, 1e3}).displacement_as_printed(1), WithinAbs(-9.995003330835e-4, 1e-16));
  for (const double e : {0.1, 0.01, 0.001}) {
    const ExactColumn<double> column{e * 1e3, 1e3};
    const double difference = (column.displacement(5) - column.displacement_as_printed(5)) / 5;
    CAPTURE(e);
    // exp(-e) - 1 + ln(1 + e) = e^3 / 6 - 5 e^4 / 24 + 23 e^5 / 120 - ...
    CHECK_THAT(difference, WithinAbs(e * e * e / 6, 5 * e * e * e * e / 24));
    CHECK_THAT(difference, WithinAbs(e * e * e / 6 - 5 * e * e * e * e / 24, e * e * e * e * e / 5 + 1e-18));
  }
}

TEST_CASE("cylinder: tractions, equilibrium and compatibility with Hooke's law in plane strain") {
  const double a = 5, b = 12, p = 7e3, E = 1e6, nu = 0.2;
  const ExactCylinder<double> cylinder{a, b, p, E, nu};
  CHECK_THAT(cylinder.stress(a).rr, WithinRel(-p, 1e-14));
  CHECK_THAT(cylinder.stress(b).rr, WithinAbs(0, 1e-12 * p));
  for (const double r : {5.0, 6.3, 9., 12.}) {
    const auto s = cylinder.stress(r);
    CAPTURE(r);
    CHECK(s.rt == 0);
    const double equilibrium = derivative([&](double x) { return x * cylinder.stress(x).rr; }, r) - s.tt;
    CHECK_THAT(equilibrium, WithinAbs(0, 1e-9 * p));
    // Strains of u(r) times E / (1 + nu).
    const double rr = derivative([&](double x) { return cylinder.radial_displacement(x); }, r) * E / (1 + nu);
    const double tt = cylinder.radial_displacement(r) / r * E / (1 + nu);
    CHECK_THAT(rr, WithinAbs((1 - nu) * s.rr - nu * s.tt, 1e-9 * p));
    CHECK_THAT(tt, WithinAbs((1 - nu) * s.tt - nu * s.rr, 1e-12 * p));
  }
}

TEST_CASE("ellipse: the hole feels the pressure and nothing else") {
  const double a0 = 2, b0 = 1.5, p = 12.5e3;
  for (const double K : {0.5, 1., 2.}) {
    const ExactEllipse<double> ellipse{a0, b0, p, 1e4, K, 0.2};
    for (int k = 0; k < 24; ++k) {
      const double t = (k + 0.3) * pi / 12;
      const auto s = ellipse.stress({{a0 * std::cos(t), b0 * std::sin(t)}});
      Vector<2, double> normal{{std::cos(t) / a0, std::sin(t) / b0}};
      normal *= 1 / std::sqrt(dot(normal, normal));
      const auto traction = s * normal;
      CAPTURE(K, t);
      for (int i = 0; i < 2; ++i) CHECK_THAT(traction[i], WithinAbs(-p * normal[i], 1e-11 * p));
    }
  }
}

TEST_CASE("ellipse: the far field, and what is left of the hole at a distance") {
  const ExactEllipse<double> ellipse{2, 1.5, 12.5e3, 1e4, 0.5, 0.2};
  for (const double t : {0.1, 2., 3., 4., 6.}) {
    const auto s = ellipse.stress({{1e7 * std::cos(t), 1e7 * std::sin(t)}});
    CAPTURE(t);
    CHECK_THAT(s[0], WithinAbs(-0.5e4, 1e-8));
    CHECK_THAT(s[1], WithinAbs(-1e4, 1e-8));
    CHECK_THAT(s[3], WithinAbs(0, 1e-8));
  }
}

TEST_CASE("ellipse: equilibrium, compatibility and plane strain at inner points") {
  const ExactEllipse<double> ellipse{2, 1.5, 12.5e3, 1e4, 2, 0.2};
  const auto component = [&](int c) {
    return [=](double x, double y) { return ellipse.stress({{x, y}})[c]; };
  };
  for (const auto& point :
       {Vector<2, double>{{2.5, 0.7}}, {{-0.6, 2.1}}, {{-3, -1}}, {{4, -6}}, {{0.01, -1.7}}}) {
    const double x = point[0], y = point[1];
    CAPTURE(x, y);
    const auto ddx = [&](const auto& f) { return derivative([&](double t) { return f(t, y); }, x); };
    const auto ddy = [&](const auto& f) { return derivative([&](double t) { return f(x, t); }, y); };
    CHECK_THAT(ddx(component(0)) + ddy(component(3)), WithinAbs(0, 1e-3));  // of gradients near 1e4 Pa/m
    CHECK_THAT(ddx(component(3)) + ddy(component(1)), WithinAbs(0, 1e-3));
    // The trace is harmonic: second differences in x and y cancel.
    const auto trace = [&](double u, double v) { return component(0)(u, v) + component(1)(u, v); };
    const double h = 1e-3;
    const double laplace =
        trace(x + h, y) + trace(x - h, y) + trace(x, y + h) + trace(x, y - h) - 4 * trace(x, y);
    CHECK_THAT(laplace / (h * h), WithinAbs(0, 1));
    CHECK_THAT(component(2)(x, y), WithinRel(0.2 * trace(x, y), 1e-14));
  }
}

TEST_CASE("ellipse: symmetric about both axes") {
  const ExactEllipse<double> ellipse{2, 1.5, 12.5e3, 1e4, 0.5, 0.2};
  for (const auto& at : {Vector<2, double>{{2.2, 0.4}}, {{0.3, 1.6}}, {{5, 5}}}) {
    const auto s = ellipse.stress(at);
    for (const double sx : {1., -1.})
      for (const double sy : {1., -1.}) {
        const auto m = ellipse.stress({{sx * at[0], sy * at[1]}});
        for (int c = 0; c < 3; ++c) CHECK_THAT(m[c], WithinAbs(s[c], 1e-8));
        CHECK_THAT(m[3], WithinAbs(sx * sy * s[3], 1e-8));
      }
  }
}

TEST_CASE("ellipse: Inglis's hoop stresses at the ends of the axes") {
  // Plate under tension S, T along x, y with a traction-free hole: sigma_yy = T (1 + 2 a/b) - S at (a, 0),
  // and with axes exchanged at (0, b). The pressurised hole is that of S + p, T + p, shifted by -p I.
  const double a = 3, b = 1.2, p = 9, s0 = 4;
  for (const double K : {0.5, 1., 2.}) {
    const double S = p - K * s0, T = p - s0;
    const ExactEllipse<double> ellipse{a, b, p, s0, K, 0.3};
    CHECK_THAT(ellipse.stress({{a, 0}})[1], WithinAbs(T * (1 + 2 * a / b) - S - p, 1e-11));
    CHECK_THAT(ellipse.stress({{0, b}})[0], WithinAbs(S * (1 + 2 * b / a) - T - p, 1e-11));
  }
}

TEST_CASE("ellipse: a circular hole is Kirsch's, with the pressure's Lame stress") {
  const double a = 2, p = 5, s0 = 3;
  for (const double K : {0.5, 1., 2.}) {
    const ExactEllipse<double> ellipse{a, a, p, s0, K, 0.2};
    const double mean = -(K + 1) * s0 / 2, swing = -(K - 1) * s0 / 2;
    for (const double r : {2., 2.7, 11.})
      for (const double t : {0.2, 1.1, 2.9, -2.}) {
        const double q = a * a / (r * r), x = r * std::cos(t), y = r * std::sin(t);
        const auto s = to_polar(ellipse.stress({{x, y}}), x, y);
        CAPTURE(K, r, t);
        CHECK_THAT(s.rr, WithinAbs(mean * (1 - q) + swing * (1 - 4 * q + 3 * q * q) * std::cos(2 * t) - p * q,
                                   1e-12));
        CHECK_THAT(s.tt,
                   WithinAbs(mean * (1 + q) - swing * (1 + 3 * q * q) * std::cos(2 * t) + p * q, 1e-12));
        CHECK_THAT(s.rt, WithinAbs(-swing * (1 + 2 * q - 3 * q * q) * std::sin(2 * t), 1e-12));
      }
  }
}

TEST_CASE("ellipse: K = 2 is K = 1/2 turned by a right angle, for a circle") {
  const ExactEllipse<double> two{2, 2, 5, 3, 2, 0.2}, one_half{2, 2, 5, 6, 0.5, 0.2};
  for (const auto& at : {Vector<2, double>{{2.1, 0.4}}, {{-0.3, 3}}, {{5, -5}}}) {
    const auto s = two.stress(at), turned = one_half.stress({{at[1], at[0]}});
    CHECK_THAT(s[0], WithinAbs(turned[1], 1e-12));
    CHECK_THAT(s[1], WithinAbs(turned[0], 1e-12));
    CHECK_THAT(s[3], WithinAbs(turned[3], 1e-12));
  }
}

TEST_CASE("polar components by hand, and there and back") {
  const SymmetricTensor<2, double> s{{3, -1, 8, 0.5}};
  const auto right = to_polar(s, 2., 0.), up = to_polar(s, 0., 3.), diagonal = to_polar(s, -1., -1.);
  CHECK(right.rr == 3);
  CHECK(right.tt == -1);
  CHECK(right.rt == 0.5);
  CHECK(up.rr == -1);
  CHECK(up.tt == 3);
  CHECK(up.rt == -0.5);
  CHECK_THAT(diagonal.rr, WithinAbs(1.5, 1e-15));
  CHECK_THAT(diagonal.tt, WithinAbs(0.5, 1e-15));
  CHECK_THAT(diagonal.rt, WithinAbs(-2, 1e-15));

  Random random(5);
  for (int trial = 0; trial < 20; ++trial) {
    SymmetricTensor<3, double> t = SymmetricTensor<3, double>::zero();
    for (const int c : {0, 1, 3}) t[c] = random(-1, 1);
    const double x = random(-5, 5), y = random(-5, 5);
    const auto back = from_polar<3>(to_polar(t, x, y), x, y);
    for (int c = 0; c < 6; ++c) CHECK_THAT(back[c], WithinAbs(t[c], 1e-15));
  }
}

TEST_CASE("Hencky wall: equilibrium, the law, and the conditions at both faces") {
  const int hoops = GENERATE(1, 2);
  const double lambda = 5e5, mu = 4e5, p = 1e5;
  const ExactHenckyWall<double> wall{1, 2, p, lambda, mu, hoops};
  const double hole = wall.hole_radius();
  REQUIRE(hole > 1);
  const auto initial = [&](double r) { return wall.at(r, hole).initial_radius; };
  CHECK_THAT(initial(hole), WithinAbs(1, 1e-14));
  CHECK_THAT(wall.at(hole, hole).stress.rr, WithinAbs(-p, 1e-9));
  double outer = hole;  // the radius of what was at 2
  for (double low = hole, high = 3; high - low > 1e-13;) {
    outer = (low + high) / 2;
    (initial(outer) < 2 ? low : high) = outer;
  }
  CHECK_THAT(wall.at(outer, hole).stress.rr, WithinAbs(0, 1e-6 * p));
  for (const double r : {1.05 * hole, 0.5 * (hole + outer), 0.98 * outer}) {
    const auto state = wall.at(r, hole);
    const auto rr = [&](double x) { return wall.at(x, hole).stress.rr; };
    CHECK_THAT(derivative(rr, r), WithinRel(-hoops * (state.stress.rr - state.stress.tt) / r, 1e-7));
    const double a = std::log(1 / derivative(initial, r)), b = std::log(r / state.initial_radius),
                 log_J = a + hoops * b, J = std::exp(log_J);
    CHECK_THAT(J * state.stress.rr, WithinAbs(lambda * log_J + 2 * mu * a, 1e-7 * p));
    CHECK_THAT(J * state.stress.tt, WithinAbs(lambda * log_J + 2 * mu * b, 1e-7 * p));
    CHECK_THAT(J * state.axial_stress, WithinAbs(lambda * log_J + (hoops == 2 ? 2 * mu * b : 0), 1e-7 * p));
  }
}

TEST_CASE("Hencky wall: Lame's solutions under a small pressure") {
  const double E = 1e6, nu = 0.3, p = 1e-2, a3 = 1, b3 = 8, r = 1.4;
  const double lambda = E * nu / (1 + nu) / (1 - 2 * nu), mu = E / 2 / (1 + nu);
  const ExactHenckyWall<double> cylinder{1, 2, p, lambda, mu, 1}, sphere{1, 2, p, lambda, mu, 2};
  const ExactCylinder<double> small{1, 2, p, E, nu};
  CHECK_THAT(cylinder.hole_radius() - 1, WithinRel(small.radial_displacement(1), 1e-6));
  CHECK_THAT(cylinder.at(r, cylinder.hole_radius()).stress.tt, WithinRel(small.stress(r).tt, 1e-6));
  CHECK_THAT(sphere.hole_radius() - 1,
             WithinRel(p * a3 / (b3 - a3) / E * ((1 - 2 * nu) + (1 + nu) * b3 / (2 * a3)), 1e-6));
  CHECK_THAT(sphere.at(r, sphere.hole_radius()).stress.tt,
             WithinRel(p * a3 / (b3 - a3) * (1 + b3 / (2 * r * r * r)), 1e-6));
}

TEST_CASE("Hencky wall: no equilibrium beyond the limit load") {
  CHECK_FALSE(std::isfinite(ExactHenckyWall<double>{1, 2, 1e6, 5e5, 4e5, 1}.hole_radius()));
}
