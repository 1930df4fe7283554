// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Drucker-Prager and von Mises plasticity: returns by hand, hardening slopes, the three cones against
/// Mohr-Coulomb, random states; and what packs say of whether their lanes may yield.
#include <vsb/physics/drucker_prager.hpp>
#include <vsb/physics/mohr_coulomb.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

template <int Dim>
using StateOf = Vector<DruckerPrager<double>::state_size<Dim>(), double>;

struct Result {
  SymmetricTensor<3, double> stress;
  StateOf<3> state;
};
Result returned(const DruckerPrager<double>& m, const SymmetricTensor<3, double>& trial, double kappa = 0) {
  Result r{trial, StateOf<3>::zero()};
  r.state[7] = kappa;
  if (m.may_yield(r.stress, r.state)) m.return_stress(r.stress, r.state);
  return r;
}
void check_stress(const SymmetricTensor<3, double>& s, const SymmetricTensor<3, double>& expected,
                  double tolerance = 1e-12) {
  for (int c = 0; c < 6; ++c) {
    CAPTURE(c);
    CHECK_THAT(s[c], WithinAbs(expected[c], tolerance));
  }
}

/// E = 80, nu = 1/4: lambda = mu = 32, K = 160 / 3. eta = 0.3, eta_bar = 0.15, xi = 0.5, c = 8.
DruckerPrager<double> cone(double hardening = 0, double dilation = 0.15) {
  return {LinearElastic<double>::from_young(80, 0.25), 0.3, dilation, 0.5, 8, hardening};
}

}  // namespace

TEST_CASE("the return to the cone by hand") {
  // Pure shear 10 with mean stress -5: J = 10, f = 10 - 1.5 - 4 = 4.5; per multiplier 32 + 160/3 * 0.045 =
  // 34.4.
  const double l = 4.5 / 34.4;
  const auto r = returned(cone(), {{-5, -5, -5, 10, 0, 0}});
  const double mean = -5 - 8 * l;
  check_stress(r.stress, {{mean, mean, mean, 10 - 32 * l, 0, 0}});
  CHECK_THAT(r.state[7], WithinAbs(0.5 * l, 1e-15));
  // The plastic strain: l (s / (2 J) + eta_bar / 3 I).
  for (int i = 0; i < 3; ++i) CHECK_THAT(r.state[i], WithinAbs(0.05 * l, 1e-15));
  CHECK_THAT(r.state[3], WithinAbs(0.5 * l, 1e-15));
}

TEST_CASE("von Mises, which has no apex, takes the whole deviator where round-off says so") {
  const auto m = DruckerPrager<double>::von_mises(77, 0.3, 1e-30, 0);
  Random random(5);
  int beyond = 0;  // where G (J / G) > J
  for (int n = 0; n < 1000; ++n) {
    const double shear = random(1, 2), G = m.elastic.shear_modulus;
    beyond += G * (shear / G) > shear;
    check_stress(returned(m, {{7, 7, 7, shear, 0, 0}}).stress, {{7, 7, 7, 0, 0, 0}});
  }
  CHECK(beyond > 0);
}

TEST_CASE("with hardening the state returned to lies on the cone that has grown") {
  // H = 16, kappa = 1 before: xi (8 + 16) = 12 > 10: elastic; then J = 20: f = 20 - 12 = 8, 36 in place of
  // 32 with xi^2 H = 4.
  CHECK(returned(cone(16, 0), {{0, 0, 0, 10, 0, 0}}, 1).stress[3] == 10);
  const auto r = returned(cone(16, 0), {{0, 0, 0, 20, 0, 0}}, 1);
  CHECK_THAT(r.stress[3], WithinAbs(20 - 32 * 8. / 36, 1e-12));
  CHECK_THAT(r.state[7], WithinAbs(1 + 0.5 * 8. / 36, 1e-14));
  CHECK_THAT(r.stress[3], WithinAbs(0.5 * (8 + 16 * r.state[7]), 1e-12));
}

