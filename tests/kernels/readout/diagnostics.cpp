// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Ordered sums, the search for spoilt particles, and the balance of forces and energies.
#include <vsb/kernels/readout/balance.hpp>
#include <vsb/kernels/readout/health.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

struct Powers {
  KOKKOS_FUNCTION void operator()(int i, Vector<2, double>& sum) const {
    sum[0] += i;
    sum[1] += static_cast<double>(i) * i;
  }
};

/// A row of four cells of 1 m; one particle in the middle of the second, so that dN = -1, 1 at its nodes 1
/// and 2, and traction sbar_xx = -7 at node 2.
struct OneParticle {
  LinearBasis<1, double> basis{UniformGrid<1, double>({{0}}, {{1}}, {{4}})};
  ParticleBlock<1, double, Device> block = allocate_particles<1, double, Device>(1);
  State<1, double, Device> state;
  UniformVirtualStress<1, double> field;
  std::vector<Body<double>> bodies{{0, 1, LinearElastic<double>{400, 400}}};
  StepOptions<1, double> options;

  OneParticle() {
    edit(block, [](const auto& particles) {
      particles.position(0, 0) = 1.5;
      particles.velocity(0, 0) = 3;
      particles.mass(0) = 2;
      particles.volume(0) = 1;
      particles.cauchy_stress(0, 0) = 10;
      particles.cauchy_stress(0, 1) = particles.cauchy_stress(0, 2) = 4;
    });
    state = make_state(block.particles, basis);
    edit(state.occupancy.tractions, [](const auto& host) { host(2) = 1; });
    REQUIRE(update_occupancy(Exec(), block.particles, state.occupancy, basis) == -1);
    field.count = 1;
    field.stress[0] = {{-7, 0, 0}};
    options.dt = 1;
  }
  auto operator()() { return balance(Exec(), state, bodies, basis, field, options); }
};

}  // namespace

TEST_CASE("ordered_sum adds every term once") {
  for (const int n : {0, 1, 2, 1023, 1024, 1025, 2048, 5000}) {
    const auto sum = ordered_sum<2, Device>(Exec(), "vsb::test", n, Powers{});
    const double N = n;
    CAPTURE(n);
    CHECK(sum[0] == N * (N - 1) / 2);
    CHECK(sum[1] == (N - 1) * N * (2 * N - 1) / 6);
  }
}

TEMPLATE_TEST_CASE_SIG("find_invalid names the lowest spoilt particle and its field", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, float), (3, double)) {
  const auto grid = make_grid<Dim, Real>();
  const auto block = random_particles(grid, 2000, 61);
  const auto spoil = [&](ParticleField field, int p, Real value) {
    edit(block, [&](const auto& particles) {
      switch (field) {
        case ParticleField::position:
          particles.position(p, Dim - 1) = value;
          break;
        case ParticleField::velocity:
          particles.velocity(p, 0) = value;
          break;
        case ParticleField::cauchy_stress:
          particles.cauchy_stress(p, particles.stress_size - 1) = value;
          break;
        case ParticleField::volume:
          particles.volume(p) = value;
          break;
        case ParticleField::none:
          break;
      }
    });
  };
  const auto found = [&](ParticleField field, int p) {
    const auto invalid = find_invalid(Exec(), block.particles);
    CHECK(invalid.particle == p);
    CHECK(static_cast<int>(invalid.field) == static_cast<int>(field));
  };
  found(ParticleField::none, -1);
  const Real nan = std::numeric_limits<Real>::quiet_NaN(), infinity = std::numeric_limits<Real>::infinity();
  spoil(ParticleField::volume, 1999, 0);
  found(ParticleField::volume, 1999);
  spoil(ParticleField::cauchy_stress, 1000, -infinity);
  found(ParticleField::cauchy_stress, 1000);
  spoil(ParticleField::velocity, 500, nan);
  spoil(ParticleField::velocity, 1500, nan);
  found(ParticleField::velocity, 500);
  spoil(ParticleField::volume, 300, Real(-1e-9));
  found(ParticleField::volume, 300);
  spoil(ParticleField::position, 0, infinity);
  found(ParticleField::position, 0);
  CHECK(find_invalid(Exec(), allocate_particles<Dim, Real, Device>(0).particles).particle == -1);
}

