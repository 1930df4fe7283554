// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A particle code with its own memory, an array of structures, that lets vsb make the steps: the embedding
/// that the README shows, on the host's default execution space. Exits 0 when the pressed block behaves.
#include <cmath>
#include <cstdio>
#include <vector>
#include <vsb/kernels/step.hpp>
#include <vsb/physics/linear_basis.hpp>

namespace {

struct MyParticle {
  double x[2], v[2], stress[4];  // xx yy zz xy
  double mass, volume;
  int colour;  // something vsb knows nothing about
};

int run() {
  using Exec = Kokkos::DefaultHostExecutionSpace;
  using Device = Exec::device_type;

  // The owner's particles: a block of 2 m by 1 m, 0.25 m apart.
  std::vector<MyParticle> mine;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 8; ++i)
      mine.push_back({{1.125 + 0.25 * i, 0.125 + 0.25 * j}, {0, 0}, {0, 0, 0, 0}, 62.5, 0.0625, i});

  // Wrapped, not copied: where the first value is, how many particles and columns, and the distance
  // from one particle to the next in doubles.
  const int n = static_cast<int>(mine.size()), stride = sizeof(MyParticle) / sizeof(double);
  vsb::Particles<2, double, Device> particles;
  particles.position = particles.wrap(mine[0].x, n, 2, stride);
  particles.velocity = particles.wrap(mine[0].v, n, 2, stride);
  particles.cauchy_stress = particles.wrap(mine[0].stress, n, 4, stride);
  particles.mass = particles.wrap(&mine[0].mass, n, stride);
  particles.volume = particles.wrap(&mine[0].volume, n, stride);

  // A grid of 5 x 1 cells of 1 m; the left side of the block is held, the sides are rollers, 10 kPa press on
  // the right.
  const vsb::LinearBasis<2, double> basis{vsb::UniformGrid<2, double>({{1.0, 0.0}}, {{1.0, 1.0}}, {{5, 1}})};
  auto state = vsb::make_state(particles, basis);
  for (int node = 0; node < basis.node_count(); ++node) {
    // Bit i: component i is held; bit k: traction k is declared here.
    state.nodes.fixed_components(node) = basis.grid.node_position(node)[0] == 1.0 ? 3 : 2;
    state.occupancy.tractions(node) = 1;
  }
  vsb::UniformVirtualStress<2, double> load{};
  load.count = 1;
  const std::vector<vsb::Body<double>> rock{{0, n, vsb::LinearElastic<double>::from_young(1e7, 0.2)}};
  vsb::StepOptions<2, double> options{};
  options.dt = vsb::time_step(0.5, 1.0, std::get<0>(rock[0].material).constrained_modulus(), 1000.0);
  options.damping = 0.3;
  for (int step = 1; step <= 2000; ++step) {
    load.stress[0] = vsb::pressure_stress<2>(1e4 * std::fmin(1.0, step / 500.0));
    if (vsb::step(Exec(), state, rock, basis, load, options) >= 0) return 2;
  }
  Kokkos::fence();

  double worst = 0;
  for (const auto& p : mine) worst = std::fmax(worst, std::fabs(p.stress[0] / -1e4 - 1));
  std::printf("largest error of the axial stress in the owner's particles: %.1e of the pressure\n", worst);
  return worst < 1e-9 && mine[5].colour == 5 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Kokkos::initialize(argc, argv);
  const int result = run();
  Kokkos::finalize();
  return result;
}
