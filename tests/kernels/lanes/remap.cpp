// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Steps re-mapped by the consistent mass matrix equal steps with a second sweep, and those of the particle
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

TEMPLATE_TEST_CASE_SIG("re-map by the mass matrix: loaded bodies at rest and moving", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (1, float), (2, float), (3, float)) {
  for (const bool equal_spacing : {true, false})
    for (const double drift : {0., 5.}) {
      if (sizeof(Real) == 4 && drift > 0) continue;
      BothEngines<Dim, Real> engines({equal_spacing, drift});
      engines.lanes.memory.remap_method = RemapMethod::mass_matrix;
      engines.declare_everywhere(1);
      engines.options.damping = drift > 0 ? Real(0) : Real(0.05);
      engines.options.gravity[Dim - 1] = -engines.amplitude;
      engines.run(elastic<Dim, Real>(), DeterminantVolume{}, [&](int n) {
        return pressure<Dim, Real>(engines.amplitude * static_cast<Real>(0.04 * n));
      });
      CAPTURE(equal_spacing, drift, engines.moved);
      CHECK(engines.lanes.memory.lanes.remaps_by_mass_matrix());
      check_same(engines);
      CHECK((engines.moved > 10 || drift == 0));
      CHECK((engines.lanes.repacked > 0 || drift == 0 || Dim == 1));
    }
}

TEMPLATE_TEST_CASE_SIG("re-map by the mass matrix: bodies against walls", "", ((int Dim), Dim), 1, 2, 3) {
  BothEngines<Dim, double> engines({false, -0.2, true});
  engines.lanes.memory.remap_method = RemapMethod::mass_matrix;
  engines.lanes.memory.walls.fixed[0][0] = 1;
  engines.run(elastic<Dim, double>(), DeterminantVolume{}, [](int) { return NoVirtualStress{}; });
  CHECK(engines.lanes.memory.lanes.remaps_by_mass_matrix());
  check_same(engines);
}

TEMPLATE_TEST_CASE_SIG("particles per cell decide the method of the re-map", "", ((int Dim), Dim), 1, 2, 3) {
  // In 3D the particles must be too many for caches, too.
  const auto remaps_by_mass_matrix = [](int along, int cells) {
    const auto grid = make_grid<Dim, double>({{cells, cells, cells}});
    const auto block = fill_cells<Dim, double>(grid, along, 1., [](const Vector<Dim, int>&) { return true; });
    LaneState<Dim, double, Device> s;
    s.memory.grid = grid;
    REQUIRE(pack_lanes(Exec(), block.particles, s) == -1);
    const bool one = s.memory.lanes.remaps_by_mass_matrix();
    s.memory.remap_method = one ? RemapMethod::second_sweep : RemapMethod::mass_matrix;
    REQUIRE(pack_lanes(Exec(), block.particles, s) == -1);
    CHECK(s.memory.lanes.remaps_by_mass_matrix() == !one);
    return one;
  };
  CHECK(!remaps_by_mass_matrix(2, 20));
  CHECK(remaps_by_mass_matrix(3, 20) == (Dim < 3));
  CHECK(remaps_by_mass_matrix(4, 5) == (Dim < 3));
  CellLanes<Dim, double, Device> large;
  large.particle_count = 64 * 20000;
  CHECK(mass_matrix_is_faster(large, 20000));
  CHECK(mass_matrix_is_faster(large, 50000) == (Dim < 3));
}
