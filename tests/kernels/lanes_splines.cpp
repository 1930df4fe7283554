// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// 100 steps on cell lanes with quadratic B-splines are 100 steps of the particle kernels: without load,
/// under virtual stresses of all kinds, at rest and moving, with gravity, damping and walls that mirror.
#include <cstdio>

#include "both_engines.hpp"
#include "four_fields.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

template <int Dim, class Real>
using Engines = BothEngines<Dim, Real, QuadraticBSplineBasis>;

template <int Dim, class Real>
SymmetricTensor<Dim, Real> full_tensor() {
  constexpr double values[6] = {-2, 1, 0.5, 0.7, -0.4, 0.3};
  SymmetricTensor<Dim, Real> s;
  for (int c = 0; c < s.size; ++c) s[c] = static_cast<Real>(values[c]);
  return s;
}

/// Other tractions from node to node.
template <int Dim>
TractionMask striped(const Vector<Dim, int>& ijk) {
  TractionMask mask = 0;
  for (int i = 0; i < Dim; ++i)
    mask |= static_cast<TractionMask>((ijk[i] + 3) / (1 + i) % 3 == 1 ? 1 << i : 0) | (ijk[i] > 6 ? 2u : 0u);
  return mask;
}

template <int Dim, class Real>
UniformVirtualStress<Dim, Real> four_uniform_stresses(Real amplitude) {
  UniformVirtualStress<Dim, Real> f;
  f.count = 4;
  for (int k = 0; k < f.count; ++k)
    f.stress[k] = amplitude * static_cast<Real>(0.5 - 0.3 * k) * full_tensor<Dim, Real>();
  f.stress[3] = pressure_stress<Dim>(amplitude);
  return f;
}

