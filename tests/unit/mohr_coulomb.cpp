// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The return to the Mohr-Coulomb surface with tension cut-off: every region by hand, random states, the
/// closest point in the energy norm by a search along the surface, turned and exchanged axes, paths of
/// laboratory tests.
#define EIGEN_NO_CUDA  // on the host, also where nvcc compiles
#include <Eigen/Dense>
#include <vsb/physics/mohr_coulomb.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

const double infinite = std::numeric_limits<double>::infinity(), degree = std::acos(-1.) / 180;

/// sin(phi) = 0.6, cos(phi) = 0.8; c = 5: f = 1.6 s1 - 0.4 s3 - 8. E = 80, nu = 1/4: lambda = mu = 32.
MohrCoulombConstants constants(double sin_dilation, double tensile_strength = infinite) {
  return {80, 0.25, 5, std::asin(0.6), std::asin(sin_dilation), tensile_strength};
}
MohrCoulomb<double> rock(double sin_dilation, double tensile_strength = infinite) {
  return MohrCoulomb<double>::from(constants(sin_dilation, tensile_strength));
}

template <int Dim>
auto no_state() {
  return Vector<MohrCoulomb<double>::state_size<Dim>(), double>::zero();
}

struct Return {
  Eigen::Vector3d stress, strain;
};

/// Of a trial stress given by its principal values along x, y and z.
Return returned(const MohrCoulomb<double>& m, const Eigen::Vector3d& trial) {
  SymmetricTensor<1, double> stress{{trial[0], trial[1], trial[2]}};
  auto state = no_state<1>();
  if (m.may_yield(stress, state)) m.return_stress(stress, state);
  return {{stress[0], stress[1], stress[2]}, {state[0], state[1], state[2]}};
}
void check_near(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double tolerance) {
  CAPTURE(a, b);
  CHECK((a - b).cwiseAbs().maxCoeff() <= tolerance);
}
/// The trial stress of a state and of a plastic strain that would have to vanish: s + C e.
Eigen::Vector3d trial_of(const Eigen::Vector3d& s, const Eigen::Vector3d& e) {
  return s + Eigen::Vector3d::Constant(32 * e.sum()) + 64 * e;
}
/// A state on the surface and a combination of its flow directions: the return must undo the strain.
void check_return(const MohrCoulomb<double>& m, const Eigen::Vector3d& s, const Eigen::Vector3d& strain) {
  const auto trial = trial_of(s, strain);
  for (const auto& order :
       {std::array<int, 3>{0, 1, 2}, {1, 0, 2}, {2, 1, 0}, {0, 2, 1}, {1, 2, 0}, {2, 0, 1}}) {
    Eigen::Vector3d t, expected, flow;
    for (int k = 0; k < 3; ++k) {
      const int at = order[static_cast<size_t>(k)];
      t[at] = trial[k], expected[at] = s[k], flow[at] = strain[k];
    }
    const auto r = returned(m, t);
    check_near(r.stress, expected, 1e-12);
    check_near(r.strain, flow, 1e-14);
  }
}

/// How far principal stresses are beyond the surface, Pa.
double beyond(const MohrCoulombConstants& c, Eigen::Vector3d s) {
  std::sort(s.data(), s.data() + 3);
  return std::max(
      s[2] - s[0] + (s[2] + s[0]) * std::sin(c.friction_angle) - 2 * c.cohesion * std::cos(c.friction_angle),
      s[2] - c.tensile_strength);
}

Eigen::Matrix3d dense(const SymmetricTensor<3, double>& s) {
  Eigen::Matrix3d m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m(i, j) = s(i, j);
  return m;
}
SymmetricTensor<3, double> packed(const Eigen::Matrix3d& m) {
  SymmetricTensor<3, double> s;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) s[symmetric_index(i, j)] = m(i, j);
  return s;
}
Eigen::Vector3d eigenvalues(const SymmetricTensor<3, double>& s) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(dense(s)).eigenvalues();
}
Eigen::Matrix3d random_rotation(Random& random) {
  Eigen::Quaterniond q(random(-1, 1), random(-1, 1), random(-1, 1), random(-1, 1));
  return q.normalized().toRotationMatrix();
}