TEST_CASE("the apex: c xi / eta, and with hardening where the volume strain takes it") {
  // xi c / eta = 40 / 3.
  check_stress(returned(cone(), {{40, 41, 39, 0.5, 0, 0}}).stress,
               SymmetricTensor<3, double>::isotropic(40. / 3));
  check_stress(returned(cone(0, 0), {{40, 41, 39, 0.5, 0, 0}}).stress,
               SymmetricTensor<3, double>::isotropic(40. / 3));
  const auto r = returned(cone(16), {{40, 40, 40, 0, 0, 0}});
  // kappa = xi / eta_bar e_v, mean = 40 - K e_v = xi (c + H kappa) / eta.
  const double e_v = r.state[0] + r.state[1] + r.state[2];
  CHECK_THAT(r.state[7], WithinRel(0.5 / 0.15 * e_v, 1e-12));
  CHECK_THAT(r.stress[0], WithinRel(40 - 160. / 3 * e_v, 1e-12));
  CHECK_THAT(r.stress[0], WithinRel(0.5 * (8 + 16 * r.state[7]) / 0.3, 1e-12));
  // Where the generator ends, the cone's return and the apex are one.
  const double J = 5, mean = 40. / 3 + 160. / 3 * 0.15 * J / 32;
  const auto low = returned(cone(), {{mean, mean, mean, J * (1 + 1e-9), 0, 0}}),
             high = returned(cone(), {{mean, mean, mean, J * (1 - 1e-9), 0, 0}});
  check_stress(low.stress, high.stress, 1e-7);
  check_stress(low.stress, SymmetricTensor<3, double>::isotropic(40. / 3), 1e-7);
}

TEST_CASE("von Mises in uniaxial stress: the yield stress, then the slope E H / (E + H)") {
  const double E = 80, H = 20, yield = 0.4;
  const auto m = DruckerPrager<double>::von_mises(E, 0.25, yield, H);
  const auto stress_at = [&](double strain) {
    auto sigma = SymmetricTensor<3, double>::zero();
    auto state = StateOf<3>::zero();
    const int steps = 100;
    for (int n = 0; n < steps; ++n) {
      auto L = Matrix<3, double>::zero();
      L(0, 0) = strain / steps;
      SymmetricTensor<3, double> next;
      StateOf<3> s;
      for (int iteration = 0; iteration < 200; ++iteration) {  // no stress across
        s = state;
        next = m.advance(sigma, s, L, 1);
        L(1, 1) = L(2, 2) = L(1, 1) - 0.5 * (next[1] + next[2]) / 160;
      }
      sigma = next;
      state = s;
    }
    // kappa is the equivalent plastic strain, and that of (34).
    CHECK_THAT(state[7], WithinAbs(equivalent_plastic_deviatoric_strain(plastic_strain_in<3>(state)), 1e-12));
    CHECK_THAT(state[7], WithinAbs(std::max(0., (sigma[0] - yield) / H), 1e-10));
    return sigma[0];
  };
  CHECK_THAT(stress_at(0.004), WithinRel(0.32, 1e-10));
  CHECK_THAT(stress_at(0.015), WithinRel(yield + (0.015 - 0.005) * E * H / (E + H), 1e-8));
  CHECK_THAT(stress_at(0.025), WithinRel(yield + (0.025 - 0.005) * E * H / (E + H), 1e-8));
}

TEST_CASE("outer and inner cones touch Mohr-Coulomb at its edges, the plane strain cone in plane flow") {
  const double phi = std::asin(0.6), c = 5;
  const auto with = [&](DruckerPragerCone cone, double psi) {
    return DruckerPrager<double>::from({80, 0.25, c, phi, psi, 0, cone});
  };
  const auto f = [](const DruckerPrager<double>& m, double s1, double s2, double s3) {
    const SymmetricTensor<3, double> s{{s1, s2, s3, 0, 0, 0}};
    const double mean = mean_stress(s);
    return std::sqrt(second_invariant(s, mean)) + m.friction * mean - m.cohesion_factor * m.cohesion;
  };
  // 1.6 s1 - 0.4 s3 = 8: triaxial extension, and compression.
  CHECK_THAT(f(with(DruckerPragerCone::inner, 0), 2.5, -10, -10), WithinAbs(0, 1e-13));
  CHECK_THAT(f(with(DruckerPragerCone::inner, 0), 5, 0, 0), WithinAbs(0, 1e-13));
  CHECK_THAT(f(with(DruckerPragerCone::outer, 0), 4.5, 4.5, -2), WithinAbs(0, 1e-13));
  CHECK_THAT(f(with(DruckerPragerCone::outer, 0), 0, 0, -20), WithinAbs(0, 1e-13));
  // Plane flow under associated plasticity: s_zz such that the plastic strain along z vanishes, s / (2 J) +
  // eta / 3 = 0 there; then both criteria have the same s1 and s3.
  const auto plane = with(DruckerPragerCone::plane_strain, phi);
  const double s1 = 2.5, s3 = -10;
  double low = s3, high = s1;
  for (int n = 0; n < 100; ++n) {
    const double s2 = (low + high) / 2;
    const SymmetricTensor<3, double> s{{s1, s2, s3, 0, 0, 0}};
    const double mean = mean_stress(s), J = std::sqrt(second_invariant(s, mean));
    ((s2 - mean) / (2 * J) + plane.dilation / 3 > 0 ? high : low) = s2;
  }
  CHECK_THAT(f(plane, s1, low, s3), WithinAbs(0, 1e-12));
}

