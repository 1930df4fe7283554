// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Principal values against Eigen's, and Hencky elasticity: closed forms, objectivity, closed paths, the
/// limit of small strain.
#define EIGEN_NO_CUDA  // on the host, also where nvcc compiles
#include <Eigen/Dense>
#include <vsb/physics/exact_column.hpp>
#include <vsb/physics/hencky.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

const double lame = 400, mu = 300, modulus = lame + 2 * mu;
const Hencky<double> rubber{lame, mu};

using Dense = Eigen::Matrix3d;

/// All three directions; F33 = 1 and so on where a dimension is left out.
template <int Dim>
Dense dense(const Matrix<Dim, double>& m, double rest = 0) {
  Dense full = rest * Dense::Identity();
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) full(i, j) = m(i, j);
  return full;
}
template <int Dim>
Dense dense(const SymmetricTensor<Dim, double>& s) {
  Dense full = Dense::Zero();
  for (int i = 0; i < 3; ++i) full(i, i) = s[i];
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) full(i, j) = s(i, j);
  return full;
}
template <int Dim>
Matrix<Dim, double> in_plane(const Dense& full) {
  Matrix<Dim, double> m;
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) m(i, j) = full(i, j);
  return m;
}

/// A symmetric tensor Q diag(values) Q^T with a random rotation Q of the directions in the plane.
template <int Dim>
SymmetricTensor<Dim, double> turned(const Eigen::Vector3d& values, Random& random) {
  Dense Q = Dense::Identity();
  for (int i = 0; i < Dim; ++i)
    for (int j = i + 1; j < Dim; ++j) {
      const double angle = random(0, 6.3);
      Dense R = Dense::Identity();
      R(i, i) = R(j, j) = std::cos(angle);
      R(i, j) = std::sin(angle);
      R(j, i) = -R(i, j);
      Q = Q * R;
    }
  const Dense full = Q * values.asDiagonal() * Q.transpose();
  SymmetricTensor<Dim, double> s;
  for (int i = 0; i < 3; ++i) s[i] = full(i, i);
  for (int i = 0; i < Dim; ++i)
    for (int j = i + 1; j < Dim; ++j) s[symmetric_index(i, j)] = full(i, j);
  return s;
}

/// The decomposition of s against Eigen's, and put together again.
template <int Dim>
void check_decomposition(const SymmetricTensor<Dim, double>& s) {
  const Dense full = dense(s);
  const double scale = full.norm(), tolerance = 8 * epsilon<double> * scale;
  CAPTURE(full);
  const auto p = principal_values(s);
  Eigen::Vector3d ours(p.value[0], p.value[1], p.value[2]);
  std::sort(ours.data(), ours.data() + 3);
  const Eigen::Vector3d theirs = Eigen::SelfAdjointEigenSolver<Dense>(full).eigenvalues();
  CHECK((ours - theirs).norm() <= tolerance);
  const Dense n = dense(p.direction, 1);
  CHECK((n.transpose() * n - Dense::Identity()).norm() <= 16 * epsilon<double>);
  CHECK((dense(from_principal_values(p)) - full).norm() <= tolerance);
}

/// The Cauchy stress of a deformation gradient, by Eigen's decomposition of F F^T.
Dense reference_stress(const Dense& F) {
  const Eigen::SelfAdjointEigenSolver<Dense> b(F * F.transpose());
  const Dense strain = b.eigenvectors() * (0.5 * b.eigenvalues().array().log()).matrix().asDiagonal() *
                       b.eigenvectors().transpose();
  return (lame * strain.trace() * Dense::Identity() + 2 * mu * strain) / F.determinant();
}

template <int Dim>
Matrix<Dim, double> displacement_gradient(const Matrix<Dim, double>& F) {
  auto H = F;
  for (int i = 0; i < Dim; ++i) H(i, i) -= 1;
  return H;
}

/// The velocity gradient that takes F to the next one in one step of length dt.
template <int Dim>
Matrix<Dim, double> velocity_gradient(const Dense& F, const Dense& next, double dt) {
  return in_plane<Dim>((next * F.inverse() - Dense::Identity()) / dt);
}

