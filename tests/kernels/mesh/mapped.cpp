// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Kernels on mapped grids: Algorithm 1 by the logical cells, conservation, the patch test, and the column of
/// Section 4.1 on its three meshes.
#include <common_steps.hpp>
#include <vsb/kernels/readout/health.hpp>
#include <vsb/physics/exact_column.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

/// The position of local coordinates in a cell of a mesh in host memory.
template <int Dim>
Vector<Dim, double> position_in(const MappedGrid<Dim, double>& grid, const Vector<Dim, int>& cell,
                                const Vector<Dim, double>& xi) {
  return grid.cell(cell).at(xi).x;
}

/// n particles anywhere in a mapped grid in host memory, with masses and volumes near 1 and any velocity and
/// stress.
template <int Dim>
ParticleBlock<Dim, double, Device> random_particles_in(const MappedGrid<Dim, double>& grid, int n,
                                                       unsigned seed) {
  const auto block = random_particles(make_grid<Dim, double>(), n, seed);
  Random random(seed + 1);
  edit(block, [&](const auto& particles) {
    for (int p = 0; p < n; ++p) {
      Vector<Dim, int> cell;
      Vector<Dim, double> xi;
      for (int i = 0; i < Dim; ++i) {
        cell[i] = random.index(grid.cells[i]);
        xi[i] = random(0.001, 0.999);
      }
      const auto x = position_in(grid, cell, xi);
      for (int i = 0; i < Dim; ++i) particles.position(p, i) = x[i];
    }
  });
  return block;
}

