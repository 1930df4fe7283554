// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What a material remembers per particle: which rows a body uses, a caller's own array, and what is refused.

#include <common_steps.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

LinearBasis<2, double> one_cell() {
  return {make_grid<2, double>({{1, 1, 1}})};
}

/// Particles in the middle of a cell, under the velocity gradient L; they do not move.
struct Sheared {
  LinearBasis<2, double> basis = one_cell();
  ParticleBlock<2, double, Device> block;
  Nodes<2, double, Device> nodes = allocate_nodes<2, double, Device>(4);

  Sheared(int particles, const Matrix<2, double>& L)
      : block(allocate_particles<2, double, Device>(particles)) {
    edit(block, [&](const auto& host) {
      for (int p = 0; p < particles; ++p) {
        for (int i = 0; i < 2; ++i) host.position(p, i) = basis.grid.lower[i] + 0.5 * basis.grid.spacing[i];
        host.volume(p) = 1;
      }
    });
    edit(nodes.remapped_velocity, [&](const auto& v) {
      for (int node = 0; node < 4; ++node) {
        const auto x = basis.grid.node_position(node);
        for (int i = 0; i < 2; ++i) v(node, i) = L(i, 0) * x[0] + L(i, 1) * x[1];
      }
    });
  }
  void update(const std::vector<Body<double>>& bodies, double dt) {
    update_stress(Exec(), block.particles, nodes, bodies, basis, DeterminantVolume{},
                  PositionVelocity::strain, dt);
  }
};

}  // namespace

TEST_CASE("each body finds its rows of state, and bodies without state have none") {
  Sheared sheet(6, {{{0, 1}, {0, 0}}});
  const auto linear = LinearElastic<double>::from_young(1000, 0.25);
  const auto hencky = Hencky<double>::from_young(1000, 0.25);
  allocate_material_state(sheet.block, 4, 4);
  // Particles 0, 1: rate form; 2: rows 3; 3, 4, 5: rows 0, 1, 2.
  const std::vector<Body<double>> bodies{{0, 2, linear}, {2, 3, hencky, 1}, {3, 6, hencky, -3}};
  for (int n = 0; n < 3; ++n) {
    sheet.update(bodies, 0.5);
    edit(sheet.block, [](const auto& host) {
      host.material_state(2, 1) += 1;  // row 2, of particle 5, gets another shear
    });
  }
  // H12 = 1.5 after three steps of 0.5, and 4.5 for particle 5: simple shear does not change F's other
  // entries.
  const auto shear_stress = [](double gamma) {
    const double a = std::asinh(gamma / 2);
    return 2 * 400 * a / std::cosh(a);
  };
  const auto host = read(sheet.block);
  for (const int p : {2, 3, 4}) CHECK_THAT(host.cauchy_stress(p, 3), WithinRel(shear_stress(1.5), 1e-12));
  CHECK_THAT(host.cauchy_stress(5, 3), WithinRel(shear_stress(3.5), 1e-12));  // the last one came after
  CHECK(host.material_state(3, 1) == 1.5);
  CHECK(host.material_state(0, 1) == 1.5);
  CHECK(host.material_state(2, 1) == 4.5);
  for (int p = 0; p < 6; ++p) CHECK(host.volume(p) == 1);
  Sheared alone(2, {{{0, 1}, {0, 0}}});
  for (int n = 0; n < 3; ++n) alone.update({{0, 2, linear}}, 0.5);
  CHECK(read(alone.block).cauchy_stress(1, 3) == host.cauchy_stress(1, 3));
}

TEST_CASE("the state may lie in a caller's array of structures") {
  if constexpr (std::is_same_v<Device::memory_space, Kokkos::HostSpace>) {
    struct Record {
      double before, H[4], after;
    };
    std::vector<Record> records(3, Record{7, {0, 0, 0, 0}, 7});
    Sheared sheet(3, {{{0.1, 0}, {0, 0}}});
    auto& particles = sheet.block.particles;
    particles.material_state = particles.wrap(records[0].H, 3, 4, sizeof(Record) / sizeof(double));
    sheet.update({{0, 3, Hencky<double>::from_young(1000, 0)}}, 1);
    Kokkos::fence();
    for (const auto& record : records) {
      CHECK_THAT(record.H[0], WithinAbs(0.1, 1e-15));
      CHECK(record.H[3] == 0);
      CHECK((record.before == 7 && record.after == 7));
    }
    CHECK_THAT(particles.cauchy_stress(2, 0), WithinRel(1000 * std::log(1.1) / 1.1, 1e-12));
  }
}

TEST_CASE("a body without the rows or columns it needs is refused, and told which") {
  Sheared sheet(6, Matrix<2, double>::zero());
  const auto hencky = Hencky<double>::from_young(1000, 0.25);
  const auto update = [&](const Body<double>& body) { sheet.update({body}, 0.1); };
  CHECK_THROWS_WITH(update({2, 6, hencky}),
                    containing("material_state is 0 x") && containing("rows 2 to 5 with 4"));
  CHECK_NOTHROW(update({2, 2, hencky}));  // no particles
  allocate_material_state(sheet.block, 4, 4);
  CHECK_NOTHROW(update({2, 6, hencky, -2}));
  for (const int offset : {-3, -1}) CHECK_THROWS_AS(update({2, 6, hencky, offset}), std::invalid_argument);
  allocate_material_state(sheet.block, 6, 3);
  CHECK_THROWS_WITH(update({2, 6, hencky}), containing("6 x 3"));
}

TEST_CASE("copies of a block carry the state") {
  const auto block = [] {
    auto b = allocate_particles<3, float, Device>(5);
    allocate_material_state(b, 3, 9);
    return b;
  }();
  CHECK_NOTHROW(block.particles.check());
  edit(block, [](const auto& host) {
    for (int row = 0; row < 3; ++row)
      for (int c = 0; c < 9; ++c) host.material_state(row, c) = static_cast<float>(10 * row + c);
  });
  const auto host = read(block);
  REQUIRE(host.material_state.extent(0) == 3);
  REQUIRE(host.material_state.extent(1) == 9);
  CHECK(host.material_state(2, 8) == 28);
  CHECK(read(allocate_particles<3, float, Device>(5)).material_state.extent(0) == 0);
}
