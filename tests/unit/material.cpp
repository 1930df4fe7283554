// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Kinematics of a particle, linear elasticity in rate form, and the explicit step of a node.
#include <vsb/physics/explicit_dynamics.hpp>
#include <vsb/physics/material.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

const double lame = 400, mu = 400;  // Young's modulus 1000 Pa, Poisson ratio 1/4

LinearElastic<double> rubber() {
  return LinearElastic<double>::from_young(1000, 0.25);
}

template <int Dim>
void check_equal(const SymmetricTensor<Dim, double>& s, const SymmetricTensor<Dim, double>& expected,
                 double tolerance) {
  for (int c = 0; c < SymmetricTensor<Dim, double>::size; ++c) {
    CAPTURE(c);
    CHECK_THAT(s[c], WithinAbs(expected[c], tolerance));
  }
}

}  // namespace

TEST_CASE("strain increment is dt times the symmetric part") {
  check_equal(strain_increment(Matrix<1, double>{{{4}}}, 0.5), {{2, 0, 0}}, 0);
  check_equal(strain_increment(Matrix<2, double>{{{1, 2}, {4, 3}}}, 0.5), {{0.5, 1.5, 0, 1.5}}, 0);
  check_equal(strain_increment(Matrix<3, double>{{{1, 2, 8}, {4, 3, -5}, {6, 1, 7}}}, 0.5),
              {{0.5, 1.5, 3.5, 1.5, -1, 3.5}}, 0);
  check_equal(strain_increment(Matrix<3, double>{{{0, 2, -8}, {-2, 0, 5}, {8, -5, 0}}}, 0.5), {{}}, 0);
}

TEST_CASE("Jaumann terms turn a stress like a small rotation, to second order") {
  // Rotation by an angle about the axis (1, 2, 2) / 3, by Rodrigues's formula.
  const double axis[3] = {1. / 3, 2. / 3, 2. / 3};
  const Matrix<3, double> spin{{{0, -axis[2], axis[1]}, {axis[2], 0, -axis[0]}, {-axis[1], axis[0], 0}}};
  const SymmetricTensor<3, double> sigma{{3, -1, 2, 0.5, 4, -2}};
  const auto error = [&](double angle, double& trace_change, double& norm_change) {
    double R[3][3], turned[3][3] = {};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        R[i][j] = (i == j) * std::cos(angle) + spin(i, j) * std::sin(angle) +
                  axis[i] * axis[j] * (1 - std::cos(angle));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k)
          for (int l = 0; l < 3; ++l) turned[i][j] += R[i][k] * sigma(k, l) * R[j][l];
    const auto s = turned_with_material(sigma, spin, angle);
    double sum = 0, norm = 0, norm_before = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        sum += std::abs(s(i, j) - turned[i][j]);
        norm += s(i, j) * s(i, j);
        norm_before += sigma(i, j) * sigma(i, j);
      }
    trace_change = s[0] + s[1] + s[2] - sigma[0] - sigma[1] - sigma[2];
    norm_change = norm - norm_before;
    return sum;
  };
  double trace[2], norm[2];
  const double large = error(0.02, trace[0], norm[0]), small = error(0.01, trace[1], norm[1]);
  CHECK_THAT(large / small, WithinAbs(4, 0.1));
  CHECK_THAT(norm[0] / norm[1], WithinAbs(4, 0.1));
  CHECK_THAT(trace[0], WithinAbs(0, 1e-14));
}

TEST_CASE("plane rotation turns uniaxial stress the way the material turns") {
  // Counter-clockwise spin of 1 rad/s for 0.01 s: sigma_xx = 1 gains shear sigma_xy = +0.01.
  const auto turned = turned_with_material<2, double>({{1, 0, 0, 0}}, {{{0, -1}, {1, 0}}}, 0.01);
  check_equal(turned, {{1, 0, 0, 0.01}}, 0);
  check_equal(turned_with_material<1, double>({{1, 2, 3}}, {{{5}}}, 0.01), {{1, 2, 3}}, 0);
}

TEST_CASE("simple shear of a hypoelastic material follows the closed form, to first order") {
  // sigma_xy = mu sin(gamma), sigma_xx = -sigma_yy = mu (1 - cos(gamma)).
  const double gamma = 2;
  const auto error = [&](int steps) {
    auto s = SymmetricTensor<2, double>::zero();
    for (int n = 0; n < steps; ++n) s = rubber().advance<2, double>(s, {{{0, gamma}, {0, 0}}}, 1. / steps);
    CHECK_THAT(s[0] + s[1], WithinAbs(0, 1e-10));
    CHECK_THAT(s[2], WithinAbs(0, 1e-10));
    return std::hypot(s[3] / mu - std::sin(gamma), s[0] / mu - (1 - std::cos(gamma)));
  };
  const double coarse = error(1000), fine = error(2000);
  CHECK(fine < 1.5e-3);
  CHECK_THAT(coarse / fine, WithinAbs(2, 0.02));
}

