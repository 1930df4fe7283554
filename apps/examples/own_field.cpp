// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A virtual stress field of one's own: water at rest. The block under water, as heavy as it and stressed as
/// it, stays where it is.
///   own_field            exits 0 when nothing moves
#include <cstdio>
#include <vsb/kernels/step.hpp>
#include <vsb/physics/linear_basis.hpp>
#include <vsb/physics/traction_fields.hpp>
#include "my_particles.hpp"

/// 1. The stress at a point and its divergence; the surface of the water is at y = 3 m.
struct Water {
  double unit_weight;  // N/m^3
  KOKKOS_FUNCTION vsb::VirtualStressValue<2, double> operator()(const vsb::Vector<2, double>& x) const {
    return {vsb::pressure_stress<2>(unit_weight * (3 - x[1])), {{0, unit_weight}}};
  }
};

int main(int argc, char** argv) {
  const Kokkos::ScopeGuard kokkos(argc, argv);
  const auto water = vsb::virtual_stress_of(Water{9810});
  std::vector<MyParticle> mine = make_block();
  for (auto& p : mine)
    for (int c = 0; c < 4; ++c) p.stress[c] = water.functor({{p.x[0], p.x[1]}}).stress[c];

  // 2. The grid need not fit the block. The field acts at all nodes, so that the water carries the block.
  const vsb::LinearBasis<2, double> basis{vsb::UniformGrid<2, double>({{0.3, -0.6}}, {{0.5, 0.5}}, {{7, 5}})};
  auto state = vsb::make_state(wrap(mine), basis);
  Kokkos::deep_copy(state.occupancy.tractions, vsb::TractionMask(1));  // declared everywhere
  state.occupancy.at_all_active_nodes = 1;

  // 3. Steps, as in particle_step.cpp.
  const std::vector<vsb::Body<double>> rock{
      {0, static_cast<int>(mine.size()), vsb::LinearElastic<double>::from_young(1e7, 0.2)}};
  vsb::StepOptions<2, double> options{};
  options.dt = vsb::time_step(0.5, 0.5, std::get<0>(rock[0].material).constrained_modulus(), 1000.0);
  options.gravity = {{0, -9.81}};
  for (int step = 0; step < 500; ++step)
    if (vsb::step(Exec(), state, rock, basis, water, options) >= 0) return 2;
  Kokkos::fence();

  double fastest = 0;
  for (const auto& p : mine) fastest = std::fmax(fastest, std::fabs(p.v[1]));
  std::printf("largest velocity of the submerged block: %.1e m/s\n", fastest);
  return fastest < 1e-10 ? 0 : 1;
}