/// The squared distance of principal stresses in the energy norm: d : C^-1 : d.
double energy(const Eigen::Vector3d& d, double E, double nu) {
  return ((1 + nu) * d.squaredNorm() - nu * d.sum() * d.sum()) / E;
}

/// The least distance from `trial` to the surface, by a search that knows nothing of planes: over all
/// directions from a point inside to where they meet the surface, on ever finer grids of angles.
double least_energy(const MohrCoulombConstants& c, const Eigen::Vector3d& trial,
                    const Eigen::Vector3d& inside) {
  const auto value = [&](double azimuth, double height) {
    const Eigen::Vector3d along(std::cos(azimuth) * std::cos(height), std::sin(azimuth) * std::cos(height),
                                std::sin(height));
    double in = 0, out = 200;
    for (int n = 0; n < 50; ++n) {
      const double middle = (in + out) / 2;
      (beyond(c, inside + middle * along) > 0 ? out : in) = middle;
    }
    return energy(inside + in * along - trial, c.youngs_modulus, c.poisson_ratio);
  };
  const Eigen::Vector3d towards = trial - inside;
  double azimuth = std::atan2(towards[1], towards[0]), height = std::asin(towards[2] / towards.norm()),
         best = value(azimuth, height);
  for (double range = 1.5; range > 1e-9; range *= 0.6) {
    const double a0 = azimuth, h0 = height;
    for (int i = -6; i <= 6; ++i)
      for (int j = -6; j <= 6; ++j) {
        const double a = a0 + i * range / 6, h = h0 + j * range / 6, v = value(a, h);
        if (v < best) best = v, azimuth = a, height = h;
      }
  }
  return best;
}

}  // namespace

TEST_CASE("an elastic trial stress and the state stay as they are, bit by bit") {
  const auto m = rock(0.2, 4);
  for (const Eigen::Vector3d& s : std::initializer_list<Eigen::Vector3d>{
           Eigen::Vector3d(0, 0, 0), {3.9, 3.9, -4}, {-20, -1, -3}, {4, 1, -4}}) {
    const auto r = returned(m, s);
    CHECK((r.stress == s && r.strain == Eigen::Vector3d::Zero()));
  }
}

TEST_CASE("the return to the main plane by hand") {
  // f(10, -10) = 16 + 4 - 8 = 12. psi = 0: D m = 64 (1, 0, -1), n . D m = 64 * 2: lambda = 12 / 128.
  auto r = returned(rock(0), {10, 0, -10});
  check_near(r.stress, {4, 0, -4}, 1e-13);
  check_near(r.strain, {12. / 128, 0, -12. / 128}, 1e-15);
  // psi = phi: m = (1.6, 0, -0.4), D m = 32 * 1.2 + 64 m = (140.8, 38.4, 12.8), n . D m = 220.16.
  r = returned(rock(0.6), {10, 0, -10});
  const double l = 12 / 220.16;
  check_near(r.stress, {10 - 140.8 * l, -38.4 * l, -10 - 12.8 * l}, 1e-13);
  check_near(r.strain, {1.6 * l, 0, -0.4 * l}, 1e-15);
}