TEST_CASE("elastic stresses worked out by hand") {
  CHECK_THAT(rubber().lambda, WithinAbs(lame, 1e-12));
  CHECK_THAT(rubber().shear_modulus, WithinAbs(mu, 1e-12));
  CHECK_THAT(rubber().constrained_modulus(), WithinAbs(1200, 1e-12));

  const auto zero = LinearElastic<double>::from_young(1000, 0);
  CHECK(zero.lambda == 0);
  CHECK(zero.shear_modulus == 500);

  // Uniaxial strain 1e-3.
  check_equal(rubber().advance<1, double>({{10, 20, 30}}, {{{0.1}}}, 0.01), {{11.2, 20.4, 30.4}}, 1e-12);
  // Plane strain: tr = 3e-3, tensor shear 5e-4; sigma_zz carries lambda tr.
  check_equal(rubber().advance<2, double>({{}}, {{{0.1, 0.03}, {0.07, 0.2}}}, 0.01), {{2.0, 2.8, 1.2, 0.4}},
              1e-12);
  // tr = -1e-3: lambda tr = -0.4.
  check_equal(rubber().advance<3, double>({{1, 1, 1, 1, 1, 1}},
                                          {{{0.1, 0.02, 0.05}, {0.02, 0.2, 0.03}, {0.05, 0.03, -0.4}}}, 0.01),
              {{1 + 0.4, 1 + 1.2, 1 - 3.6, 1.16, 1.24, 1.4}}, 1e-12);
}

TEST_CASE("uniaxial stress needs Young's modulus and Poisson's contraction") {
  const double e = 1e-3;
  check_equal(rubber().advance<3, double>({{}}, {{{e, 0, 0}, {0, -0.25 * e, 0}, {0, 0, -0.25 * e}}}, 1.),
              {{1000 * e, 0, 0, 0, 0, 0}}, 1e-13);
}

TEST_CASE("LinearElastic refuses constants without meaning, and names them") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double E : {0., -1., nan})
    CHECK_THROWS_AS(LinearElastic<double>::from_young(E, 0.2), std::invalid_argument);
  for (const double nu : {0.5, 0.6, -1., nan})
    CHECK_THROWS_AS(LinearElastic<float>::from_young(1, nu), std::invalid_argument);
  CHECK_THROWS_WITH(LinearElastic<double>::from_young(1250, 0.75), containing("1250") && containing("0.75"));
  CHECK_NOTHROW(LinearElastic<double>::from_young(1e-3, 0.4999));
  CHECK_NOTHROW(LinearElastic<double>::from_young(1e12, -0.999));
}

TEST_CASE("volume updates") {
  const DeterminantVolume by_determinant;
  const ExponentialVolume by_exponential;
  SECTION("values by hand") {
    CHECK(by_determinant(4., Matrix<1, double>{{{-0.5}}}, 0.5) == 3);
    CHECK(by_determinant(4., Matrix<2, double>{{{1, 2}, {4, 3}}}, 0.5) ==
          7);  // det((1.5, 1), (2, 2.5)) = 1.75
    CHECK_THAT(by_exponential(4., Matrix<2, double>{{{1, 2}, {4, 3}}}, 0.25),
               WithinRel(4 * std::exp(1.), 1e-15));
  }
  SECTION("simple shear keeps the volume") {
    const Matrix<3, double> shear{{{0, 3, 0}, {0, 0, 0}, {0, 0, 0}}};
    CHECK(by_determinant(2., shear, 0.7) == 2);
    CHECK(by_exponential(2., shear, 0.7) == 2);
  }
  SECTION("a constant velocity gradient: the exponential is exact, the determinant of first order") {
    const Matrix<3, double> L{{{0.3, 1, 0}, {0, -0.5, 2}, {0, 0, 0.4}}};
    const auto after = [&](const auto& update, int steps) {
      double V = 1;
      for (int n = 0; n < steps; ++n) V = update(V, L, 1. / steps);
      return V;
    };
    const double exact = std::exp(0.2);
    CHECK_THAT(after(by_exponential, 1), WithinRel(exact, 1e-15));
    CHECK_THAT(after(by_exponential, 64), WithinRel(exact, 1e-13));
    const double coarse = after(by_determinant, 500) - exact, fine = after(by_determinant, 1000) - exact;
    CHECK(std::abs(fine) < 1e-3);
    CHECK_THAT(coarse / fine, WithinAbs(2, 0.01));
  }
}

TEST_CASE("Cundall damping opposes the motion, in proportion to the force") {
  CHECK_THAT(cundall_damped(10., 1e-9, 0.05), WithinAbs(9.5, 1e-14));
  CHECK_THAT(cundall_damped(10., -1e9, 0.05), WithinAbs(10.5, 1e-14));
  CHECK_THAT(cundall_damped(-10., 1., 0.05), WithinAbs(-10.5, 1e-14));
  CHECK_THAT(cundall_damped(-10., -1., 0.05), WithinAbs(-9.5, 1e-14));
  CHECK(cundall_damped(10., 0., 0.05) == 10);
  CHECK(cundall_damped(-10., -0., 0.05) == -10);
  CHECK(cundall_damped(0., 1., 0.05) == 0);
  CHECK(cundall_damped(10.f, 1.f, 0.f) == 10);

  Random random(4);
  for (int trial = 0; trial < 100; ++trial) {
    const double f = random(-1, 1), v = random(-1, 1), alpha = random(0.01, 0.9);
    CHECK((cundall_damped(f, v, alpha) - f) * v < 0);
  }
}

TEST_CASE("time step (29): a wave crosses the share kappa of a cell") {
  // Wave speed sqrt(1200 / 3) = 20 m/s.
  CHECK_THAT(time_step(0.2, 0.5, 1200, 3), WithinRel(0.2 * 0.5 / 20, 1e-15));
  CHECK_THAT(time_step(1, 40, 1200, 3), WithinRel(2., 1e-15));
}