/// The stress after steps through the deformation gradients F(0), ..., F(1).
template <int Dim, class Path>
SymmetricTensor<Dim, double> follow(const Path& F, int steps) {
  Vector<Dim * Dim, double> state = Vector<Dim * Dim, double>::zero();
  auto sigma = SymmetricTensor<Dim, double>::zero();
  const double dt = 0.25;
  for (int n = 0; n < steps; ++n) {
    const auto L = velocity_gradient<Dim>(F(double(n) / steps), F(double(n + 1) / steps), dt);
    sigma = rubber.advance(sigma, state, L, dt);
  }
  return sigma;
}

Dense plane(double a, double b, double c, double d) {
  Dense F = Dense::Identity();
  F(0, 0) = a, F(0, 1) = b, F(1, 0) = c, F(1, 1) = d;
  return F;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("principal values and directions of random and degenerate tensors", "",
                       ((int Dim), Dim), 1, 2, 3) {
  Random random(91);
  const auto check = [&](double a, double b, double c) {
    for (int turn = 0; turn < 20; ++turn) check_decomposition(turned<Dim>({a, b, c}, random));
  };
  for (int trial = 0; trial < 200; ++trial) {
    SymmetricTensor<Dim, double> s;
    for (int c = 0; c < s.size; ++c) s[c] = random(-1, 1);
    check_decomposition(s);
  }
  check(0, 0, 0);
  check(2, 2, 2);
  check(2, 2, -1);
  check(-1, 2, 2);
  check(1, 1 + 1e-15, 1 - 1e-15);
  check(1, 1 + 1e-9, 5);
  check(1e8, 1, 1e-8);
  check(1e150, -1e150, 3e149);
  check(1e-200, 2e-200, -3e-200);
  check_decomposition(SymmetricTensor<Dim, double>::isotropic(7));
}

TEST_CASE("single precision decomposes to its own round-off") {
  const SymmetricTensor<3, float> s{{1, 2, 3, 0.5f, -0.25f, 4}};
  const auto again = from_principal_values(principal_values(s));
  for (int c = 0; c < 6; ++c) CHECK_THAT(again[c], WithinAbs(s[c], 16 * epsilon<float>));
}

TEMPLATE_TEST_CASE_SIG("the stress of random deformations, Eigen doing the algebra", "", ((int Dim), Dim), 1,
                       2, 3) {
  Random random(92);
  for (int trial = 0; trial < 200; ++trial) {
    auto F = Matrix<Dim, double>::identity();
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) F(i, j) += random(-0.6, 0.6) / Dim;
    const Dense expected = reference_stress(dense(F, 1));
    const double difference = (dense(rubber.stress(displacement_gradient(F))) - expected).norm();
    CAPTURE(dense(F, 1));
    CHECK(difference < 1e-11 * expected.norm());
  }
}

TEST_CASE("uniaxial strain: M ln(l) / l along the axis, and lambda ln(l) / l across it") {
  for (const double l : {0.05, 0.5, 0.999999, 1.0, 1.3, 4.0}) {
    const auto s = rubber.stress(Matrix<1, double>{{{l - 1}}});
    CAPTURE(l);
    CHECK_THAT(s[0], WithinRel(modulus * std::log(l) / l, 1e-9));
    CHECK_THAT(s[1], WithinRel(lame * std::log(l) / l, 1e-9));
    CHECK(s[2] == s[1]);
    const auto plane_strain = rubber.stress(Matrix<2, double>{{{0, 0}, {0, l - 1}}});
    CHECK_THAT(plane_strain[1], WithinAbs(s[0], 1e-12 * modulus));
    CHECK_THAT(plane_strain[0], WithinAbs(s[1], 1e-12 * modulus));
    CHECK_THAT(plane_strain[2], WithinAbs(s[1], 1e-12 * modulus));
    CHECK(plane_strain[3] == 0);
  }
}

TEST_CASE("simple shear: with sinh(a) = gamma / 2 the stress is 2 mu a (tanh(a), -tanh(a), 1 / cosh(a))") {
  // The stretches are exp(+-a), a = asinh(gamma / 2), and tan of the angle of the first with x is exp(-a): so
  // cos and sin of twice the angle are tanh(a) and 1 / cosh(a).
  for (const double gamma : {1e-6, 0.1, 1.0, 5.0}) {
    const double a = std::asinh(gamma / 2);
    const auto s = rubber.stress(Matrix<2, double>{{{0, gamma}, {0, 0}}});
    CAPTURE(gamma);
    CHECK_THAT(s[3], WithinRel(2 * mu * a / std::cosh(a), 1e-13));
    CHECK_THAT(s[0], WithinAbs(2 * mu * a * std::tanh(a), 1e-13 * mu));
    CHECK_THAT(s[1], WithinAbs(-2 * mu * a * std::tanh(a), 1e-13 * mu));
    CHECK_THAT(s[2], WithinAbs(0, 1e-13 * mu));
  }
}