TEST_CASE("every region: the return undoes any strain in the cone of its flow directions") {
  for (const double d : {0., 0.25, 0.6}) {
    const Eigen::Vector3d m13(1 + d, 0, d - 1), m12(1 + d, d - 1, 0), m23(0, 1 + d, d - 1);
    const auto m = rock(d);
    check_return(m, {4, 0, -4}, 0.1 * m13);
    // s1 = (8 + 0.4 s3) / 1.6.
    check_return(m, {2.5, -10, -10}, 0.1 * m13 + 0.04 * m12);  // s2 = s3: triaxial extension
    check_return(m, {4.5, 4.5, -2}, 0.05 * m13 + 0.02 * m23);  // s1 = s2: triaxial compression
    check_return(m, {2.5, -10, -10}, 0.1 * m13 + 0.1 * m12);   // where two planes weigh the same
    // The apex, c cot(phi) = 5 * 4 / 3.
    if (d > 0) {
      const double apex = 20. / 3;
      check_return(m, {apex, apex, apex}, 0.03 * m13 + 0.01 * m12 + 0.005 * m23 + 0.02 * m12);
    }
    // The cut-off at 4.5, where the pyramid has s3 = -2, and at 2.
    const auto cut = rock(d, 4.5);
    const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                          z = Eigen::Vector3d::UnitZ();
    check_return(cut, {4.5, 3, 1}, 0.1 * x);
    check_return(cut, {4.5, 4.5, 1}, 0.1 * x + 0.05 * y);
    check_return(cut, {4.5, 4.5, 4.5}, 0.1 * x + 0.05 * y + 0.01 * z);
    check_return(cut, {4.5, 1, -2}, 0.1 * x + 0.03 * m13);
    check_return(cut, {4.5, -2, -2}, 0.1 * x + 0.03 * m13 + 0.02 * m12);
    check_return(cut, {4.5, 4.5, -2}, 0.1 * x + 0.03 * m13 + 0.08 * y);
    check_return(cut, {4.5, 4.5, -2}, 0.1 * x + 0.03 * m13 + 0.02 * m23);
  }
}

TEST_CASE("beyond the apex without dilation, where no flow direction leads there") {
  const auto r = returned(rock(0), {9, 8, 7.5});
  check_near(r.stress, Eigen::Vector3d::Constant(20. / 3), 1e-12);
  check_near(trial_of(r.stress, r.strain), {9, 8, 7.5}, 1e-12);
}

TEST_CASE("a cut-off beyond the apex cuts nothing off") {
  const Eigen::Vector3d trial(9, 8, 7);
  check_near(returned(rock(0.3, 20. / 3), trial).stress, returned(rock(0.3), trial).stress, 0);
  check_near(returned(rock(0.3, 100), trial).stress, returned(rock(0.3), trial).stress, 0);
}

TEMPLATE_TEST_CASE_SIG("a million random trial states come back to the surface", "", ((int Dim), Dim), 1, 2,
                       3) {
  Random random(301);
  double worst = 0, worst_back = 0;
  long yielded = 0;
  for (const double sine : {0., 0.3, 0.6})
    for (const double share : {0., 0.5, 1.})
      for (const double tension : {infinite, 6., 3., 0.}) {
        const MohrCoulombConstants c{80, 0.25, 5, std::asin(sine), std::asin(share * sine), tension};
        const auto m = MohrCoulomb<double>::from(c);
        for (int n = 0; n < 10000; ++n) {
          SymmetricTensor<Dim, double> trial;
          const double size = std::pow(10., random(0, 2.5));
          for (int k = 0; k < trial.size; ++k) trial[k] = size * random(-1, 1) - (k < 3 ? random(0, 10) : 0);
          auto stress = trial;
          auto state = no_state<Dim>();
          if (m.may_yield(trial, state)) m.return_stress(stress, state);
          SymmetricTensor<3, double> full = SymmetricTensor<3, double>::zero(), strain = full;
          for (int k = 0; k < trial.size; ++k) full[k] = stress[k], strain[k] = state[k];
          worst = std::max(worst, beyond(c, eigenvalues(full)) / c.cohesion);
          yielded += state[0] != 0;
          // sigma_trial - sigma = C : plastic strain.
          const double trace = strain[0] + strain[1] + strain[2];
          for (int k = 0; k < trial.size; ++k)
            worst_back = std::max(worst_back,
                                  std::abs(trial[k] - stress[k] - 64 * state[k] - (k < 3 ? 32 * trace : 0)));
        }
      }
  CHECK(yielded > 150000);
  CHECK(yielded < 350000);
  CHECK(worst < 1e-10);
  CHECK(worst_back < 1e-11);
}

