// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// 100 steps on cell lanes are 100 steps of the particle kernels: bodies without load and under uniform
/// virtual stresses, at rest and moving, with gravity, damping and walls.
#include <cstdio>

#include "engine_scenes.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

/// The bits of 60 steps of a moving body under tractions that change from node to node.
template <int Dim, class Real>
std::uint64_t state_hash(RemapMethod remap_method) {
  BothEngines<Dim, Real> engines({false, 5});
  engines.lanes.memory.remap_method = remap_method;
  engines.declare([](const Vector<Dim, int>& ijk) { return static_cast<TractionMask>(ijk[0] / 3 % 4); });
  engines.at_all_active_nodes = 2;
  engines.options.damping = Real(0.05);
  UniformVirtualStress<Dim, Real> f;
  f.count = 2;
  f.stress[0] = pressure_stress<Dim>(Real(2));
  f.stress[1] = full_tensor<Dim, Real>();
  engines.run(
      elastic<Dim, Real>(), DeterminantVolume{}, [&](int) { return f; }, 60);
  REQUIRE((engines.moved > 20 || sizeof(Real) == 4));
  return hash_of(engines.copy);
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("free bodies", "", ((int Dim, typename Real), Dim, Real), (1, double), (2, double),
                       (3, double), (1, float), (2, float), (3, float)) {
  check_free_bodies<Dim, Real, BothEngines<Dim, Real>>();
}

TEMPLATE_TEST_CASE_SIG("positions by the velocity before the re-map", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (2, float)) {
  check_grid_velocity<Dim, Real, BothEngines<Dim, Real>>();
}

TEMPLATE_TEST_CASE_SIG("a share of PIC", "", ((int Dim, typename Real), Dim, Real), (1, double), (2, double),
                       (3, double), (2, float)) {
  for (const auto remap_method : {RemapMethod::second_sweep, RemapMethod::mass_matrix})
    check_pic<Dim, Real, BothEngines<Dim, Real>>(
        [&](auto& engines) { engines.lanes.memory.remap_method = remap_method; });
}

TEMPLATE_TEST_CASE_SIG("particles next to the faces of their cells", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (2, float), (3, float)) {
  check_slivers<Dim, Real, BothEngines<Dim, Real>>();
}

TEMPLATE_TEST_CASE_SIG("bodies under a pressure and under any uniform tensor", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (1, float), (2, float), (3, float)) {
  for (const bool equal_spacing : {true, false})
    for (const bool pressure : {true, false})
      check_uniform_stress<Dim, Real, BothEngines<Dim, Real>>(equal_spacing, pressure);
}

TEMPLATE_TEST_CASE_SIG("tractions that change from node to node, some at all active nodes", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (3, float)) {
  check_mixed_tractions<Dim, Real, BothEngines<Dim, Real>>();
}

TEMPLATE_TEST_CASE_SIG("a body that slides along a wall and one fixed to it", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (2, float)) {
  check_body_at_a_wall<Dim, Real, BothEngines<Dim, Real>>();
}

TEST_CASE("print state hashes of cell lanes", "[.][state_hashes]") {  // run by kernels/same_bits.py
  const std::uint64_t hashes[] = {
      state_hash<1, double>(RemapMethod::second_sweep), state_hash<2, double>(RemapMethod::second_sweep),
      state_hash<3, double>(RemapMethod::second_sweep), state_hash<3, float>(RemapMethod::second_sweep),
      state_hash<2, double>(RemapMethod::mass_matrix),  state_hash<3, float>(RemapMethod::mass_matrix)};
  for (const std::uint64_t hash : hashes)
    std::printf("hash of lanes %016llx\n", static_cast<unsigned long long>(hash));
}