TEST_CASE("balance of one particle, by hand") {
  OneParticle one;
  const auto b = one();  // forces 10 and -10 without the traction, 10 and -17 with it
  CHECK(one.state.occupancy.boundary_node_count == 1);
  CHECK_THAT(b.unbalanced_force, WithinRel(std::sqrt(100. + 289.), 1e-15));
  CHECK_THAT(b.internal_force, WithinRel(std::sqrt(200.), 1e-15));
  CHECK_THAT(b.force_ratio(), WithinRel(std::sqrt(389. / 200.), 1e-15));
  CHECK(b.net_force[0] == -7);
  CHECK(b.kinetic_energy == 9);
  CHECK_THAT(b.strain_energy, WithinRel((100. + 16 + 16) / 2400, 1e-15));
}

TEST_CASE("what acts on a fixed node is no unbalanced force, and counts as traction all the same") {
  OneParticle one;
  edit(one.state.nodes.fixed_components, [](const auto& host) { host(1) = 1; });
  const auto b = one();
  CHECK(b.unbalanced_force == 17);
  CHECK(b.net_force[0] == -7);
  CHECK(b.kinetic_energy == 4.5);  // of the other node: 1 kg at 3 m/s
  CHECK_THAT(b.internal_force, WithinRel(std::sqrt(200.), 1e-15));

  edit(one.state.nodes.fixed_components, [](const auto& host) { host(1) = 0, host(2) = 1; });
  const auto c = one();
  CHECK(c.unbalanced_force == 10);
  CHECK(c.net_force[0] == -7);  // on the fixed node: there is void beyond it
}

TEST_CASE("the balance counts the weight, and is one without any force") {
  OneParticle one;
  one.options.gravity = {{-4}};  // 4 N of weight at each node
  const auto b = one();
  CHECK_THAT(b.unbalanced_force, WithinRel(std::sqrt(6. * 6. + 21. * 21.), 1e-15));
  CHECK_THAT(b.internal_force, WithinRel(std::sqrt(6. * 6. + 14. * 14.), 1e-15));

  OneParticle idle;
  edit(idle.block, [](const auto& particles) { particles.cauchy_stress(0, 0) = 0; });
  idle.field.stress[0] = {{0, 0, 0}};
  CHECK(idle().force_ratio() == 1);
}

TEST_CASE("energies add up over bodies, each with its own modulus") {
  const auto grid = make_grid<2, double>();
  const auto block = random_particles(grid, 10, 62);
  edit(block, [](const auto& particles) {
    for (int p = 0; p < 10; ++p) {
      particles.mass(p) = particles.volume(p) = 2;
      for (int i = 0; i < 2; ++i) particles.velocity(p, i) = 3;
      for (int c = 0; c < 4; ++c) particles.cauchy_stress(p, c) = 1;
    }
  });
  const LinearBasis<2, double> basis{grid};
  auto state = make_state(block.particles, basis);
  const std::vector<Body<double>> bodies{{0, 4, LinearElastic<double>{0, 5}},
                                         {4, 10, LinearElastic<double>{0, 50}}};
  const auto measure = [&] {
    REQUIRE(update_occupancy(Exec(), block.particles, state.occupancy, basis) == -1);
    return balance(Exec(), state, bodies, basis, NoVirtualStress{}, StepOptions<2, double>{});
  };
  const auto b = measure();
  CHECK_THAT(b.kinetic_energy, WithinRel(10 * 18., 1e-14));  // uniform velocity: the grid has all of it
  // |sigma|^2 = 3 + 2 for each particle of 2 m^2; moduli 10 and 100 Pa.
  CHECK_THAT(b.strain_energy, WithinRel(4 * 2 * 5 / 20. + 6 * 2 * 5 / 200., 1e-14));
  for (int i = 0; i < 2; ++i) CHECK(b.net_force[i] == 0);

  edit(block, [](const auto& particles) {  // pairs in one position with opposite velocities
    for (int p = 0; p < 10; ++p)
      for (int i = 0; i < 2; ++i) {
        particles.position(p, i) = particles.position(p / 2 * 2, i);
        particles.velocity(p, i) = p % 2 == 0 ? 3 : -3;
      }
  });
  CHECK_THAT(measure().kinetic_energy, WithinAbs(0, 1e-28));
}