TEST_CASE("with associated flow the return is the closest point in the energy norm") {
  Random random(302);
  int compared = 0;
  for (const double tension : {infinite, 4.5, 1.})
    for (int n = 0; n < 60; ++n) {
      const auto c = constants(0.6, tension);
      const auto m = MohrCoulomb<double>::from(c);
      const Eigen::Vector3d trial(random(-20, 20), random(-20, 20), random(-20, 20));
      if (beyond(c, trial) <= 0) continue;
      const auto r = returned(m, trial);
      const double ours = energy(r.stress - trial, 80, 0.25),
                   least = least_energy(c, trial, Eigen::Vector3d::Constant(-5));
      CAPTURE(trial, r.stress);
      CHECK(ours <= least * (1 + 1e-9));
      CHECK(least <= ours * (1 + 2e-4));
      ++compared;
    }
  CHECK(compared > 100);
}

TEST_CASE("turned axes turn the result, and exchanged axes exchange it") {
  Random random(304);
  const auto m = rock(0.25, 4.5);
  for (int n = 0; n < 500; ++n) {
    const Eigen::Vector3d trial(random(-20, 20), random(-20, 20), n % 3 == 0 ? 3. : random(-20, 20));
    const auto plain = returned(m, n % 5 == 0 ? Eigen::Vector3d(trial[0], trial[1], trial[1]) : trial);
    const Eigen::Vector3d values = n % 5 == 0 ? Eigen::Vector3d(trial[0], trial[1], trial[1]) : trial;
    const auto Q = random_rotation(random);
    auto stress = packed(Q * values.asDiagonal() * Q.transpose());
    auto state = no_state<3>();
    if (m.may_yield(stress, state)) m.return_stress(stress, state);
    CHECK((dense(stress) - Q * plain.stress.asDiagonal() * Q.transpose()).norm() < 1e-12);
    SymmetricTensor<3, double> strain;
    for (int k = 0; k < 6; ++k) strain[k] = state[k];
    CHECK((dense(strain) - Q * plain.strain.asDiagonal() * Q.transpose()).norm() < 1e-13);
  }
}

TEST_CASE("principal stresses in closed form against Eigen's") {
  Random random(305);
  const auto check = [](const SymmetricTensor<3, double>& s) {
    const auto p = principal_stresses(s);
    Eigen::Vector3d ours(p.value[0], p.value[1], p.value[2]);
    std::sort(ours.data(), ours.data() + 3);
    const double tolerance = 16 * epsilon<double> * dense(s).norm();
    CAPTURE(dense(s));
    CHECK((ours - eigenvalues(s)).norm() <= tolerance);
    Eigen::Matrix3d n;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) n(i, j) = p.direction(i, j);
    CHECK((n.transpose() * n - Eigen::Matrix3d::Identity()).norm() <= 16 * epsilon<double>);
    CHECK((dense(from_principal_values(p)) - dense(s)).norm() <= tolerance);
  };
  for (int n = 0; n < 3000; ++n) {
    SymmetricTensor<3, double> s;
    for (int k = 0; k < 6; ++k) s[k] = random(-1, 1) * std::pow(10., random(-6, 0));
    check(s);
  }
  const double eps = epsilon<double>;
  for (const Eigen::Vector3d& values : std::initializer_list<Eigen::Vector3d>{Eigen::Vector3d(0, 0, 0),
                                                                              {2, 2, 2},
                                                                              {2, 2, -1},
                                                                              {-1, -1, 2},
                                                                              {1, 1 + 1e-9, 5},
                                                                              {1, 1 + 1e-15, 1 - 1e-15},
                                                                              {1, 1 + 4 * eps, 1 + 1e-8},
                                                                              {1e8, 1, 1e-8},
                                                                              {1, 0, -1},
                                                                              {1e-7, 0, -1e-7},
                                                                              {1, 2, 3}})
    for (int turn = 0; turn < 50; ++turn) {
      const auto Q = random_rotation(random);
      check(packed(Q * values.asDiagonal() * Q.transpose()));
      check(packed(values.asDiagonal()));
    }
}