TEST_CASE("random trial states come back to the cone") {
  Random random(311);
  double worst = 0;
  int yielded = 0;
  for (const double H : {0., 30.})
    for (const double dilation : {0., 0.15, 0.3}) {
      const auto m = cone(H, dilation);
      for (int n = 0; n < 50000; ++n) {
        SymmetricTensor<3, double> trial;
        const double size = std::pow(10., random(0, 2));
        for (int c = 0; c < 6; ++c) trial[c] = size * random(-1, 1);
        const auto r = returned(m, trial, 0.05);
        const double mean = mean_stress(r.stress), J = std::sqrt(second_invariant(r.stress, mean));
        worst = std::max(worst, (J + 0.3 * mean - 0.5 * (8 + H * r.state[7])) / 8);
        yielded += r.state[7] > 0.05;
      }
    }
  CHECK(yielded > 100000);
  CHECK(worst < 1e-11);
}

TEMPLATE_TEST_CASE_SIG("packs say of every lane what its numbers say", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (3, float)) {
  using P = typename Lanes<Real>::Pack;
  const auto pyramid = MohrCoulomb<Real>::from({80, 0.25, 5, 0.6, 0.2, 2});
  const DruckerPrager<Real> with_hardening{
      LinearElastic<Real>::from_young(80, 0.25), Real(0.3), Real(0.15), Real(0.5), 8, 20};
  Random random(312);
  int beyond = 0;
  const auto check = [&](const auto& m) {
    constexpr int size = std::decay_t<decltype(m)>::template state_size<Dim>();
    for (int n = 0; n < 500; ++n) {
      SymmetricTensor<Dim, P> stress;
      Vector<size, P> state;
      for (int l = 0; l < P::width; ++l) {
        for (int c = 0; c < stress.size; ++c) stress[c].set(l, random.draw<Real>(-3, 3));
        for (int c = 0; c < size; ++c) state[c].set(l, random.draw<Real>(0, 0.1));
        if (n % 8 != 0) state[symmetric_components(Dim)].set(l, 0);  // no gap
      }
      const int ghost = n % P::width;  // zero everything
      for (int c = 0; c < stress.size; ++c) stress[c].set(ghost, 0);
      for (int c = 0; c < size; ++c) state[c].set(ghost, 0);
      const auto yields = m.may_yield(stress, state);
      CHECK_FALSE(yields[ghost]);
      for (int l = 0; l < P::width; ++l) {
        SymmetricTensor<Dim, Real> s;
        Vector<size, Real> t;
        for (int c = 0; c < s.size; ++c) s[c] = stress[c][l];
        for (int c = 0; c < size; ++c) t[c] = state[c][l];
        CHECK(yields[l] == static_cast<bool>(m.may_yield(s, t)));
        beyond += yields[l];
      }
    }
  };
  check(pyramid);
  check(with_hardening);
  CHECK(beyond > 500);
  CHECK(beyond < 800 * P::width);
}

TEST_CASE("DruckerPrager refuses constants without meaning, and names them") {
  using D = DruckerPrager<double>;
  const auto outer = DruckerPragerCone::outer;
  CHECK_NOTHROW(D::from({80, 0.25, 0, 0.5, 0.5, 0, outer}));
  CHECK_THROWS_AS(D::from({80, 0.25, 0, 0, 0, 0, outer}), std::invalid_argument);
  CHECK_THROWS_AS(D::from({80, 0.25, 1, 0.5, 0.6, 0, outer}), std::invalid_argument);
  CHECK_THROWS_AS(D::from({80, 0.25, 1, 1.6, 0, 0, outer}), std::invalid_argument);
  CHECK_THROWS_WITH(D::from({80, 0.25, 1, 0.5, 0, -3, outer}), containing("hardening modulus -3"));
  CHECK_THROWS_AS(D::von_mises(80, 0.25, 0, 1), std::invalid_argument);
  CHECK_THROWS_AS(D::von_mises(80, 0.25, 1, -1), std::invalid_argument);
  CHECK_THROWS_AS(D::von_mises(80, 0.5, 1, 0), std::invalid_argument);
}
