// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The three ways to sum over particles give the same sums; the gathered one the same bits.
#include <cstring>
#include <numeric>
#include <vsb/kernels/particles/locate_particles.hpp>
#include <vsb/kernels/particles/particles_to_grid.hpp>
#include <vsb/kernels/particles/remap_velocity.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

const int count = 2000;

template <int Dim>
using Sums = std::vector<Vector<1 + 3 * Dim, double>>;

/// Nodal sums of particles, and the re-mapped momentum (in that order), by one strategy. Twice, so that the
/// second time works on what the first left in the workspace.
template <int Dim>
Sums<Dim> sum_up(const ParticleBlock<Dim, double, Device>& block, const LinearBasis<Dim, double>& basis,
                 Scatter strategy) {
  auto bins = allocate_bins<Device>(count, basis.bin_count());
  locate_particles(Exec(), block.particles, bins, basis);
  sort_by_bin(Exec(), bins);
  const auto nodes = allocate_nodes<Dim, double, Device>(basis.node_count());
  Kokkos::deep_copy(nodes.sums, 1e30);
  Kokkos::deep_copy(nodes.remapped_velocity, 1e30);
  ScatterWorkspace<double, Device> sums_workspace, remap_workspace;
  const BoundaryNodes<Device> boundary("vsb::boundary", static_cast<size_t>(basis.node_count()));
  UniformVirtualStress<Dim, double> pressure;
  pressure.count = 1;
  pressure.stress[0] = pressure_stress<Dim>(1.5);
  edit(boundary, [&](const auto& host) {
    for (int I = 0; I < basis.node_count(); ++I) host(I) = I % 2;
  });
  Vector<Dim, double> gravity;
  for (int i = 0; i < Dim; ++i) gravity[i] = 1 + i;
  for (int times = 0; times < 2; ++times) {
    particles_to_grid(Exec(), block.particles, bins, nodes, boundary, sums_workspace, basis, pressure,
                      gravity, strategy);
    scatter(Exec(), "vsb::remap_momentum", strategy, count, basis, bins, remap_workspace,
            kernel::RemapMomentum<LinearBasis<Dim, double>, Dim, double, Device>{block.particles, basis},
            nodes.remapped_velocity);
  }
  const auto a = read(nodes.sums), b = read(nodes.remapped_velocity);
  Sums<Dim> result(static_cast<size_t>(basis.node_count()));
  for (int I = 0; I < basis.node_count(); ++I) {
    auto& row = result[static_cast<size_t>(I)];
    for (int c = 0; c < 1 + 2 * Dim; ++c) row[c] = a(I, c);
    for (int c = 0; c < Dim; ++c) row[1 + 2 * Dim + c] = b(I, c);
  }
  return result;
}

/// The same particles in another order.
template <int Dim>
ParticleBlock<Dim, double, Device> reordered(const ParticleBlock<Dim, double, Device>& block,
                                             const std::vector<int>& order) {
  const auto result = allocate_particles<Dim, double, Device>(count);
  const auto source = host_copy(block).block;
  const auto target = host_copy(result).block;
  for (int p = 0; p < count; ++p)
    for (int c = 0; c < block.columns(); ++c) target(p, c) = source(order[static_cast<size_t>(p)], c);
  Kokkos::deep_copy(result.block, target);
  return result;
}