TEST_CASE("uniaxial compression and tension, triaxial compression: the loads of the laboratory") {
  // Strain along z, stress-free or held at -q across: found by correcting the lateral strain.
  const auto strength = [](const MohrCoulomb<double>& m, double q, double rate) {
    auto sigma = SymmetricTensor<3, double>::isotropic(-q);
    auto state = no_state<3>();
    for (int n = 0; n < 400; ++n) {
      auto L = Matrix<3, double>::zero();
      L(2, 2) = rate;
      SymmetricTensor<3, double> next;
      auto s = state;
      for (int iteration = 0; iteration < 200; ++iteration) {
        s = state;
        next = m.advance(sigma, s, L, 1);
        L(0, 0) = L(1, 1) = L(0, 0) - 0.5 * (next[0] + next[1] + 2 * q) / 160;
      }
      sigma = next;
      state = s;
    }
    return sigma[2];
  };
  for (const double d : {0., 0.6}) {
    const auto m = rock(d);
    // 2 c cos(phi) / (1 - sin(phi)) = 20, 2 c cos(phi) / (1 + sin(phi)) = 5; the factor of confinement is 4.
    CHECK_THAT(strength(m, 0, -1e-3), WithinAbs(-20, 1e-7));
    CHECK_THAT(strength(m, 3, -1e-3), WithinAbs(-32, 1e-7));
    CHECK_THAT(strength(m, 0, 1e-3), WithinAbs(5, 1e-7));
    CHECK_THAT(strength(rock(d, 2), 0, 1e-3), WithinAbs(2, 1e-7));
  }
}

TEST_CASE("Tresca: shear strength c whatever the mean stress, and no plastic volume") {
  const auto m = MohrCoulomb<double>::from({80, 0.25, 5});
  for (const double mean : {-1000., 0., 1000.}) {
    const auto r = returned(m, {mean + 9, mean, mean - 9});
    check_near(r.stress, {mean + 5, mean, mean - 5}, 1e-11);
    CHECK_THAT(r.strain.sum(), WithinAbs(0, 1e-13));
  }
}

TEST_CASE("the quick test misses no state beyond the surface, and passes most that are well within") {
  Random random(306);
  for (const double tension : {infinite, 2.}) {
    const auto c = constants(0.2, tension);
    const auto m = MohrCoulomb<double>::from(c);
    int missed = 0, inside = 0, passed = 0;
    for (int n = 0; n < 100000; ++n) {
      const Eigen::Vector3d s(random(-15, 10), random(-15, 10), random(-15, 10));
      const bool may = m.may_yield(SymmetricTensor<1, double>{{s[0], s[1], s[2]}}, no_state<1>());
      const double f = beyond(c, s);
      missed += f > 1e-13 && !may;
      inside += f < -2;
      passed += f < -2 && !may;
    }
    CHECK(missed == 0);
    CHECK(inside > 5000);
    CHECK(passed > 0.75 * inside);
  }
}

TEST_CASE("plastic strain turns with the material") {
  // Stretched along x beyond yield, turned by a right angle, stretched along the material's x again: twice
  // the plastic strain of the first time, along y.
  const auto m = rock(0.2);
  auto sigma = SymmetricTensor<2, double>::zero();
  auto state = no_state<2>();
  sigma = m.advance(sigma, state, {{{0.2, 0}, {0, 0}}}, 1);
  const double first = state[0], second = state[1];
  CHECK(first > 0.05);
  const int steps = 20000;
  const double angle = std::acos(0.) / steps;
  for (int n = 0; n < steps; ++n) sigma = m.advance(sigma, state, {{{0, -angle}, {angle, 0}}}, 1);
  CHECK_THAT(state[1], WithinRel(first, 1e-3));
  CHECK_THAT(state[0], WithinRel(second, 1e-3));
  // At the apex, where no deviator is left of the stress, it is that of the strain: 2/3 of the stretches.
  const auto measure = [&] { return equivalent_plastic_deviatoric_strain(plastic_strain_in<2>(state)); };
  CHECK_THAT(measure(), WithinRel(2. / 3 * 0.2, 1e-3));
  sigma = m.advance(sigma, state, {{{0, 0}, {0, 0.2}}}, 1);
  CHECK_THAT(measure(), WithinRel(2. / 3 * 0.4, 1e-3));
}

