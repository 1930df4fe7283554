// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// 100 steps on cell lanes are 100 steps of the particle kernels where particles yield, some lanes of a slot
/// and not others; ghosts do not matter.
#include "both_engines.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

template <int Dim, class Real>
UniformVirtualStress<Dim, Real> pressure(Real p) {
  UniformVirtualStress<Dim, Real> f;
  f.count = 1;
  f.stress[0] = pressure_stress<Dim>(p);
  return f;
}

/// Particles of a block that have yielded.
template <int Dim, class Real>
int yielded(const ParticleBlock<Dim, Real, Device>& block) {
  const auto host = read(block);
  int count = 0;
  for (int p = 0; p < host.count(); ++p) {
    bool any = false;
    for (int c = 0; c < symmetric_components(Dim); ++c)
      any = any || host.material_state(static_cast<size_t>(p), static_cast<size_t>(c)) != 0;
    count += any;
  }
  return count;
}

/// The stresses begin at random within +-1 `amplitude`: strengths of that size. Without strength most
/// particles yield, and a load of that size would close all gaps: there is none.
template <int Dim, class Real, class Material>
BothEngines<Dim, Real> check_engines(const Material& material, bool strength = true) {
  BothEngines<Dim, Real> engines({true, sizeof(Real) == 4 ? 0. : 1.});
  engines.remember(Material::template state_size<Dim>());
  engines.declare_everywhere(1);
  engines.run(material, DeterminantVolume{},
              [&](int) { return pressure<Dim, Real>(strength ? 2 * engines.amplitude : Real(0)); });
  const int particles = engines.block.particles.count(), yielding = yielded(engines.block);
  CAPTURE(engines.moved, particles, yielding);
  check_same(engines);
  CHECK((engines.moved > 10 || sizeof(Real) == 4));
  CHECK(yielding > particles / 20);
  CHECK((yielding < particles - particles / 20 || !strength));
  CHECK(yielded(engines.copy) == yielding);
  return engines;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("Mohr-Coulomb on both engines", "", ((int Dim, typename Real), Dim, Real), (1, double),
                       (2, double), (3, double), (2, float)) {
  const double a = BothEngines<Dim, Real>::amplitude;
  check_engines<Dim, Real>(
      MohrCoulomb<Real>::from({100, 0.3, (Dim == 3 ? 1.6 : 0.8) * a, 0.4, 0.1, (Dim == 3 ? 1.5 : 0.7) * a}));
}

TEMPLATE_TEST_CASE_SIG("Drucker-Prager with hardening on both engines", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double)) {
  const double a = BothEngines<Dim, Real>::amplitude;
  check_engines<Dim, Real>(DruckerPrager<Real>::from(
      {100, 0.3, (Dim == 3 ? 1.2 : 0.6) * a, 0.4, 0.1, 20, DruckerPragerCone::outer}));
}

TEMPLATE_TEST_CASE_SIG("sand that opens and closes on both engines", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (2, float)) {
  const auto check = [](const auto& sand) {
    const auto engines = check_engines<Dim, Real>(sand, false);
    const auto host = read(engines.block);
    int open = 0;
    for (size_t p = 0; p < static_cast<size_t>(host.count()); ++p)
      open += host.material_state(p, symmetric_components(Dim)) > 0;
    CHECK(open > host.count() / 20);
    CHECK(open < host.count());
  };
  check(MohrCoulomb<Real>::from({100, 0.3, 0, 0.4, 0.1}));
  check(DruckerPrager<Real>::from({100, 0.3, 0, 0.4, 0.1}));
}

TEST_CASE("what is strong enough moves as if it were elastic, bit by bit, and remembers nothing") {
  const auto run = [](const auto& material, int columns) {
    BothEngines<2, double> engines({true, 1});
    if (columns > 0) engines.remember(columns);
    engines.declare_everywhere(1);
    engines.run(
        material, DeterminantVolume{}, [](int) { return pressure<2, double>(2); }, 20);
    return engines;
  };
  const auto elastic = run(LinearElastic<double>::from_young(100, 0.3), 0),
             strong =
                 run(MohrCoulomb<double>::from({100, 0.3, 1e6, 0.4}), MohrCoulomb<double>::state_size<2>());
  CHECK(yielded(strong.block) + yielded(strong.copy) == 0);
  for (const auto part : {&BothEngines<2, double>::block, &BothEngines<2, double>::copy}) {
    const auto a = read((elastic.*part).block), b = read((strong.*part).block);
    REQUIRE(a.span() == b.span());
    CHECK(std::equal(a.data(), a.data() + a.span(), b.data()));
  }
}

TEST_CASE("ghosts that are strained beyond yield begin anew, and particles do not feel them") {
  const auto run = [](bool spoilt) {
    BothEngines<2, double> engines({true, 1});
    engines.remember(MohrCoulomb<double>::state_size<2>());
    auto& s = engines.lanes;
    Kokkos::deep_copy(engines.copy.block, engines.block.block);
    REQUIRE(pack_lanes(Exec(), engines.copy.particles, s) == -1);
    const auto id = read(s.memory.lanes.id);
    if (spoilt)
      edit(s.memory.lanes.data, [&](const auto& data) {
        for (size_t e = 0; e < static_cast<size_t>(s.memory.lanes.slot_count * s.memory.lanes.width); ++e)
          if (id(e) < 0) data(e, static_cast<size_t>(s.memory.lanes.stress_column)) = 1e30;
      });
    prepare_lane_step(Exec(), s, NoVirtualStress{});
    REQUIRE(lane_step(Exec(), s, MohrCoulomb<double>::from({100, 0.3, 2, 0.4}), DeterminantVolume{},
                      NoVirtualStress{}, engines.options) == -1);
    const auto data = read(s.memory.lanes.data);
    const auto after = read(s.memory.lanes.id);
    const auto groups = read(s.memory.lanes.groups);
    double largest = 0;
    int ghosts = 0;
    for (int g = 0; g < s.memory.lanes.group_count; ++g)
      for (size_t e = s.memory.lanes.begin(groups(g)); e < s.memory.lanes.end(groups(g)); ++e)
        if (after(e) < 0) {
          ++ghosts;
          largest = std::max(largest, std::abs(data(e, static_cast<size_t>(s.memory.lanes.stress_column))));
        }
    CHECK(ghosts > 0);
    CHECK(largest < 10);
    unpack_particles(Exec(), s.memory, engines.copy.particles);
    return read(engines.copy);
  };
  const auto clean = run(false), spoilt = run(true);
  CHECK(difference(clean, spoilt, BothEngines<2, double>({true, 1}).basis.grid).largest() == 0);
}