/// Largest difference, in units of the round-off of one term: V |sigma| |dN| of up to 200 N, masses of up
/// to 1.5 kg. A sum of n terms, in any order, is off by at most n epsilon times the sum of their magnitudes:
/// n^2 such units.
template <int Dim>
double difference(const Sums<Dim>& a, const Sums<Dim>& b) {
  double worst = 0;
  for (size_t I = 0; I < a.size(); ++I)
    for (int c = 0; c < 1 + 3 * Dim; ++c) {
      const bool force = c > Dim && c <= 2 * Dim;
      worst = std::max(worst, std::abs(a[I][c] - b[I][c]) / (force ? 200 : 1.5) / epsilon<double>);
    }
  return worst;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("atomic, duplicated and gathered sums agree to round-off", "", ((int Dim), Dim), 1, 2,
                       3) {
  const auto grid = make_grid<Dim, double>();
  const LinearBasis<Dim, double> basis{grid};
  const auto block = random_particles(grid, count, 51);
  const auto gathered = sum_up(block, basis, Scatter::gathered);
  double total = 0;
  for (const auto& row : gathered) total += row[0];
  CHECK(total > 0.8 * count);  // masses are 1 on the average
  CHECK(difference<Dim>(sum_up(block, basis, Scatter::atomic), gathered) < count * count);
  if constexpr (std::is_same_v<Device::memory_space, Kokkos::HostSpace>) {
    CHECK(difference<Dim>(sum_up(block, basis, Scatter::duplicated), gathered) < count * count);
  } else {
    CHECK_THROWS_AS(sum_up(block, basis, Scatter::duplicated), std::invalid_argument);
  }
}

TEMPLATE_TEST_CASE_SIG("gathered sums repeat bit by bit, and follow the particles' order to round-off", "",
                       ((int Dim), Dim), 1, 2, 3) {
  const auto grid = make_grid<Dim, double>({{7, 5, 4}});
  const LinearBasis<Dim, double> basis{grid};
  const auto block = random_particles(grid, count, 52);
  const auto first = sum_up(block, basis, Scatter::gathered);
  for (int times = 0; times < 5; ++times) {
    const auto again = sum_up(block, basis, Scatter::gathered);
    CHECK(std::memcmp(first.data(), again.data(), first.size() * sizeof(first[0])) == 0);
  }
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  Random random(53);
  random.shuffle(order);
  const auto shuffled = sum_up(reordered(block, order), basis, Scatter::gathered);
  CHECK(difference<Dim>(first, shuffled) < count * count);
  CHECK(std::memcmp(first.data(), shuffled.data(), first.size() * sizeof(first[0])) != 0);
}

TEST_CASE("a node without particles sums to zero, also where it had some before") {
  const auto grid = make_grid<2, double>();
  const LinearBasis<2, double> basis{grid};
  const auto nodes = allocate_nodes<2, double, Device>(basis.node_count());
  const auto block = allocate_particles<2, double, Device>(1);
  auto bins = allocate_bins<Device>(1, basis.bin_count());
  ScatterWorkspace<double, Device> workspaces[2];
  for (const Scatter strategy : {Scatter::gathered, Scatter::atomic}) {
    auto& workspace = workspaces[strategy == Scatter::atomic];
    for (const int cell : {0, 3}) {
      edit(block, [&](const auto& particles) {
        particles.mass(0) = 1;
        particles.position(0, 0) = grid.lower[0] + (cell + 0.5) * grid.spacing[0];
        particles.position(0, 1) = grid.lower[1] + 0.5 * grid.spacing[1];
      });
      locate_particles(Exec(), block.particles, bins, basis);
      sort_by_bin(Exec(), bins);
      particles_to_grid(Exec(), block.particles, bins, nodes, BoundaryNodes<Device>(), workspace, basis,
                        NoVirtualStress{}, Vector<2, double>::zero(), strategy);
      const auto sums = read(nodes.sums);
      for (int I = 0; I < basis.node_count(); ++I) {
        const auto ijk = grid.node_ijk(I);
        CHECK(sums(I, 0) == ((ijk[0] == cell || ijk[0] == cell + 1) && ijk[1] < 2 ? 0.25 : 0));
      }
    }
  }
}

TEST_CASE("gathered sums grow with the number of occupied bins") {
  // The workspace is first sized for one occupied bin, then needs many.
  const auto grid = make_grid<2, double>({{40, 40, 1}});
  const LinearBasis<2, double> basis{grid};
  const auto nodes = allocate_nodes<2, double, Device>(basis.node_count());
  const auto block = random_particles(grid, count, 54);
  auto bins = allocate_bins<Device>(count, basis.bin_count());
  ScatterWorkspace<double, Device> workspace;
  std::vector<Vector<2, double>> positions;
  double mass = 0;
  edit(block, [&](const auto& particles) {
    for (int p = 0; p < count; ++p) {
      positions.push_back(particles.position_of(p));
      mass += particles.mass(p);
    }
  });
  for (const int bins_wanted : {1, 30, 900, 2}) {
    edit(block, [&](const auto& particles) {
      for (int p = 0; p < count; ++p)
        for (int i = 0; i < 2; ++i)
          particles.position(p, i) = positions[static_cast<size_t>(p % bins_wanted)][i];
    });
    locate_particles(Exec(), block.particles, bins, basis);
    sort_by_bin(Exec(), bins);
    particles_to_grid(Exec(), block.particles, bins, nodes, BoundaryNodes<Device>(), workspace, basis,
                      NoVirtualStress{}, Vector<2, double>::zero(), Scatter::gathered);
    CAPTURE(bins_wanted);
    CHECK(bins.occupied_count() <= bins_wanted);
    CHECK_THAT(column_sum(nodes.sums, 0), WithinRel(mass, 1e-13));
  }
}

TEST_CASE("no addition is lost where all threads meet at one node") {
  // Every particle gives 1/2 kg to each of two nodes: exact in any order.
  const LinearBasis<1, double> basis{UniformGrid<1, double>({{0}}, {{1}}, {{1}})};
  const int crowd = 300000;
  const auto block = allocate_particles<1, double, Device>(crowd);
  Kokkos::deep_copy(block.particles.position, 0.5);
  Kokkos::deep_copy(block.particles.mass, 1);
  const auto nodes = allocate_nodes<1, double, Device>(basis.node_count());
  ScatterWorkspace<double, Device> workspace;
  for (int times = 0; times < 20; ++times) {
    const bool host = std::is_same_v<Device::memory_space, Kokkos::HostSpace>;
    const Scatter strategy = host && times % 4 == 3 ? Scatter::duplicated : Scatter::atomic;
    particles_to_grid(Exec(), block.particles, ParticleBins<Device>(), nodes, BoundaryNodes<Device>(),
                      workspace, basis, NoVirtualStress{}, Vector<1, double>::zero(), strategy);
    const auto sums = read(nodes.sums);
    for (int I = 0; I < 2; ++I) CHECK(sums(I, 0) == crowd / 2);
  }
}
