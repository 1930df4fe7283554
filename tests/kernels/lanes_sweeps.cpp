// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Steps in one sweep, re-mapped by the consistent mass matrix, are steps in two, and those of the particle
/// kernels.
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

TEMPLATE_TEST_CASE_SIG("one sweep: loaded bodies at rest and moving", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (1, float), (2, float), (3, float)) {
  for (const bool cubic : {true, false})
    for (const double drift : {0., 1.}) {
      if (sizeof(Real) == 4 && drift > 0) continue;
      BothEngines<Dim, Real> engines({cubic, drift});
      engines.lanes.memory.sweeps = Sweeps::one;
      engines.declare_everywhere(1);
      engines.options.damping = drift > 0 ? Real(0) : Real(0.05);
      engines.options.gravity[Dim - 1] = -engines.amplitude;
      engines.run(elastic<Dim, Real>(), DeterminantVolume{}, [&](int n) {
        return pressure<Dim, Real>(engines.amplitude * static_cast<Real>(0.04 * n));
      });
      CAPTURE(cubic, drift, engines.moved);
      CHECK(engines.lanes.memory.lanes.one_sweep());
      check_same(engines);
      CHECK((engines.moved > 10 || drift == 0));
      CHECK((engines.lanes.repacked > 0 || drift == 0 || Dim == 1));
    }
}

TEMPLATE_TEST_CASE_SIG("one sweep: bodies against walls", "", ((int Dim), Dim), 1, 2, 3) {
  BothEngines<Dim, double> engines({false, -0.2, true});
  engines.lanes.memory.sweeps = Sweeps::one;
  engines.lanes.memory.walls.fixed[0][0] = 1;
  engines.run(elastic<Dim, double>(), DeterminantVolume{}, [](int) { return NoVirtualStress{}; });
  CHECK(engines.lanes.memory.lanes.one_sweep());
  check_same(engines);
}

TEMPLATE_TEST_CASE_SIG("particles per cell decide between one sweep and two", "", ((int Dim), Dim), 1, 2, 3) {
  for (const int along : {2, 3, 4}) {
    const auto grid = make_grid<Dim, double>({{6, 5, 4}});
    const int per_cell = Dim == 1 ? along : Dim == 2 ? along * along : along * along * along;
    auto block = allocate_particles<Dim, double, Device>(per_cell);
    edit(block, [&](const auto& p) {
      for (int k = 0; k < per_cell; ++k) {
        int rest = k;
        for (int i = 0; i < Dim; ++i, rest /= along)
          p.position(k, i) = grid.lower[i] + grid.spacing[i] * (2 + (rest % along + 0.5) / along);
        p.mass(k) = p.volume(k) = 1;
      }
    });
    LaneState<Dim, double, Device> s;
    s.memory.grid = grid;
    REQUIRE(pack_lanes(Exec(), block.particles, s) == -1);
    CHECK(s.memory.lanes.one_sweep() == (along > 2));
    s.memory.sweeps = Sweeps::two;
    REQUIRE(pack_lanes(Exec(), block.particles, s) == -1);
    CHECK(!s.memory.lanes.one_sweep());
  }
}
