// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// 100 steps on cell lanes with quadratic B-splines are 100 steps of the particle kernels: without load,
/// under virtual stresses of all kinds, at rest and moving, with gravity, damping and walls that mirror.
#include <cstdio>

#include "engine_scenes.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

template <int Dim, class Real>
using Engines = BothEngines<Dim, Real, QuadraticBSplineBasis>;

/// The bits of 60 steps of a moving body under tractions that change from node to node, fixed to a wall.
template <int Dim, class Real>
std::uint64_t state_hash() {
  Engines<Dim, Real> engines({false, 0, true}, 5);
  engines.lanes.memory.walls.fixed[0][0] = 1;
  engines.declare([](const Vector<Dim, int>& ijk) { return striped<Dim>(ijk); });
  engines.at_all_active_nodes = 2;
  engines.options.damping = Real(0.05);
  engines.run(
      elastic<Dim, Real>(), DeterminantVolume{},
      [&](int) { return four_uniform_stresses<Dim, Real>(engines.amplitude); }, 60);
  return hash_of(engines.copy);
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("splines: free bodies", "", ((int Dim, typename Real), Dim, Real), (1, double),
                       (2, double), (3, double), (2, float), (3, float)) {
  check_free_bodies<Dim, Real, Engines<Dim, Real>>();
}

TEMPLATE_TEST_CASE_SIG("splines: positions by the velocity before the re-map", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (2, float)) {
  check_grid_velocity<Dim, Real, Engines<Dim, Real>>();
}

TEMPLATE_TEST_CASE_SIG("splines: a share of PIC", "", ((int Dim, typename Real), Dim, Real), (1, double),
                       (2, double), (3, double), (2, float)) {
  check_pic<Dim, Real, Engines<Dim, Real>>([](auto&) {});
}

TEMPLATE_TEST_CASE_SIG("splines: particles next to the faces of their cells", "",
                       ((int Dim, typename Real), Dim, Real), (2, double), (3, double), (2, float)) {
  check_slivers<Dim, Real, Engines<Dim, Real>>();
}

TEMPLATE_TEST_CASE_SIG("splines: bodies under a pressure and under any uniform tensor", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (2, float), (3, float)) {
  for (const bool pressure : {true, false})
    check_uniform_stress<Dim, Real, Engines<Dim, Real>>(pressure, pressure);
}

TEMPLATE_TEST_CASE_SIG("splines: tractions that change from node to node, some at all active nodes", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (2, float), (3, float)) {
  check_mixed_tractions<Dim, Real, Engines<Dim, Real>>();
}

TEMPLATE_TEST_CASE_SIG("splines: a body that slides along a wall and one fixed to it", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (2, float), (3, float)) {
  check_body_at_a_wall<Dim, Real, Engines<Dim, Real>>();
}

TEMPLATE_TEST_CASE_SIG("splines: fields of all kinds, other ones from node to node", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (2, float)) {
  check_fields_of_all_kinds<Dim, Real, Engines<Dim, Real>>();
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