/// The bits of 60 steps of a moving body under tractions that change from node to node, held by a wall.
template <int Dim, class Real>
std::uint64_t state_hash() {
  Engines<Dim, Real> engines({false, 0, true}, 5);
  engines.lanes.memory.walls.fixed[0][0] = 1;
  engines.declare([](const Vector<Dim, int>& ijk) { return striped<Dim>(ijk); });
  engines.conservative = 2;
  engines.options.damping = Real(0.05);
  engines.run(
      elastic<Dim, Real>(), DeterminantVolume{},
      [&](int) { return four_uniform_stresses<Dim, Real>(engines.amplitude); }, 60);
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a
  const auto host = host_copy(engines.copy).block;
  for (size_t k = 0; k < host.span() * sizeof(Real); ++k)
    hash = (hash ^ reinterpret_cast<const unsigned char*>(host.data())[k]) * 1099511628211u;
  return hash;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("splines: free bodies", "", ((int Dim, typename Real), Dim, Real), (1, double),
                       (2, double), (3, double), (2, float), (3, float)) {
  for (const bool cubic : {true, false})
    for (const double drift : {0., 1.}) {
      if (sizeof(Real) == 4 && drift > 0) continue;
      Engines<Dim, Real> engines({cubic, drift});
      engines.options.damping = drift > 0 ? Real(0) : Real(0.05);
      engines.options.gravity[Dim - 1] = -engines.amplitude;
      engines.run(elastic<Dim, Real>(), DeterminantVolume{}, [](int) { return NoVirtualStress{}; });
      CAPTURE(cubic, drift, engines.moved);
      check_same(engines);
      CHECK((engines.moved > 10 || drift == 0));
      CHECK((engines.lanes.repacked > 0 || drift == 0 || Dim == 1));
    }
}

TEMPLATE_TEST_CASE_SIG("splines: bodies under a pressure and under any uniform tensor", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (2, float), (3, float)) {
  for (const bool pressure : {true, false}) {
    const double drift = sizeof(Real) == 4 ? 0 : pressure ? 0.5 : 1;
    Engines<Dim, Real> engines({pressure, drift});
    engines.declare_everywhere(1);
    engines.run(elastic<Dim, Real>(), DeterminantVolume{}, [&](int n) {
      UniformVirtualStress<Dim, Real> f;  // another in every step
      f.count = 1;
      const auto factor = engines.amplitude * static_cast<Real>(0.02 * n);
      f.stress[0] = factor * (pressure ? pressure_stress<Dim>(Real(2)) : full_tensor<Dim, Real>());
      return f;
    });
    CAPTURE(pressure, engines.moved);
    check_same(engines);
    engines.check_boundary();
    CHECK((engines.moved > 0 || drift == 0));
    CHECK((Dim > 1 || engines.load_seen[static_cast<int>(GroupLoad::none)]));  // N1 is three nodes deep
    CHECK(engines.load_seen[static_cast<int>(GroupLoad::part)]);
    CHECK((Dim == 1 || engines.load_seen[static_cast<int>(GroupLoad::whole)]));
    CHECK(!engines.load_seen[static_cast<int>(GroupLoad::mixed)]);
  }
}

TEMPLATE_TEST_CASE_SIG("splines: tractions that change from node to node, some conservative", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (2, float), (3, float)) {
  for (const TractionMask conservative : {0u, 2u}) {
    Engines<Dim, Real> engines({true, sizeof(Real) == 4 ? 0. : 1.});
    engines.declare([](const Vector<Dim, int>& ijk) { return striped<Dim>(ijk); });
    engines.declare_everywhere(8);
    engines.conservative = conservative;
    const auto f = four_uniform_stresses<Dim, Real>(engines.amplitude);
    engines.run(elastic<Dim, Real>(), DeterminantVolume{}, [&](int) { return f; });
    CAPTURE(conservative, engines.moved);
    check_same(engines);
    engines.check_boundary();
    CHECK(engines.load_seen[static_cast<int>(GroupLoad::mixed)]);
  }
}

TEMPLATE_TEST_CASE_SIG("splines: a body that slides along a wall and one held by it", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (2, float), (3, float)) {
  for (const int held : {1, (1 << Dim) - 1}) {
    Engines<Dim, Real> engines({false, 0, true});
    engines.lanes.memory.walls.fixed[0][0] = static_cast<ComponentMask>(held);
    engines.lanes.memory.walls.fixed[Dim - 1][1] = 1;  // far from the body
    engines.options.gravity[0] = -5 * engines.amplitude;
    engines.options.damping = Real(0.1);
    engines.declare_everywhere(1);
    if (held == 1 && sizeof(Real) == 8)
      edit(engines.block, [](const auto& p) {
        for (int k = 0; k < p.count(); ++k)
          for (int i = 1; i < Dim; ++i) p.velocity(k, i) += 1;
      });
    UniformVirtualStress<Dim, Real> f;
    f.count = 1;
    f.stress[0] = pressure_stress<Dim>(engines.amplitude);
    engines.run(elastic<Dim, Real>(), DeterminantVolume{}, [&](int) { return f; });
    CAPTURE(held, engines.moved);
    check_same(engines);
    engines.check_boundary();
  }
}

TEMPLATE_TEST_CASE_SIG("splines: fields of all kinds, other ones from node to node", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (2, float)) {
  for (const bool mixed : {false, true}) {
    Engines<Dim, Real> engines({!mixed, sizeof(Real) == 4 ? 0. : 1.5});
    const auto f = four_fields<Dim, Real>(engines.grid, engines.amplitude);
    if (mixed) {
      engines.declare([](const Vector<Dim, int>& ijk) {
        TractionMask mask = 0;
        for (int i = 0; i < Dim; ++i) mask |= 1u << ((ijk[i] + i + 4) / 2 % 5);  // bit 4: no field has it
        return mask;
      });
      engines.conservative = 4;
    } else {
      engines.declare_everywhere(15);
    }
    engines.run(elastic<Dim, Real>(), DeterminantVolume{}, [&](int n) {
      auto now = f;
      for (int k = 0; k < 4; ++k) now.factor[k] *= static_cast<Real>(0.01 * n);
      return now;
    });
    CAPTURE(mixed, engines.moved);
    check_same(engines);
    engines.check_boundary();
    CHECK(engines.load_seen[static_cast<int>(GroupLoad::mixed)] == mixed);
  }
}

TEMPLATE_TEST_CASE_SIG("splines: more particles in a cell than the sums take at a time", "", ((int Dim), Dim),
                       1, 2, 3) {
  // 40 in each of a few cells, as some packings have them.
  Engines<Dim, double> engines({false, 0.3});
  const auto before = read(engines.block);
  const int n = before.count();
  auto crowd = [&](const auto& p) {
    for (int k = 0; k < n; ++k) {
      const int cell = k / 40 % 5;
      for (int i = 0; i < Dim; ++i) {
        const double within = (p.position(k, i) - engines.grid.lower[i]) * engines.grid.inverse_spacing[i];
        p.position(k, i) =
            engines.grid.lower[i] + engines.grid.spacing[i] * (4 + cell + within - std::floor(within));
      }
      p.volume(k) /= 10;
      p.mass(k) /= 10;
    }
  };
  edit(engines.block, crowd);
  engines.declare_everywhere(1);
  UniformVirtualStress<Dim, double> f;
  f.count = 1;
  f.stress[0] = full_tensor<Dim, double>();
  engines.run(
      elastic<Dim, double>(), DeterminantVolume{}, [&](int) { return f; }, 50);
  const auto groups = read(engines.lanes.memory.lanes.groups);
  int most = 0;
  for (int g = 0; g < engines.lanes.memory.lanes.group_count; ++g) most = std::max(most, groups(g).slots);
  CHECK(most > spline_sums::block_slots);
  check_same(engines);
  engines.check_boundary();
}

TEST_CASE("print state hashes of splines on cell lanes",
          "[.][state_hashes]") {  // run by kernels/same_bits.py
  for (const std::uint64_t hash :
       {state_hash<1, double>(), state_hash<2, double>(), state_hash<3, double>(), state_hash<3, float>()})
    std::printf("hash of splines %016llx\n", static_cast<unsigned long long>(hash));
}