TEST_CASE("equivalent plastic deviatoric strain (34)") {
  // Uniaxial without volume: the axial strain. Pure shear of tensor component g: 2 g / sqrt(3).
  const auto uniaxial = [](double x, double y) {
    return equivalent_plastic_deviatoric_strain(SymmetricTensor<1, double>{{x, y, y}});
  };
  CHECK_THAT(uniaxial(0.3, -0.15), WithinRel(0.3, 1e-15));
  CHECK_THAT(uniaxial(0.5, 0.05), WithinRel(0.3, 1e-15));
  const double shear = 0.6 / std::sqrt(3.);
  const SymmetricTensor<2, double> plane{{1, 1, 1, 0.3}};
  CHECK_THAT(equivalent_plastic_deviatoric_strain(plane), WithinRel(shear, 1e-15));
  const SymmetricTensor<3, double> space{{0, 0, 0, 0, 0, -0.3}};
  CHECK_THAT(equivalent_plastic_deviatoric_strain(space), WithinRel(shear, 1e-15));
}

TEST_CASE("single precision is right to its own digits") {
  const auto d = rock(0.25, 4.5);
  const auto f = MohrCoulomb<float>::from(constants(0.25, 4.5));
  Random random(307);
  for (int n = 0; n < 2000; ++n) {
    SymmetricTensor<3, double> a;
    SymmetricTensor<3, float> b;
    for (int k = 0; k < 6; ++k) a[k] = b[k] = random.draw<float>(-20, 20);
    auto s = no_state<3>();
    auto t = Vector<7, float>::zero();
    if (d.may_yield(a, s)) d.return_stress(a, s);
    if (f.may_yield(b, t)) f.return_stress(b, t);
    for (int k = 0; k < 6; ++k) {
      CHECK_THAT(static_cast<double>(b[k]), WithinAbs(a[k], 2e-4));
      CHECK_THAT(static_cast<double>(t[k]), WithinAbs(s[k], 4e-6));
    }
  }
}

TEST_CASE("what is not finite stays so, and ends") {
  const auto m = rock(0.25, 4.5);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), infinite, -infinite})
    for (int c = 0; c < 6; ++c) {
      SymmetricTensor<3, double> s{{1, 2, 3, 4, 5, 6}};
      s[c] = bad;
      auto state = no_state<3>();
      m.return_stress(s, state);
      bool finite = true;
      for (int k = 0; k < 6; ++k) finite = finite && std::isfinite(s[k]);
      CHECK_FALSE(finite);
    }
}

TEST_CASE("MohrCoulomb refuses constants without meaning, and names them") {
  const auto with = [](double c, double phi, double psi, double tension) {
    return MohrCoulomb<double>::from({80, 0.25, c, phi * degree, psi * degree, tension});
  };
  CHECK_NOTHROW(with(0, 30, 30, 0));
  CHECK_NOTHROW(with(1, 0, 0, infinite));
  CHECK_THROWS_AS(with(0, 0, 0, 0), std::invalid_argument);
  CHECK_THROWS_AS(with(-1, 30, 0, 0), std::invalid_argument);
  CHECK_THROWS_AS(with(1, 90, 0, 0), std::invalid_argument);
  CHECK_THROWS_AS(with(1, -1, 0, 0), std::invalid_argument);
  CHECK_THROWS_AS(with(1, 30, 31, 0), std::invalid_argument);
  CHECK_THROWS_AS(with(1, 30, -1, 0), std::invalid_argument);
  CHECK_THROWS_AS(with(std::nan(""), 30, 0, 0), std::invalid_argument);
  CHECK_THROWS_WITH(with(7, 30, 0, -2), containing("cohesion 7") && containing("tensile strength -2"));
  CHECK_THROWS_AS(MohrCoulomb<double>::from({0, 0.25, 1}), std::invalid_argument);
}
