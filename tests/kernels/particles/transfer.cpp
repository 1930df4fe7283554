// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Transfers between particles and nodes, whole kernels: what they conserve and what they reproduce exactly.

#include <common_steps.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

/// A state whose particles have been located, and the phases of a step on it.
template <int Dim, class Real>
struct Setup {
  ParticleBlock<Dim, Real, Device> block;
  LinearBasis<Dim, Real> basis;
  State<Dim, Real, Device> state;

  Setup(const ParticleBlock<Dim, Real, Device>& b, const UniformGrid<Dim, Real>& grid)
      : block(b), basis{grid}, state(make_state(b.particles, basis)) {
    REQUIRE(update_occupancy(Exec(), state.particles, state.occupancy, basis) == -1);
  }
  void to_grid(const Vector<Dim, Real>& gravity, Scatter strategy = Scatter::gathered) {
    particles_to_grid(Exec(), state.particles, state.occupancy.bins, state.nodes, state.occupancy.boundary,
                      state.sums_workspace.particles, basis, NoVirtualStress{}, gravity, strategy);
  }
  void remap(Scatter strategy = Scatter::gathered) {
    remap_velocity(Exec(), state.particles, state.occupancy.bins, state.nodes, state.remap_workspace, basis,
                   strategy);
  }
  double mass() const {
    const auto particles = read(block);
    double sum = 0;
    for (int p = 0; p < particles.count(); ++p) sum += static_cast<double>(particles.mass(p));
    return sum;
  }
  double momentum(int i) const {
    const auto particles = read(block);
    double sum = 0;
    for (int p = 0; p < particles.count(); ++p)
      sum += static_cast<double>(particles.mass(p)) * static_cast<double>(particles.velocity(p, i));
    return sum;
  }
};

/// sum_I m_I v*_I.
template <int Dim, class Real>
double remapped_momentum(const Nodes<Dim, Real, Device>& nodes, int i) {
  const auto sums = read(nodes.sums), v = read(nodes.remapped_velocity);
  double sum = 0;
  for (int I = 0; I < nodes.count(); ++I)
    sum += static_cast<double>(sums(I, 0)) * static_cast<double>(v(I, i));
  return sum;
}

template <int Dim, class Real>
Vector<Dim, Real> some_vector() {
  Vector<Dim, Real> v;
  for (int i = 0; i < Dim; ++i) v[i] = static_cast<Real>(0.3 - 1.1 * i);
  return v;
}

/// A material that reports one row of the velocity gradient as its stress.
template <int Row>
struct ReportGradient {
  template <int Dim>
  KOKKOS_FUNCTION static constexpr int state_size() {
    return 0;
  }
  template <int Dim, class T>
  KOKKOS_FUNCTION SymmetricTensor<Dim, T> advance(const SymmetricTensor<Dim, T>&, const Matrix<Dim, T>& L,
                                                  T) const {
    auto s = SymmetricTensor<Dim, T>::zero();
    for (int j = 0; j < Dim; ++j) s[j] = L(Row, j);
    return s;
  }
};

const int count = 300;

}  // namespace

TEMPLATE_TEST_CASE_SIG("mass, momentum and force pass between particles and nodes without loss", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (3, float)) {
  const auto grid = make_grid<Dim, Real>();
  Setup<Dim, Real> setup(random_particles(grid, count, 31), grid);
  // A sum of n terms is off by at most n epsilon times the sum of their magnitudes: masses and momenta near
  // 1, and V |sigma| |dN| up to 1.5 10 sqrt(3) 4 at each support node. The partition of unity cancels the
  // stresses.
  const double round_off = count * count * epsilon<Real>;
  const double force_round_off = 100 * setup.basis.support * round_off;
  const auto gravity = some_vector<Dim, Real>();
  const double mass = setup.mass();
  double before[Dim];
  for (int i = 0; i < Dim; ++i) before[i] = setup.momentum(i);
  for (const Scatter strategy : {Scatter::gathered, Scatter::atomic}) {
    setup.to_grid(gravity, strategy);
    const auto& sums = setup.state.nodes.sums;
    CHECK_THAT(column_sum(sums, 0), WithinAbs(mass, round_off));
    for (int i = 0; i < Dim; ++i) {
      CHECK_THAT(column_sum(sums, 1 + i), WithinAbs(before[i], round_off));
      CHECK_THAT(column_sum(sums, 1 + Dim + i),
                 WithinAbs(mass * static_cast<double>(gravity[i]), force_round_off));
    }
  }

  // With any share of PIC the momentum changes by dt times the total force; the re-map keeps it.
  const Real dt = Real(0.01), pic = GENERATE(Real(0), Real(0.25));
  update_nodes(Exec(), setup.state.nodes, setup.basis, Real(0), dt);
  grid_to_particles(Exec(), setup.state.particles, setup.state.nodes, setup.basis, pic, dt);
  setup.remap();
  for (int i = 0; i < Dim; ++i) {
    const double after = setup.momentum(i);
    CHECK_THAT(after - before[i], WithinAbs(static_cast<double>(dt) * mass * static_cast<double>(gravity[i]),
                                            round_off + static_cast<double>(dt) * force_round_off));
    CHECK_THAT(remapped_momentum(setup.state.nodes, i), WithinAbs(after, round_off));
  }
}

