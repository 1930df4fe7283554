// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// 100 steps on cell lanes are 100 steps of the particle kernels: virtual stresses that vary in space, with
/// their divergence.
#include "engine_scenes.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

/// A pressure that grows without bound towards a point, in equilibrium with nothing: sbar = -p / r^2 I.
template <int Dim, class Real>
struct Singular {
  Vector<Dim, Real> centre;
  Real p;
  KOKKOS_FUNCTION VirtualStressValue<Dim, Real> operator()(const Vector<Dim, Real>& x) const {
    const auto d = x - centre;
    const Real r2 = dot(d, d);
    return {pressure_stress<Dim>(p / r2), (2 * p / (r2 * r2)) * d};
  }
};

}  // namespace

TEMPLATE_TEST_CASE_SIG("fields of all kinds, other ones from node to node", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (2, float)) {
  check_fields_of_all_kinds<Dim, Real, BothEngines<Dim, Real>>();
}

TEMPLATE_TEST_CASE_SIG("affine fields, by the volume's second moments", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (2, float)) {
  for (const bool mixed : {false, true}) {
    BothEngines<Dim, Real> engines({!mixed, sizeof(Real) == 4 ? 0. : 5.});
    const auto kinds = four_fields<Dim, Real>(engines.basis.grid, engines.amplitude);
    AffineVirtualStress<Dim, Real> f;
    f.count = 3;
    f.field[0] = kinds.field[0].as_affine();
    f.field[1] = kinds.field[3].as_affine();
    f.field[2] = kinds.field[0].as_affine();
    f.field[2].value *= Real(-2);
    for (int k = 0; k < Dim; ++k) f.field[2].gradient[k][0] += Real(0.3);
    for (int k = 0; k < 3; ++k) f.factor[k] = kinds.factor[k];
    REQUIRE((kinds.field[0].is_affine() && kinds.field[3].is_affine() && !kinds.field[1].is_affine()));
    if (mixed) {
      engines.declare([](const Vector<Dim, int>& ijk) {
        TractionMask mask = 0;
        for (int i = 0; i < Dim; ++i)
          if (const int k = (ijk[i] + i) / 2 % 4; k < 3) mask |= 1u << k;
        return mask;
      });
      engines.at_all_active_nodes = 2;
    } else {
      engines.declare_everywhere(7);
    }
    engines.run(elastic<Dim, Real>(), DeterminantVolume{}, [&](int n) {
      auto now = f;
      for (int k = 0; k < 3; ++k) now.factor[k] *= static_cast<Real>(0.01 * n);
      return now;
    });
    CAPTURE(mixed, engines.moved);
    check_same(engines);
    engines.check_boundary();
    CHECK(engines.load_seen[static_cast<int>(GroupLoad::mixed)] == mixed);
  }
}

/// Two fields that vary along `axis` alone, and are without shear.
template <int Dim, class Real>
AffineVirtualStress<Dim, Real> fields_along(int axis, Real amplitude) {
  AffineVirtualStress<Dim, Real> f;
  f.count = 2;
  for (int k = 0; k < 2; ++k) {
    f.factor[k] = Real(1);
    f.field[k].value = SymmetricTensor<Dim, Real>::zero();
    for (auto& g : f.field[k].gradient) g = SymmetricTensor<Dim, Real>::zero();
    for (int c = 0; c < 3; ++c) {
      f.field[k].value[c] = amplitude * static_cast<Real>(0.3 * (c + 1 - 2 * k));
      f.field[k].gradient[axis][c] = amplitude * static_cast<Real>(0.2 * (2 - c + k));
    }
  }
  f.find_axis();
  return f;
}

TEMPLATE_TEST_CASE_SIG("affine fields without shear that vary along one direction", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (3, float)) {
  for (const bool mixed : {false, true})
    for (int axis = 0; axis < Dim; ++axis) {
      BothEngines<Dim, Real> engines({axis % 2 == 0, sizeof(Real) == 4 ? 0. : mixed ? 5. : 2.});
      const auto f = fields_along<Dim, Real>(axis, engines.amplitude);
      CHECK(f.axis == axis);
      if (mixed)
        engines.declare([](const Vector<Dim, int>& ijk) { return TractionMask(1 + ijk[0] % 3); });
      else
        engines.declare_everywhere(3);
      engines.run(elastic<Dim, Real>(), DeterminantVolume{}, [&](int n) {
        auto now = f;
        now.factor[1] = static_cast<Real>(0.01 * n);
        return now;
      });
      CAPTURE(mixed, axis, engines.moved);
      check_same(engines);
      CHECK(engines.load_seen[static_cast<int>(GroupLoad::mixed)] == mixed);
      CHECK((Dim == 1 || engines.load_seen[static_cast<int>(GroupLoad::whole)] == !mixed));
    }
}

TEMPLATE_TEST_CASE_SIG("fields with shear, or that vary along two directions", "", ((int Dim), Dim), 2, 3) {
  for (int axis = 0; axis < Dim; ++axis) {
    const auto f = fields_along<Dim, double>(axis, 1.);
    auto sheared = f, varies_twice = f;
    sheared.field[1].value[3] = 1;
    sheared.find_axis();
    CHECK(sheared.axis == -1);
    varies_twice.field[0].gradient[(axis + 1) % Dim][0] = 1;
    varies_twice.find_axis();
    CHECK(varies_twice.axis == -1);
  }
}

TEMPLATE_TEST_CASE_SIG("a rigid body force that balances a field", "", ((int Dim), Dim), 2, 3) {
  BothEngines<Dim, double> engines({true, 0});
  auto f = four_fields<Dim, double>(engines.basis.grid, 1);
  f.balanced = 5;
  f.balance.about = position_in<Dim, double>(engines.basis.grid, 8);
  for (int i = 0; i < Dim; ++i) f.balance.constant[i] = 0.3 * (i + 1);
  f.balance.spin(0, 1) = 0.2;
  f.balance.spin(1, 0) = -0.2;
  engines.declare_everywhere(15);
  engines.run(
      elastic<Dim, double>(), DeterminantVolume{}, [&](int) { return f; }, 40);
  check_same(engines);
}

TEMPLATE_TEST_CASE_SIG("a function of one's own, singular where there is no particle", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double)) {
  // At the centre of the cavity, which is the centre of a void cell of a group.
  BothEngines<Dim, Real> engines({true, 0});
  engines.declare_everywhere(1);
  const Singular<Dim, Real> singular{position_in<Dim, Real>(engines.basis.grid, Real(6.5)), Real(0.05)};
  engines.run(elastic<Dim, Real>(), DeterminantVolume{}, [&](int) { return virtual_stress_of(singular); });
  CAPTURE(engines.moved);
  check_same(engines);
  engines.check_boundary();
}
