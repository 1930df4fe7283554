// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// 100 steps on cell lanes are 100 steps of the particle kernels: materials that remember, and volumes that
/// follow the exponential of the strain.
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

}  // namespace

TEMPLATE_TEST_CASE_SIG("exponential volumes", "", ((int Dim, typename Real), Dim, Real), (1, double),
                       (2, double), (3, double), (3, float)) {
  BothEngines<Dim, Real> engines({false, sizeof(Real) == 4 ? 0. : 1.});
  engines.declare_everywhere(1);
  engines.run(elastic<Dim, Real>(), ExponentialVolume{},
              [&](int) { return pressure<Dim, Real>(2 * engines.amplitude); });
  CAPTURE(engines.moved);
  check_same(engines);
}

TEMPLATE_TEST_CASE_SIG("Hencky elasticity carries its state from cell to cell", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (2, float)) {
  BothEngines<Dim, Real> engines({true, sizeof(Real) == 4 ? 0. : 1.});
  engines.remember(Dim * Dim);
  engines.declare_everywhere(1);
  Random random(82);
  edit(engines.block, [&](const auto& p) {  // strained as the material has it
    for (int k = 0; k < p.count(); ++k)
      for (int c = 0; c < Dim * Dim; ++c)
        p.material_state(k, c) = engines.amplitude * random.draw<Real>(-0.01, 0.01);
  });
  engines.run(Hencky<Real>::from_young(100, 0.3), DeterminantVolume{},
              [&](int) { return pressure<Dim, Real>(2 * engines.amplitude); });
  CAPTURE(engines.moved);
  check_same(engines);
  CHECK((engines.moved > 10 || sizeof(Real) == 4));
}

TEMPLATE_TEST_CASE_SIG("what a lane without a particle remembers does not matter", "", ((int Dim), Dim), 1,
                       2) {
  // Ghosts move and are strained as particles would be, without an end: here to nothing, F = 0.
  const auto run = [](bool spoilt) {
    BothEngines<Dim, double> engines({true, 1});
    engines.remember(Dim * Dim);
    auto& s = engines.lanes;
    s.boundary.everywhere = 1;
    Kokkos::deep_copy(engines.copy.block, engines.block.block);
    REQUIRE(pack_lanes(Exec(), engines.copy.particles, s) == -1);
    if (spoilt) {
      const auto id = read(s.memory.lanes.id);
      int ghosts = 0;
      edit(s.memory.lanes.data, [&](const auto& data) {
        for (size_t e = 0; e < static_cast<size_t>(s.memory.lanes.slot_count * s.memory.lanes.width); ++e) {
          if (id(e) >= 0) continue;
          ++ghosts;
          for (int i = 0; i < Dim; ++i)
            data(e, static_cast<size_t>(s.memory.lanes.state_column + i * (Dim + 1))) = -1;
        }
      });
      CHECK(ghosts > 0);
    }
    const auto load = pressure<Dim, double>(2);
    prepare_lane_step(Exec(), s, load);
    for (int n = 0; n < 10; ++n)
      REQUIRE(lane_step(Exec(), s, Hencky<double>::from_young(100, 0.3), DeterminantVolume{}, load,
                        engines.options) == -1);
    unpack_particles(Exec(), s.memory, engines.copy.particles);
    return read(engines.copy);
  };
  const auto clean = run(false), spoilt = run(true);
  CHECK(difference(clean, spoilt, BothEngines<Dim, double>({true, 1}).basis.grid).largest() == 0);
}
