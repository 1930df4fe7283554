// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Steps on cell lanes with Mohr-Coulomb plasticity against the same steps with linear elasticity.
#pragma once

#include "engine_cost.hpp"

namespace vsb::bench {

/// The column on lanes with memory for the plastic strain.
template <class Real>
Lane<3, Real> make_plastic_lanes(const Column<3, Real>& column) {
  constexpr int columns = MohrCoulomb<Real>::template state_size<3>();
  auto block = column.block;
  allocate_material_state(block, block.particles.count(), columns);
  Lane<3, Real> s;
  s.memory.grid = column.basis.grid;
  s.memory.walls.fixed[column.axis][0] = 7;
  s.memory.lanes.state_size = columns;
  if (pack_lanes(Exec(), block.particles, s) >= 0)
    throw std::runtime_error("a particle of the column is outside its grid");
  prepare_lane_step(Exec(), s, NoVirtualStress{});
  return s;
}

/// The first component of the plastic strain of all particles.
template <class Real>
std::vector<Real> plastic_strains(const Lane<3, Real>& s) {
  const auto data = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), s.memory.lanes.data);
  const auto id = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), s.memory.lanes.id);
  std::vector<Real> strain(static_cast<size_t>(s.memory.lanes.particle_count));
  for (size_t e = 0; e < id.extent(0); ++e)
    if (id(e) >= 0)
      strain[static_cast<size_t>(id(e))] = data(e, static_cast<size_t>(s.memory.lanes.state_column));
  return strain;
}

/// 80,000 particles: where none yields, where none yields but all have, and what a particle that yields
/// costs.
template <class Real>
void measure_materials(Record& record) {
  auto column = make_column<3, Real>({"80k_ppc8", 10, 100, 2}, Load::off, 0);
  auto s = make_plastic_lanes(column);
  const int particles = s.memory.lanes.particle_count;
  const auto with_cohesion = [&](double share) {
    return MohrCoulomb<Real>::from({1e6, 0.3, share * column.pressure, 0.4});
  };
  const auto strong = with_cohesion(1000), weak = with_cohesion(1);
  const auto advance = [&](const auto& material) {
    lane_step(Exec(), s, material, DeterminantVolume{}, NoVirtualStress{}, column.options);
  };
  const Variant elastic{"elastic", [&] { advance(column.material); }};
  const auto ratio = [](const Rounds& found) { return 1 + found.extras[1].percent / 100; };
  const auto virgin = measure_in_turns(elastic, {{"Mohr-Coulomb", [&] { advance(strong); }}}, 100);
  for (const Real strain : plastic_strains(s))
    if (strain != 0) throw std::runtime_error("a particle yields that should not");
  record.set("Mohr-Coulomb / elastic", ratio(virgin));
  for (int n = 0; n < 5; ++n) advance(weak);
  record.set("the same, all have yielded",
             ratio(measure_in_turns(elastic, {{"Mohr-Coulomb", [&] { advance(strong); }}}, 100)));
  const auto before = plastic_strains(s);
  advance(weak);
  const auto after = plastic_strains(s);
  int yielding = 0;
  for (size_t p = 0; p < before.size(); ++p) yielding += before[p] != after[p];
  const auto found =
      measure_in_turns({"strong", [&] { advance(strong); }}, {{"weak", [&] { advance(weak); }}}, 50);
  record.set("share that yields", static_cast<double>(yielding) / particles);
  record.set("ns per particle that yields", 1e9 * found.extras[1].seconds / yielding);
}

}  // namespace vsb::bench
