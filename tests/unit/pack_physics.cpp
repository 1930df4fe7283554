// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The formulas of physics on packs give in every lane what they give for the numbers there; sums with
/// products in them are rounded less often, which makes a few units in the last place of the largest term.
#include <vsb/physics/explicit_dynamics.hpp>
#include <vsb/physics/linear_elastic.hpp>
#include <vsb/views/pack.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

template <class Real>
using LanePack = typename Lanes<Real>::Pack;

/// A velocity gradient and a stress, one per lane, and what they are in lane l.
template <int Dim, class Real>
struct Point {
  using P = LanePack<Real>;
  Matrix<Dim, P> L;
  SymmetricTensor<Dim, P> sigma;
  P volume;

  explicit Point(Random& random) {
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) L(i, j) = draw(random, -1, 1);
    for (int c = 0; c < sigma.size; ++c) sigma[c] = draw(random, -1, 1);
    volume = draw(random, 0.5, 1);
  }
  static P draw(Random& random, double low, double high) {
    P p;
    for (int l = 0; l < P::width; ++l) p.set(l, random.draw<Real>(low, high));
    return p;
  }
  Matrix<Dim, Real> L_in(int l) const {
    Matrix<Dim, Real> m;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) m(i, j) = L(i, j)[l];
    return m;
  }
  SymmetricTensor<Dim, Real> sigma_in(int l) const { return lane(sigma, l); }
  static SymmetricTensor<Dim, Real> lane(const SymmetricTensor<Dim, P>& s, int l) {
    SymmetricTensor<Dim, Real> t;
    for (int c = 0; c < t.size; ++c) t[c] = s[c][l];
    return t;
  }
};

template <int Dim, class Real>
void check_lane(const SymmetricTensor<Dim, LanePack<Real>>& s, int l,
                const SymmetricTensor<Dim, Real>& expected, double largest) {
  for (int c = 0; c < expected.size; ++c)
    CHECK_THAT(static_cast<double>(s[c][l]),
               WithinAbs(static_cast<double>(expected[c]), 4 * epsilon<Real> * largest));
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("kinematics and elasticity on packs", "", ((int Dim, typename Real), Dim, Real),
                       (1, double), (2, double), (3, double), (3, float)) {
  using P = LanePack<Real>;
  Random random(94);
  const auto material = LinearElastic<Real>::from_young(3, 0.3);
  const auto dt = static_cast<Real>(0.3);
  for (int n = 0; n < 20; ++n) {
    const Point<Dim, Real> at(random);
    const auto strain = strain_increment(at.L, P(dt));
    const auto turned = turned_with_material(at.sigma, at.L, P(dt));
    const auto stress = material.advance(at.sigma, at.L, P(dt));
    const P by_determinant = DeterminantVolume{}(at.volume, at.L, P(dt)),
            by_exponential = ExponentialVolume{}(at.volume, at.L, P(dt));
    for (int l = 0; l < P::width; ++l) {
      const auto L = at.L_in(l);
      // |dt L| <= 0.3, |sigma| <= 1, lambda + 2 mu = 4.04.
      check_lane<Dim, Real>(strain, l, strain_increment(L, dt), 0.3);
      check_lane<Dim, Real>(turned, l, turned_with_material(at.sigma_in(l), L, dt), 1.2);
      check_lane<Dim, Real>(stress, l, material.advance(at.sigma_in(l), L, dt), 4);
      CHECK_THAT(static_cast<double>(by_determinant[l]),
                 WithinAbs(static_cast<double>(DeterminantVolume{}(at.volume[l], L, dt)), 8 * epsilon<Real>));
      CHECK_THAT(static_cast<double>(by_exponential[l]),
                 WithinAbs(static_cast<double>(ExponentialVolume{}(at.volume[l], L, dt)), 8 * epsilon<Real>));
    }
  }
}

TEMPLATE_TEST_CASE("damping on packs follows the sign of every lane's velocity", "", double, float) {
  using Real = TestType;
  using P = LanePack<Real>;
  Random random(95);
  for (int n = 0; n < 20; ++n) {
    const auto force = Point<1, Real>::draw(random, -1, 1);
    auto velocity = Point<1, Real>::draw(random, -1, 1);
    velocity.set(n % P::width, Real(0));  // no damping there
    const auto alpha = static_cast<Real>(0.3);
    const P damped = cundall_damped(force, velocity, P(alpha));
    for (int l = 0; l < P::width; ++l) {
      CHECK_THAT(static_cast<double>(damped[l]),
                 WithinAbs(static_cast<double>(cundall_damped(force[l], velocity[l], alpha)), epsilon<Real>));
      if (velocity[l] == 0) CHECK(damped[l] == force[l]);
      if (velocity[l] > 0) CHECK(damped[l] < force[l]);
      if (velocity[l] < 0) CHECK(damped[l] > force[l]);
    }
  }
}

TEMPLATE_TEST_CASE("a node has mass where its inverse is a number", "", float, double) {
  using Real = TestType;
  using Limits = std::numeric_limits<Real>;
  const Real least = Limits::min();
  const Real masses[] = {0, Limits::denorm_min(), least / 8, std::nextafter(least, Real(0)), least, 1};
  for (const Real m : masses) {
    CAPTURE(m);
    CHECK(has_mass(m) == (m >= least));
    CHECK(any(has_mass(Pack<Real, 4>(m))) == (m >= least));
    if (has_mass(m)) CHECK(std::isfinite(1 / m));
  }
  CHECK(std::isinf(1 / Limits::denorm_min()));  // what it is for
}
