// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The gap of materials that carry no tension: what was pulled apart carries no stress until it has closed,
/// and is elastic from there on; both laws, numbers and packs.
#include <vsb/physics/material.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

/// A particle of a material, strained step by step.
template <int Dim, class Material>
struct Specimen {
  using Real = decltype(Material::elastic.lambda);
  Material material;
  SymmetricTensor<Dim, Real> stress = SymmetricTensor<Dim, Real>::zero();
  Vector<Material::template state_size<Dim>(), Real> state = decltype(state)::zero();

  void strain(const Matrix<Dim, Real>& L, int steps = 1) {
    for (int n = 0; n < steps; ++n) stress = material.advance(stress, state, L, Real(1));
  }
  /// Along x.
  void strain_x(Real e, int steps = 1) {
    auto L = Matrix<Dim, Real>::zero();
    L(0, 0) = e / static_cast<Real>(steps);
    strain(L, steps);
  }
  Real gap() const { return gap_in<Dim>(state); }
  Real plastic_volume() const { return state[0] + state[1] + state[2]; }
  Real largest_stress() const {
    Real largest = 0;
    for (int c = 0; c < stress.size; ++c) largest = std::max(largest, std::abs(stress[c]));
    return largest;
  }
};

/// Friction of 31 degrees, E = 80, nu = 0.3.
const double friction = 31 * std::acos(-1.) / 180;
template <class Real>
MohrCoulomb<Real> mohr_coulomb(double cohesion, double dilation = 0) {
  return MohrCoulomb<Real>::from({80, 0.3, cohesion, friction, dilation});
}
template <class Real>
DruckerPrager<Real> drucker_prager(double cohesion, double dilation = 0) {
  return DruckerPrager<Real>::from({80, 0.3, cohesion, friction, dilation});
}
/// Cohesion in shear, but no tension: its gap is of what opens to all sides.
template <class Real>
MohrCoulomb<Real> without_tension() {
  return MohrCoulomb<Real>::from({80, 0.3, 0.5, friction, 0, 0});
}

template <int Dim, class Material>
void check_opening(const Material& material) {
  using Real = typename Specimen<Dim, Material>::Real;
  const Real round_off = 100 * math::epsilon<Real> * 80, x = Real(0.125), y = Real(0.0078125);
  const auto& elastic = material.elastic;
  for (const int steps : {1, 8}) {
    Specimen<Dim, Material> sand{material};
    for (int cycle = 0; cycle < 3; ++cycle) {
      sand.strain_x(x, steps);
      CHECK(sand.largest_stress() <= round_off);
      CHECK_THAT(sand.gap(), WithinAbs(x, round_off));
      CHECK_THAT(sand.plastic_volume(), WithinAbs(x, round_off));
      sand.strain_x(-x / 2, steps);
      CHECK(sand.largest_stress() <= round_off);
      CHECK_THAT(sand.gap(), WithinAbs(x / 2, round_off));
      sand.strain_x(-x / 2, steps);
      CHECK(sand.largest_stress() <= round_off);
      CHECK_THAT(sand.gap(), WithinAbs(0, round_off));
      sand.strain_x(-y, steps);
      CHECK_THAT(sand.stress[0], WithinAbs(-y * elastic.constrained_modulus(), round_off));
      CHECK_THAT(sand.stress[1], WithinAbs(-y * elastic.lambda, round_off));
      CHECK_THAT(sand.plastic_volume(), WithinAbs(0, round_off));
      sand.strain_x(y, steps);
    }
  }
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("opened and closed by as much: no stress, then elastic", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (1, float), (2, float), (3, float)) {
  check_opening<Dim>(mohr_coulomb<Real>(0));
  check_opening<Dim>(drucker_prager<Real>(0));
}

TEST_CASE("a step that closes the gap and goes on strains by what is left") {
  const auto check = [](const auto& material) {
    Specimen<3, std::decay_t<decltype(material)>> sand{material};
    const auto all_sides = [](double e) { return Matrix<3, double>{{{e, 0, 0}, {0, e, 0}, {0, 0, e}}}; };
    sand.strain(all_sides(0.1));
    CHECK_THAT(sand.gap(), WithinRel(0.3, 1e-12));
    sand.strain(all_sides(-0.1 - 0.002));
    CHECK(sand.gap() == 0);
    for (int i = 0; i < 3; ++i)
      CHECK_THAT(sand.stress[i], WithinRel(-0.006 * sand.material.elastic.bulk_modulus(), 1e-10));
  };
  check(mohr_coulomb<double>(0));
  check(mohr_coulomb<double>(0, friction));
  check(without_tension<double>());
  check(drucker_prager<double>(0));
  check(drucker_prager<double>(0, 0.2));
}

TEST_CASE("sheared in an open gap: no stress, and the gap stays") {
  const auto check = [](const auto& material) {
    Specimen<2, std::decay_t<decltype(material)>> sand{material};
    sand.strain_x(0.1);
    sand.strain({{{0, 0.02}, {0, 0}}}, 50);
    CHECK(sand.largest_stress() < 1e-12);
    CHECK_THAT(sand.gap(), WithinRel(0.1, 1e-12));
  };
  check(mohr_coulomb<double>(0));
  check(drucker_prager<double>(0));
}

TEST_CASE("what carries tension has no gap: it is pressed at once") {
  const auto check = [](const auto& material) {
    Specimen<1, std::decay_t<decltype(material)>> rock{material};
    rock.strain_x(1);
    const double held = rock.stress[0];
    CHECK(held > 0);
    CHECK(rock.gap() == 0);
    rock.strain_x(-0.001);
    CHECK_THAT(rock.stress[0], WithinRel(held - 0.001 * rock.material.constrained_modulus(), 1e-10));
  };
  check(mohr_coulomb<double>(3));
  check(MohrCoulomb<double>::from({80, 0.3, 3, friction, 0, 2}));
  check(drucker_prager<double>(3));
}

TEMPLATE_TEST_CASE_SIG("packs return every lane with a gap", "", ((int Dim, typename Real), Dim, Real),
                       (1, double), (2, double), (3, double), (3, float)) {
  using P = typename Lanes<Real>::Pack;
  const auto check = [](const auto& material) {
    SymmetricTensor<Dim, P> trial;
    Vector<std::decay_t<decltype(material)>::template state_size<Dim>(), P> state;
    for (int c = 0; c < trial.size; ++c) trial[c] = P(Real(c < 3 ? -1 : 0));
    for (int c = 0; c < symmetric_components(Dim) + 1; ++c) state[c] = P(Real(0));
    if (state.size > symmetric_components(Dim) + 1) state[state.size - 1] = P(Real(0));
    CHECK_FALSE(any(material.may_yield(trial, state)));
    for (int l = 0; l < P::width; l += 2) state[symmetric_components(Dim)].set(l, Real(1e-3));
    const auto which = material.may_yield(trial, state);
    for (int l = 0; l < P::width; ++l) CHECK(which[l] == (l % 2 == 0));
  };
  check(mohr_coulomb<Real>(0));
  check(drucker_prager<Real>(0));
}
