// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A particle code with its own memory, an array of structures, that lets vsb make the steps: the embedding
/// that the README shows, on the host's default execution space. Exits 0 when the pressed block and the
/// floating one behave.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>
#include <vsb/kernels/lane_step.hpp>
#include <vsb/kernels/step.hpp>
#include <vsb/physics/linear_basis.hpp>
#include <vsb/physics/traction_fields.hpp>

namespace {

struct MyParticle {
  double x[2], v[2], stress[4];  // xx yy zz xy
  double mass, volume;
  int colour;  // something vsb knows nothing about
};

using Exec = Kokkos::DefaultHostExecutionSpace;
using Device = Exec::device_type;

/// The owner's particles: a block of 2 m by 1 m, 0.25 m apart.
std::vector<MyParticle> make_block() {
  std::vector<MyParticle> mine;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 8; ++i)
      mine.push_back({{1.125 + 0.25 * i, 0.125 + 0.25 * j}, {0, 0}, {0, 0, 0, 0}, 62.5, 0.0625, i});
  return mine;
}

/// Wrapped, not copied: where the first value is, how many particles and columns, and the distance from one
/// particle to the next in doubles.
vsb::Particles<2, double, Device> wrap(std::vector<MyParticle>& mine) {
  const int n = static_cast<int>(mine.size()), stride = sizeof(MyParticle) / sizeof(double);
  vsb::Particles<2, double, Device> particles;
  particles.position = particles.wrap(mine[0].x, n, 2, stride);
  particles.velocity = particles.wrap(mine[0].v, n, 2, stride);
  particles.cauchy_stress = particles.wrap(mine[0].stress, n, 4, stride);
  particles.mass = particles.wrap(&mine[0].mass, n, stride);
  particles.volume = particles.wrap(&mine[0].volume, n, stride);
  return particles;
}

int press() {
  std::vector<MyParticle> mine = make_block();
  const auto particles = wrap(mine);
  const int n = particles.count();

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

/// The same on cell lanes: packed, stepped and unpacked; the fast way where many steps follow each other.
int press_in_lanes() {
  std::vector<MyParticle> mine = make_block();
  const auto particles = wrap(mine);
  vsb::LaneState<2, double, Device> lanes;
  lanes.memory.grid = vsb::UniformGrid<2, double>({{1.0, 0.0}}, {{1.0, 1.0}}, {{5, 1}});
  lanes.memory.walls.fixed[0][0] = 3;                                   // lower face of x: both components
  lanes.memory.walls.fixed[1][0] = lanes.memory.walls.fixed[1][1] = 2;  // faces of y: the second
  lanes.boundary.everywhere = 1;                                        // traction 0 is declared everywhere
  const auto rock = vsb::LinearElastic<double>::from_young(1e7, 0.2);
  vsb::StepOptions<2, double> options{};
  options.dt = vsb::time_step(0.5, 1.0, rock.constrained_modulus(), 1000.0);
  options.damping = 0.3;
  vsb::UniformVirtualStress<2, double> load{};
  load.count = 1;
  const auto load_of_step = [&](int step) {
    load.stress[0] = vsb::pressure_stress<2>(1e4 * std::fmin(1.0, step / 500.0));
    return load;
  };
  if (vsb::pack_lanes(Exec(), particles, lanes) >= 0) return 2;
  vsb::prepare_lane_step(Exec(), lanes, load_of_step(1));
  for (int step = 1; step <= 2000; ++step)
    if (vsb::lane_step(Exec(), lanes, rock, vsb::DeterminantVolume{}, load_of_step(step + 1), options) >= 0)
      return 2;
  vsb::unpack_particles(Exec(), lanes.memory, particles);
  Kokkos::fence();

  double worst = 0;
  for (const auto& p : mine) worst = std::fmax(worst, std::fabs(p.stress[0] / -1e4 - 1));
  std::printf("largest error of the axial stress on cell lanes: %.1e of the pressure\n", worst);
  return worst < 1e-9 && mine[5].colour == 5 ? 0 : 1;
}

/// A virtual stress of one's own: water at rest below y = 3 m, and its divergence.
struct Water {
  double unit_weight;  // N/m^3
  KOKKOS_FUNCTION vsb::VirtualStressValue<2, double> operator()(const vsb::Vector<2, double>& x) const {
    return {vsb::pressure_stress<2>(unit_weight * (3 - x[1])), {{0, unit_weight}}};
  }
};

/// The block under water, as heavy as it and stressed as it, stays where it is.
int submerge() {
  std::vector<MyParticle> mine = make_block();
  const auto water = vsb::virtual_stress_of(Water{9810});
  for (auto& p : mine)
    for (int c = 0; c < 4; ++c) p.stress[c] = water.functor({{p.x[0], p.x[1]}}).stress[c];
  const vsb::LinearBasis<2, double> basis{vsb::UniformGrid<2, double>({{0.3, -0.6}}, {{0.5, 0.5}}, {{7, 5}})};
  auto state = vsb::make_state(wrap(mine), basis);
  Kokkos::deep_copy(state.occupancy.tractions, vsb::TractionMask(1));  // declared everywhere
  state.occupancy.conservative = 1;  // acts at all nodes, so that it carries
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

}  // namespace

int main(int argc, char** argv) {
  Kokkos::initialize(argc, argv);
  const int result = std::max({press(), press_in_lanes(), submerge()});
  Kokkos::finalize();
  return result;
}