TEST_CASE("a rotation leaves no stress, and turns the stress that is there") {
  const double pi = 3.14159265358979323846;
  const auto rotation = [&](double t) {
    return plane(std::cos(2 * pi * t), -std::sin(2 * pi * t), std::sin(2 * pi * t), std::cos(2 * pi * t));
  };
  const auto s = follow<2>(rotation, 500);
  for (int c = 0; c < 4; ++c) CHECK_THAT(s[c], WithinAbs(0, 1e-11 * mu));

  const Dense F = plane(1.3, 0.2, -0.1, 0.8), R = rotation(0.11);
  const auto before = dense(rubber.stress(displacement_gradient(in_plane<2>(F))));
  const auto after = dense(rubber.stress(displacement_gradient(in_plane<2>(R * F))));
  CHECK((after - R * before * R.transpose()).norm() < 1e-12 * before.norm());
}

TEST_CASE("a closed path of deformation ends without stress, where the rate form leaves some") {
  // Shear, stretch, shear back, shorten back: four corners in the plane of (shear, stretch).
  const auto path = [](double t) {
    const double leg = 4 * t,
                 shear = leg < 1   ? leg
                         : leg < 2 ? 1
                         : leg < 3 ? 3 - leg
                                   : 0,
                 stretch = leg < 1   ? 0
                           : leg < 2 ? leg - 1
                           : leg < 3 ? 1
                                     : 4 - leg;
    return plane(1, shear, 0, 1 + stretch);
  };
  const auto s = follow<2>(path, 400);
  for (int c = 0; c < 4; ++c) CHECK_THAT(s[c], WithinAbs(0, 1e-11 * mu));

  const LinearElastic<double> rate{lame, mu};
  auto drifted = SymmetricTensor<2, double>::zero();
  for (int n = 0; n < 40000; ++n)
    drifted = rate.advance(drifted, velocity_gradient<2>(path(n / 40000.), path((n + 1) / 40000.), 1.), 1.);
  CHECK(dense(drifted).norm() > 0.1 * mu);
}

TEMPLATE_TEST_CASE_SIG("small strains give the stress of linear elasticity, to the order of the strain", "",
                       ((int Dim), Dim), 1, 2, 3) {
  Random random(93);
  Matrix<Dim, double> G;
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) G(i, j) = random(-1, 1);
  const auto difference = [&](double size) {  // relative to the stress
    auto H = G;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) H(i, j) *= size;
    const LinearElastic<double> linear{lame, mu};
    const auto expected = linear.advance(SymmetricTensor<Dim, double>::zero(), H, 1.);
    return dense(rubber.stress(H) - expected).norm() / dense(expected).norm();
  };
  CHECK_THAT(difference(1e-4) / difference(5e-5), WithinAbs(2, 0.01));
  CHECK(difference(1e-4) < 1e-3);
  CHECK(difference(1e-12) < 1e-11);  // no digits are lost: H is kept, not F
}

TEST_CASE("the column's stretch under a Cauchy traction") {
  for (const double s : {1e-9, 1e-3, 0.5, 1.0, 10.0, -1e-3, -0.2, -0.36}) {
    const ExactHenckyColumn<double> column{s * modulus, modulus};
    const double l = 1 + column.displacement(2.0) / 2;
    CAPTURE(s);
    CHECK_THAT(rubber.stress(Matrix<1, double>{{{l - 1}}})[0], WithinRel(-s * modulus, 1e-7));
    CHECK(column.stress() == -s * modulus);
    CHECK(((s > 0) == (l < 1)));
    CHECK(l < std::exp(1.0));  // the branch that begins at no stretch
  }
  const ExactHenckyColumn<double> limit{-ExactHenckyColumn<double>::limit(), 1};
  CHECK_THAT(limit.logarithmic_stretch(), WithinAbs(1, 1e-7));
}