TEMPLATE_TEST_CASE_SIG("a rigid translation stays one", "", ((int Dim, typename Real), Dim, Real),
                       (1, double), (2, double), (3, double), (3, float)) {
  const auto grid = make_grid<Dim, Real>({{6, 6, 6}});
  const auto inner = [](const Vector<Dim, int>& cell) {
    bool in = true;
    for (int i = 0; i < Dim; ++i) in = in && cell[i] >= 2 && cell[i] < 4;
    return in;
  };
  const auto block = fill_cells<Dim, Real>(grid, 3, Real(2), inner);
  const auto c = some_vector<Dim, Real>();
  edit(block, [&](const auto& particles) {
    for (int p = 0; p < particles.count(); ++p)
      for (int i = 0; i < Dim; ++i) particles.velocity(p, i) = c[i];
  });
  Setup<Dim, Real> setup(block, grid);
  auto& state = setup.state;
  std::vector<Vector<Dim, Real>> x0;
  const auto initial = read(block);
  for (int p = 0; p < initial.count(); ++p) x0.push_back(initial.position_of(p));
  const double volume = static_cast<double>(initial.volume(0));

  const std::vector<Body<Real>> bodies{
      {0, block.particles.count(), LinearElastic<Real>::from_young(100, 0.3)}};
  StepOptions<Dim, Real> options;
  options.dt = Real(0.01);
  const int steps = 40;  // over cell boundaries: 0.4 s at up to 1.9 m/s, cells of 0.25 m and more
  for (int n = 0; n < steps; ++n)
    REQUIRE(step(Exec(), state, bodies, setup.basis, NoVirtualStress{}, options) == -1);

  const auto particles = read(block);
  double worst_position = 0, worst_velocity = 0, worst_stress = 0, worst_volume = 0;
  for (int p = 0; p < particles.count(); ++p) {
    for (int i = 0; i < Dim; ++i) {
      const double moved =
          static_cast<double>(particles.position(p, i)) - static_cast<double>(x0[static_cast<size_t>(p)][i]);
      worst_position = std::max(worst_position, std::abs(moved - steps * 0.01 * static_cast<double>(c[i])));
      worst_velocity =
          std::max(worst_velocity, std::abs(static_cast<double>(particles.velocity(p, i) - c[i])));
    }
    for (int k = 0; k < particles.stress_size; ++k)
      worst_stress = std::max(worst_stress, std::abs(static_cast<double>(particles.cauchy_stress(p, k))));
    worst_volume = std::max(worst_volume, std::abs(static_cast<double>(particles.volume(p)) / volume - 1));
  }
  const double round_off = 200 * steps * epsilon<Real>;
  CHECK(worst_position < round_off);
  CHECK(worst_velocity < round_off);
  CHECK(worst_stress < 100 * round_off);
  CHECK(worst_volume < round_off);
}

TEMPLATE_TEST_CASE_SIG("a linear velocity field is seen exactly by every particle", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (3, float)) {
  const auto grid = make_grid<Dim, Real>();
  Setup<Dim, Real> setup(random_particles(grid, count, 33), grid);
  const double A[3][3] = {{1, 2, 3}, {-4, 5, -6}, {7, 8, 10}};
  const auto field = [&](const Vector<Dim, Real>& x, int i) {
    double v = 0.5;
    for (int j = 0; j < Dim; ++j) v += A[i][j] * static_cast<double>(x[j]);
    return v;
  };
  const auto& nodes = setup.state.nodes;
  const typename Nodes<Dim, Real, Device>::Fields velocities[] = {nodes.velocity, nodes.remapped_velocity};
  for (const auto& view : velocities)
    edit(view, [&](const auto& host) {
      for (int I = 0; I < grid.node_count(); ++I)
        for (int i = 0; i < Dim; ++i) host(I, i) = static_cast<Real>(field(grid.node_position(I), i));
    });
  std::vector<Vector<Dim, Real>> x0;
  std::vector<double> V0;
  const auto initial = read(setup.block);
  for (int p = 0; p < count; ++p) {
    x0.push_back(initial.position_of(p));
    V0.push_back(static_cast<double>(initial.volume(p)));
  }
  const Real dt = Real(0.125);
  using Functor = kernel::UpdateStress<LinearBasis<Dim, Real>, ReportGradient<Dim - 1>, ExponentialVolume,
                                       Dim, Real, Device>;
  Kokkos::parallel_for(
      "vsb::test", Kokkos::RangePolicy<Exec>(0, count),
      Functor{setup.state.particles, setup.state.nodes, setup.basis, {}, {}, PositionVelocity::strain, dt});
  const auto particles = read(setup.block);
  double trace = 0, worst_L = 0, worst_x = 0, worst_V = 0;
  for (int i = 0; i < Dim; ++i) trace += A[i][i];
  for (int p = 0; p < count; ++p) {
    const auto& x = x0[static_cast<size_t>(p)];
    for (int j = 0; j < Dim; ++j) {
      worst_L =
          std::max(worst_L, std::abs(static_cast<double>(particles.cauchy_stress(p, j)) - A[Dim - 1][j]));
      const double moved = static_cast<double>(x[j]) + 0.125 * field(x, j);
      worst_x = std::max(worst_x, std::abs(static_cast<double>(particles.position(p, j)) - moved));
    }
    const double V = V0[static_cast<size_t>(p)] * std::exp(0.125 * trace);
    worst_V = std::max(worst_V, std::abs(static_cast<double>(particles.volume(p)) / V - 1));
  }
  CHECK(worst_L < 1000 * epsilon<Real>);  // nodal values near 50, gradients of N up to 4 per metre
  CHECK(worst_x < 100 * epsilon<Real>);
  CHECK(worst_V < 1000 * epsilon<Real>);
}