/// The errors of Table 2 for the column, e_u against (A1) as printed and e_sigma, on a mesh with given nodes.
struct ColumnErrors {
  double u, sigma;
};
ColumnErrors run_column(const std::vector<double>& nodes) {
  const int n = 76;
  const double dx = 0.125, length = 9.5, E = 1e3, t = 1;
  const auto mesh = make_mapped_mesh<double, Device>(
      Vector<1, int>{{static_cast<int>(nodes.size()) - 1}},
      [&](const Vector<1, int>& i) { return Vector<1, double>{{nodes[static_cast<size_t>(i[0])]}}; });
  const MappedLinearBasis<1, double> basis{mesh.grid};
  const auto block = allocate_particles<1, double, Device>(n);
  edit(block, [&](const auto& p) {
    for (int k = 0; k < n; ++k) {
      p.position(k, 0) = (k + 0.5) * dx;
      p.mass(k) = p.volume(k) = dx;
    }
  });
  auto state = make_state(block.particles, basis);
  edit(state.nodes.fixed_components, [](const auto& host) { host(0) = 1; });
  Kokkos::deep_copy(state.occupancy.tractions, 1u);
  const std::vector<Body<double>> bodies{{0, n, LinearElastic<double>::from_young(E, 0)}};
  StepOptions<1, double> options;
  options.dt = 0.01;
  options.position_velocity = PositionVelocity::grid;  // of the paper, as its digits are
  options.damping = 0.05;
  UniformVirtualStress<1, double> load;
  load.count = 1;
  for (int k = 1; k <= 20000; ++k) {
    load.stress[0] = pressure_stress<1>(t * std::min(1., k / 10000.));
    REQUIRE(step(Exec(), state, bodies, basis, load, options) == -1);
  }
  const ExactColumn<double> exact{t, E};
  const auto p = read(block);
  double u = 0, sigma = 0;
  for (int k = 0; k < n; ++k) {
    const double x0 = (k + 0.5) * dx;
    u += std::pow((exact.displacement_as_printed(x0) - (p.position(k, 0) - x0)) / length, 2);
    sigma += std::pow((exact.stress() - p.cauchy_stress(k, 0)) / t, 2);
  }
  return {std::sqrt(u / n), std::sqrt(sigma / n)};
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("Algorithm 1 on a distorted grid marks the nodes that it marks on the uniform one", "",
                       ((int Dim), Dim), 1, 2, 3) {
  const Vector<3, int> cells{{9, 7, 6}};
  const auto grid = make_grid<Dim, double>(cells);
  const auto mesh = make_distorted_mesh<Dim, double>(0.14, cells);
  const auto on_host = make_distorted_mesh<Dim, double, Host>(0.14, cells);
  const LinearBasis<Dim, double> uniform{grid};
  const MappedLinearBasis<Dim, double> basis{mesh.grid};
  Random random(91);
  for (const double filled : {0.1, 0.5, 0.9, 0.97}) {
    std::vector<Vector<Dim, double>> straight, distorted;
    for_each_cell(grid, [&](const Vector<Dim, int>& cell) {
      if (cell[0] == 0 || random(0, 1) > filled) return;  // so that something is void
      Vector<Dim, double> xi, x;
      for (int i = 0; i < Dim; ++i) {
        xi[i] = random(0.01, 0.99);
        x[i] = grid.lower[i] + (cell[i] + xi[i]) * grid.spacing[i];
      }
      straight.push_back(x);
      distorted.push_back(position_in(on_host.grid, cell, xi));
    });
    const int n = static_cast<int>(straight.size());
    const auto mark = [&](const auto& on, const std::vector<Vector<Dim, double>>& positions) {
      const auto block = allocate_particles<Dim, double, Device>(n);
      edit(block, [&](const auto& particles) {
        for (int p = 0; p < n; ++p)
          for (int i = 0; i < Dim; ++i) particles.position(p, i) = positions[static_cast<size_t>(p)][i];
      });
      auto occupancy = allocate_occupancy<Device>(n, on);
      Kokkos::deep_copy(occupancy.tractions, 5u);
      REQUIRE(update_occupancy(Exec(), block.particles, occupancy, on) == -1);
      const auto marked = read(occupancy.boundary);
      return std::vector<TractionMask>(marked.data(), marked.data() + marked.extent(0));
    };
    const auto expected = mark(uniform, straight), got = mark(basis, distorted);
    CAPTURE(filled, n);
    CHECK(got == expected);
    CHECK(std::count(got.begin(), got.end(), 5u) > 0);
  }
}

TEMPLATE_TEST_CASE_SIG("on a distorted grid mass and momentum pass to the nodes and back without loss", "",
                       ((int Dim), Dim), 1, 2, 3) {
  const auto mesh = make_distorted_mesh<Dim, double>(0.14);
  const auto on_host = make_distorted_mesh<Dim, double, Host>(0.14);
  const MappedLinearBasis<Dim, double> basis{mesh.grid};
  const int n = 300;
  const auto block = random_particles_in(on_host.grid, n, 92);
  auto state = make_state(block.particles, basis);
  REQUIRE(update_occupancy(Exec(), state.particles, state.occupancy, basis) == -1);
  double mass = 0, momentum[Dim] = {};
  const auto particles = read(block);
  for (int p = 0; p < n; ++p) {
    mass += particles.mass(p);
    for (int i = 0; i < Dim; ++i) momentum[i] += particles.mass(p) * particles.velocity(p, i);
  }
  for (const Scatter strategy : {Scatter::gathered, Scatter::atomic}) {
    Vector<Dim, double> gravity;
    for (int i = 0; i < Dim; ++i) gravity[i] = 0.3 - 1.1 * i;
    particles_to_grid(Exec(), state.particles, state.occupancy.bins, state.nodes, state.occupancy.boundary,
                      state.sums_workspace.particles, basis, NoVirtualStress{}, gravity, strategy);
    remap_velocity(Exec(), state.particles, state.occupancy.bins, state.nodes, state.remap_workspace, basis,
                   strategy);
    const auto sums = read(state.nodes.sums), remapped = read(state.nodes.remapped_velocity);
    CHECK_THAT(column_sum(sums, 0), WithinAbs(mass, 1e-11));
    for (int i = 0; i < Dim; ++i) {
      CHECK_THAT(column_sum(sums, 1 + i), WithinAbs(momentum[i], 1e-11));
      // The stresses, of up to 10 Pa on gradients of up to 10 per metre, have no resultant.
      CHECK_THAT(column_sum(sums, 1 + Dim + i), WithinAbs(mass * gravity[i], 1e-9));
      double back = 0;
      for (int I = 0; I < basis.node_count(); ++I) back += sums(I, 0) * remapped(I, i);
      CHECK_THAT(back, WithinAbs(momentum[i], 1e-11));
    }
  }
}

TEMPLATE_TEST_CASE_SIG("patch test on a distorted grid: a stress equal to the virtual one leaves no force",
                       "", ((int Dim), Dim), 1, 2, 3) {
  const auto mesh = make_distorted_mesh<Dim, double>(0.14);
  const auto on_host = make_distorted_mesh<Dim, double, Host>(0.14);
  const MappedLinearBasis<Dim, double> basis{mesh.grid};
  const int n = 300;
  const auto block = random_particles_in(on_host.grid, n, 94);
  UniformVirtualStress<Dim, double> field;
  field.count = 1;
  Random random(95);
  for (int c = 0; c < SymmetricTensor<Dim, double>::size; ++c) field.stress[0][c] = random(-10, 10);
  const auto sums_with = [&](double factor) {
    edit(block, [&](const auto& particles) {
      for (int p = 0; p < n; ++p)
        for (int c = 0; c < particles.stress_size; ++c)
          particles.cauchy_stress(p, c) = factor * field.stress[0][c];
    });
    auto state = make_state(block.particles, basis);
    REQUIRE(update_occupancy(Exec(), state.particles, state.occupancy, basis) == -1);
    Kokkos::deep_copy(state.occupancy.boundary, 1u);
    particles_to_grid(Exec(), state.particles, state.occupancy.bins, state.nodes, state.occupancy.boundary,
                      state.sums_workspace.particles, basis, field, Vector<Dim, double>::zero(),
                      Scatter::gathered);
    return read(state.nodes.sums);
  };
  const auto balanced = sums_with(1), twice = sums_with(2);
  int forces = 0, felt = 0;
  for (int I = 0; I < basis.node_count(); ++I)
    for (int i = 0; i < Dim; ++i) {
      forces += balanced(I, 1 + Dim + i) != 0;
      felt += twice(I, 1 + Dim + i) != 0;
    }
  CHECK(forces == 0);
  CHECK(felt == Dim * basis.node_count());
}

TEMPLATE_TEST_CASE_SIG("a body in uniform motion through a distorted grid keeps its velocity and volume", "",
                       ((int Dim), Dim), 1, 2, 3) {
  const auto mesh = make_distorted_mesh<Dim, double>(0.14, {{9, 7, 6}});
  const MappedLinearBasis<Dim, double> basis{mesh.grid};
  const auto grid = make_grid<Dim, double>({{9, 7, 6}});
  const auto block = fill_cells<Dim, double>(grid, 2, 1., [](const auto& cell) {
    for (int i = 0; i < Dim; ++i)
      if (cell[i] < 1 || cell[i] > 3) return false;
    return true;
  });
  const int n = block.particles.count();
  edit(block, [&](const auto& particles) {
    for (int p = 0; p < n; ++p)
      for (int i = 0; i < Dim; ++i) particles.velocity(p, i) = 0.5 * grid.spacing[i] * (i == 0 ? 3 : 1);
  });
  const auto before = read(block);
  std::vector<double> start, volume;
  for (int p = 0; p < n; ++p) {
    volume.push_back(before.volume(p));
    for (int i = 0; i < Dim; ++i) start.push_back(before.position(p, i));
  }
  auto state = make_state(block.particles, basis);
  const std::vector<Body<double>> bodies{{0, n, LinearElastic<double>::from_young(1, 0.3)}};
  StepOptions<Dim, double> options;
  options.dt = 0.02;
  for (int k = 0; k < 100; ++k)  // three cells along x, one along the others
    REQUIRE(step(Exec(), state, bodies, basis, NoVirtualStress{}, options) == -1);
  REQUIRE(find_invalid(Exec(), block.particles).particle == -1);
  const auto after = read(block);
  for (int p = 0; p < n; ++p) {
    const auto k = static_cast<size_t>(p);
    CHECK_THAT(after.volume(p), WithinRel(volume[k], 1e-10));
    for (int i = 0; i < Dim; ++i)
      CHECK_THAT(after.position(p, i) - start[Dim * k + static_cast<size_t>(i)],
                 WithinAbs(grid.spacing[i] * (i == 0 ? 3 : 1), 1e-11));
  }
}

TEST_CASE("the column of Table 2 on its short, regular and long mesh") {
  std::vector<double> nodes;
  for (int i = 0; i <= 9; ++i) nodes.push_back(i);
  const auto with = [&](double a, double b) {
    auto all = nodes;
    all.push_back(a);
    all.push_back(b);
    return run_column(all);
  };
  const auto near = [](double value, double expected) { CHECK_THAT(value, WithinRel(expected, 0.01)); };
  const auto cut = with(9.5, 10.5);
  near(cut.u, 4.8270e-11);
  near(cut.sigma, 1.8587e-11);
  const auto regular = with(10, 11);
  near(regular.u, 5.4339e-11);
  near(regular.sigma, 1.8028e-11);
  const auto extended = with(10.5, 11.5);
  near(extended.u, 7.901e-11);
  near(extended.sigma, 1.8344e-11);
}
