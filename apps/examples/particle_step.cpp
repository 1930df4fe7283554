// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A block that a pressure of 10 kPa compresses, stepped by the particle kernels in the owner's own arrays.
///   particle_step        exits 0 when the stress is right to 1e-9
#include <cstdio>
#include <vsb/kernels/step.hpp>
#include <vsb/physics/linear_basis.hpp>
#include "my_particles.hpp"

int main(int argc, char** argv) {
  const Kokkos::ScopeGuard kokkos(argc, argv);

  // 1. The particles, where they lie.
  std::vector<MyParticle> mine = make_block();
  const auto particles = wrap(mine);

  // 2. A grid of 5 x 1 cells of 1 m, with two empty ones beyond the loaded side: without any no cell is void
  // beside it, and no node would be a boundary node.
  const vsb::LinearBasis<2, double> basis{vsb::UniformGrid<2, double>({{1.0, 0.0}}, {{1.0, 1.0}}, {{5, 1}})};

  // 3. What a step works on, and what is prescribed at the nodes: the left side is fixed, the sides are
  // rollers.
  auto state = vsb::make_state(particles, basis);
  for (int node = 0; node < basis.node_count(); ++node) {
    // Bit i: component i is fixed; bit k: traction k is declared here.
    state.nodes.fixed_components(node) = basis.grid.node_position(node)[0] == 1.0 ? 3 : 2;
    state.occupancy.tractions(node) = 1;
  }

  // 4. The material of all particles, the load, and the time step.
  const std::vector<vsb::Body<double>> rock{
      {0, particles.count(), vsb::LinearElastic<double>::from_young(1e7, 0.2)}};
  vsb::UniformVirtualStress<2, double> load{};
  load.count = 1;
  vsb::StepOptions<2, double> options{};
  options.dt = vsb::time_step(0.5, 1.0, std::get<0>(rock[0].material).constrained_modulus(), 1000.0);
  options.damping = 0.3;

  // 5. Steps; one that a particle leaves the grid in returns its number.
  for (int step = 1; step <= 2000; ++step) {
    load.stress[0] = vsb::pressure_stress<2>(1e4 * std::fmin(1.0, step / 500.0));
    if (vsb::step(Exec(), state, rock, basis, load, options) >= 0) return 2;
  }
  Kokkos::fence();

  // 6. The owner's particles have their new state.
  std::printf("largest error of the axial stress in the owner's particles: %.1e of the pressure\n",
              largest_error(mine));
  return largest_error(mine) < 1e-9 && mine[5].colour == 5 ? 0 : 1;
}