TEST_CASE("prescribed components stay at rest through a step, and move no particle") {
  const auto grid = make_grid<2, double>();
  Setup<2, double> setup(random_particles(grid, count, 34), grid);
  edit(setup.state.nodes.fixed_components, [&](const auto& host) {
    for (int I = 0; I < grid.node_count(); ++I) host(I) = 2;  // y, everywhere
  });
  edit(setup.block, [](const auto& particles) {
    for (int p = 0; p < count; ++p) particles.velocity(p, 1) = 0;
  });
  std::vector<double> y0;
  const auto initial = read(setup.block);
  for (int p = 0; p < count; ++p) y0.push_back(initial.position(p, 1));
  const std::vector<Body<double>> bodies{{0, count, LinearElastic<double>::from_young(1, 0.3)}};
  StepOptions<2, double> options;
  options.dt = 1e-4;
  options.gravity = {{0, -9.81}};
  REQUIRE(step(Exec(), setup.state, bodies, setup.basis, NoVirtualStress{}, options) == -1);
  const auto particles = read(setup.block);
  const auto a = read(setup.state.nodes.acceleration), v = read(setup.state.nodes.velocity),
             w = read(setup.state.nodes.remapped_velocity);
  int moved = 0, sideways = 0;
  for (int p = 0; p < count; ++p) {
    moved += particles.velocity(p, 1) != 0 || particles.position(p, 1) != y0[static_cast<size_t>(p)];
    sideways += particles.velocity(p, 0) != 0;
  }
  for (int I = 0; I < grid.node_count(); ++I) moved += a(I, 1) != 0 || v(I, 1) != 0 || w(I, 1) != 0;
  CHECK(moved == 0);
  CHECK(sideways == count);
}

TEST_CASE("the re-map gives fixed nodes no velocity, whatever the particles do") {
  const auto grid = make_grid<2, double>();
  Setup<2, double> setup(random_particles(grid, count, 35), grid);
  edit(setup.state.nodes.fixed_components, [&](const auto& host) {
    for (int I = 0; I < grid.node_count(); ++I) host(I) = static_cast<ComponentMask>(I % 4);
  });
  setup.to_grid({{0, 0}});
  setup.remap();
  const auto v = read(setup.state.nodes.remapped_velocity);
  for (int I = 0; I < grid.node_count(); ++I)
    for (int i = 0; i < 2; ++i) CHECK((v(I, i) == 0) == bool(I % 4 >> i & 1));
}

TEST_CASE("bodies keep to their particles and their materials") {
  const UniformGrid<1, double> grid({{0}}, {{1}}, {{1}});
  const auto block = allocate_particles<1, double, Device>(5);
  edit(block, [](const auto& particles) {
    for (int p = 0; p < 5; ++p) {
      particles.position(p, 0) = 0.5;
      particles.mass(p) = particles.volume(p) = 1;
    }
  });
  Setup<1, double> setup(block, grid);
  edit(setup.state.nodes.remapped_velocity, [](const auto& host) { host(1, 0) = 1; });  // L = 1
  const std::vector<Body<double>> bodies{{1, 3, LinearElastic<double>{0, 50}},
                                         {3, 4, LinearElastic<double>{0, 500}}};
  update_stress(Exec(), setup.state.particles, setup.state.nodes, bodies, setup.basis, DeterminantVolume{},
                PositionVelocity::strain, 0.5);
  const auto particles = read(block);
  const double stress[] = {0, 50, 50, 500, 0}, volume[] = {1, 1.5, 1.5, 1.5, 1};
  for (int p = 0; p < 5; ++p) {
    CHECK(particles.cauchy_stress(p, 0) == stress[p]);
    CHECK(particles.volume(p) == volume[p]);
  }
  update_stress(Exec(), setup.state.particles, setup.state.nodes, bodies, setup.basis, ExponentialVolume{},
                PositionVelocity::strain, 0.5);
  CHECK_THAT(read(block).volume(1), WithinRel(1.5 * std::exp(0.5), 1e-15));
}
