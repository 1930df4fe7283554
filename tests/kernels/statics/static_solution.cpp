// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The stiffness of particles, the static solution, and the search for loads without support, against closed
/// forms.
#include <algorithm>
#include <common_steps.hpp>
#include <vsb/kernels/statics/static_solution.hpp>
#include <vsb/kernels/statics/unsupported_load.hpp>

#include "support.hpp"
#include "wide_bases.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

template <int Dim>
using Fields = typename Nodes<Dim, double, Device>::Fields;

template <int Dim>
Fields<Dim> nodal_vectors(int nodes) {
  return Fields<Dim>("vsb::test_vectors", static_cast<size_t>(nodes), Dim);
}

double product(const Fields<1>& a, const Fields<1>& b) {  // Fields<Dim> is the same type for every Dim
  const auto x = read(a), y = read(b);
  double sum = 0;
  for (size_t I = 0; I < x.extent(0); ++I)
    for (size_t i = 0; i < x.extent(1); ++i) sum += x(I, i) * y(I, i);
  return sum;
}

/// u_I = t + A x_I.
template <int Dim, class Basis>
Fields<Dim> affine_displacement(const Basis& basis, const Vector<Dim, double>& t,
                                const Matrix<Dim, double>& A) {
  const auto u = nodal_vectors<Dim>(basis.node_count());
  edit(u, [&](const auto& host) {
    for (int I = 0; I < basis.node_count(); ++I) {
      const auto value = t + A * basis.grid.node_position(I);
      for (int i = 0; i < Dim; ++i) host(I, i) = value[i];
    }
  });
  return u;
}

/// Random particles of two materials: half of them ten times as stiff.
template <int Dim, class Basis>
struct TwoBodies {
  Basis basis;
  ParticleBlock<Dim, double, Device> block;
  State<Dim, double, Device> state;
  std::vector<Body<double>> bodies;
  static constexpr int count = 150;

  explicit TwoBodies(const Basis& b, unsigned seed)
      : basis(b), block(allocate_particles<Dim, double, Device>(count)) {
    Random random(seed);
    const auto grid = make_grid<Dim, double>();
    edit(block, [&](const auto& particles) {
      for (int p = 0; p < count; ++p) {
        // Inside of every mesh with the outer nodes moved by less than a tenth of a cell.
        for (int i = 0; i < Dim; ++i)
          particles.position(p, i) = grid.lower[i] + grid.spacing[i] * random(0.2, grid.cells[i] - 0.2);
        particles.mass(p) = random(0.5, 1.5);
        particles.volume(p) = random(0.5, 1.5);
      }
    });
    state = make_state(block.particles, basis);
    bodies = {{0, count / 2, LinearElastic<double>::from_young(10, 0.2)},
              {count / 2, count, LinearElastic<double>::from_young(100, 0.4)}};
    REQUIRE(update_occupancy(Exec(), block.particles, state.occupancy, basis) == -1);
  }
  Stiffness<Basis, Dim, double, Device> stiffness(Scatter strategy = Scatter::gathered,
                                                  Volumetric volumetric = Volumetric::full) const {
    return {block.particles, bodies, basis, state.occupancy.bins, strategy, volumetric};
  }
};

/// sum V (lambda (tr eps)^2 + 2 mu eps : eps), twice the energy of a uniform strain.
template <int Dim, class Basis>
double uniform_strain_energy(const TwoBodies<Dim, Basis>& two, const Matrix<Dim, double>& A) {
  double trace_of = 0, square = 0;
  for (int i = 0; i < Dim; ++i) {
    trace_of += A(i, i);
    for (int j = 0; j < Dim; ++j) square += 0.25 * (A(i, j) + A(j, i)) * (A(i, j) + A(j, i));
  }
  const auto particles = read(two.block);
  double energy = 0;
  for (int p = 0; p < two.count; ++p) {
    const double E = p < two.count / 2 ? 10 : 100, nu = p < two.count / 2 ? 0.2 : 0.4;
    const double lambda = E * nu / ((1 + nu) * (1 - 2 * nu)), mu = E / (2 * (1 + nu));
    energy += particles.volume(p) * (lambda * trace_of * trace_of + 2 * mu * square);
  }
  return energy;
}

template <int Dim>
Matrix<Dim, double> random_matrix(Random& random) {
  Matrix<Dim, double> A;
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) A(i, j) = random(-1, 1);
  return A;
}

/// `on_host` is the basis for work on the host.
template <int Dim, class Basis>
void check_stiffness(const Basis& basis, const Basis& on_host, Volumetric volumetric) {
  const TwoBodies<Dim, Basis> two(basis, 91);
  auto K = two.stiffness(Scatter::gathered, volumetric);
  const int nodes = basis.node_count();
  const auto u = nodal_vectors<Dim>(nodes), v = nodal_vectors<Dim>(nodes), Ku = nodal_vectors<Dim>(nodes),
             Kv = nodal_vectors<Dim>(nodes);
  Random random(92);
  for (int trial = 0; trial < 20; ++trial) {
    const typename Nodes<Dim, double, Device>::Fields both[] = {u, v};
    for (const auto& vectors : both)
      edit(vectors, [&](const auto& host) {
        for (int I = 0; I < nodes; ++I)
          for (int i = 0; i < Dim; ++i) host(I, i) = random(-1, 1);
      });
    K.apply(Exec(), u, Ku);
    K.apply(Exec(), v, Kv);
    const double uKu = product(u, Ku), vKv = product(v, Kv);
    CHECK(uKu > 0);
    CHECK_THAT(product(u, Kv), WithinAbs(product(v, Ku), 1e-13 * std::sqrt(uKu * vKv)));
  }
  // The energy of a uniform strain, and none of a rigid motion.
  const auto A = random_matrix<Dim>(random);
  auto spin = A;
  Vector<Dim, double> t;
  for (int i = 0; i < Dim; ++i) {
    t[i] = random(-1, 1);
    for (int j = 0; j < Dim; ++j) spin(i, j) = 0.5 * (A(i, j) - A(j, i));
  }
  const auto strained = affine_displacement<Dim>(on_host, t, A),
             turned = affine_displacement<Dim>(on_host, t, spin);
  K.apply(Exec(), strained, Ku);
  const double energy = uniform_strain_energy(two, A);
  CHECK_THAT(product(strained, Ku), WithinRel(energy, 1e-12));
  K.apply(Exec(), turned, Ku);
  CHECK(std::sqrt(product(Ku, Ku)) < 1e-11 * energy);
}

/// Rows of the box of cells x < cells[0] - 2 of a grid with two void cells beyond.
template <int Dim>
UniformGrid<Dim, double> column_grid(const Vector<3, int>& cells, double h) {
  Vector<Dim, double> lower, spacing;
  Vector<Dim, int> count;
  for (int i = 0; i < Dim; ++i) lower[i] = 0, spacing[i] = h, count[i] = cells[i];
  return {lower, spacing, count};
}

const auto never_stop = [](int, double) { return true; };

/// A body with everything that a static solution needs.
template <int Dim, class Basis>
struct Problem {
  Basis basis;
  ParticleBlock<Dim, double, Device> block;
  State<Dim, double, Device> state;
  std::vector<Body<double>> bodies;
  UniformVirtualStress<Dim, double> load;
  Vector<Dim, double> gravity = Vector<Dim, double>::zero();
  Fields<Dim> u;

  Problem(const Basis& b, const ParticleBlock<Dim, double, Device>& particles, LinearElastic<double> material)
      : basis(b),
        block(particles),
        state(make_state(particles.particles, b)),
        bodies{{0, particles.particles.count(), material}},
        u(nodal_vectors<Dim>(b.node_count())) {
    load.count = 1;
    load.stress[0] = SymmetricTensor<Dim, double>::zero();
    Kokkos::deep_copy(state.occupancy.tractions, 1u);
  }
  /// Bit i of fixed(node coordinates) fixes component i.
  template <class Fixed>
  void fix(const Fixed& fixed) {
    edit(state.nodes.fixed_components, [&](const auto& host) {
      for (int I = 0; I < basis.node_count(); ++I)
        host(I) = static_cast<ComponentMask>(fixed(basis.grid.node_ijk(I)));
    });
  }
  void assemble() {
    REQUIRE(update_occupancy(Exec(), state.particles, state.occupancy, basis) == -1);
    REQUIRE(assemble_forces(Exec(), state.particles, state.occupancy, state.surface, state.nodes,
                            state.sums_workspace, basis, load, gravity, Scatter::gathered) == -1);
  }
  UnsupportedLoad<Dim> unsupported(double tolerance = 1e-10) {
    assemble();
    return find_unsupported_load(Exec(), state.nodes, state.occupancy.bins, basis, tolerance);
  }
  StaticResult solve(const StaticOptions& options = {}) {
    assemble();
    Stiffness<Basis, Dim, double, Device> K(state.particles, bodies, basis, state.occupancy.bins,
                                            Scatter::gathered);
    return solve_displacement(Exec(), K, state.nodes, u, options, never_stop);
  }
  double strain() { return strain_particles(Exec(), state.particles, bodies, basis, u); }
};

/// A column along x of `full` cells, fixed at its foot between rollers.
template <int Dim>
Problem<Dim, LinearBasis<Dim, double>> column(int full, double h, LinearElastic<double> material) {
  const auto grid = column_grid<Dim>({{full + 2, 1, 1}}, h);
  const auto block = fill_cells<Dim, double>(grid, 2, 3., [&](const auto& cell) { return cell[0] < full; });
  Problem<Dim, LinearBasis<Dim, double>> problem({grid}, block, material);
  problem.fix([](const auto& ijk) { return (ijk[0] == 0 ? 1 : 0) | 6; });
  return problem;
}

/// A body of some cells of a 2D grid of 8 x 8 cells of 1 m, two particles per direction.
template <class Filled>
Problem<2, LinearBasis<2, double>> plate(const Filled& filled) {
  const auto grid = column_grid<2>({{8, 8, 1}}, 1);
  return {LinearBasis<2, double>{grid}, fill_cells<2, double>(grid, 2, 1., filled),
          LinearElastic<double>::from_young(1000, 0.3)};
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("the stiffness is symmetric, positive, and right for uniform strains", "",
                       ((int Dim), Dim), 1, 2, 3) {
  const LinearBasis<Dim, double> uniform{make_grid<Dim, double>()};
  const auto splines = WideBasis<QuadraticBSplineBasis<Dim, double>>::on(make_grid<Dim, double>());
  const auto mesh = make_distorted_mesh<Dim, double>(0.1);
  const auto on_host = make_distorted_mesh<Dim, double, Host>(0.1);
  // With the mean divergence, too: both bodies are in all cells, and each has a mean of its own.
  for (const auto volumetric : {Volumetric::full, Volumetric::averaged}) {
    check_stiffness<Dim>(uniform, uniform, volumetric);
    check_stiffness<Dim>(splines, splines, volumetric);
    check_stiffness<Dim>(MappedLinearBasis<Dim, double>{mesh.grid},
                         MappedLinearBasis<Dim, double>{on_host.grid}, volumetric);
  }
}

TEMPLATE_TEST_CASE_SIG("the blocks on the diagonal are those of the stiffness", "", ((int Dim), Dim), 1, 2,
                       3) {
  const LinearBasis<Dim, double> basis{make_grid<Dim, double>()};
  const TwoBodies<Dim, LinearBasis<Dim, double>> two(basis, 93);
  const int nodes = basis.node_count();
  const Fields<Dim> block("vsb::test_blocks", static_cast<size_t>(nodes), Dim * Dim);
  for (const Scatter strategy : {Scatter::gathered, Scatter::atomic}) {
    auto K = two.stiffness(strategy);
    K.diagonal_blocks(Exec(), block);
    const auto blocks = read(block);
    const auto u = nodal_vectors<Dim>(nodes), Ku = nodal_vectors<Dim>(nodes);
    for (int I = 0; I < nodes; I += 5)
      for (int j = 0; j < Dim; ++j) {
        Kokkos::deep_copy(u, 0.);
        edit(u, [&](const auto& host) { host(I, j) = 1; });
        K.apply(Exec(), u, Ku);
        const auto column = read(Ku);
        for (int i = 0; i < Dim; ++i)
          CHECK_THAT(blocks(I, i * Dim + j), WithinAbs(column(I, i), 1e-13 * blocks(I, 0)));
      }
  }
}

TEMPLATE_TEST_CASE_SIG("a pressed column between rollers: sigma = -p, u = -p x / M", "", ((int Dim), Dim), 1,
                       2, 3) {
  const double p = 2, h = 0.5, nu = 0.3;
  const auto material = LinearElastic<double>::from_young(1000, nu);
  const double M = 1000 * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
  auto problem = column<Dim>(6, h, material);
  problem.load.stress[0][0] = -p;
  const auto before = Kokkos::create_mirror(Kokkos::HostSpace(), problem.block.block);  // not the same memory
  Kokkos::deep_copy(before, problem.block.block);
  const auto x0 = [&](int k, int i) { return before(k, i); };
  const auto result = problem.solve();
  CHECK(result.converged);
  CHECK(result.residual <= 1e-10);
  CHECK_THAT(problem.strain(), WithinRel(p / M, 1e-9));
  displace_particles(Exec(), problem.state.particles, problem.basis, problem.u);
  const auto after = read(problem.block);
  for (int k = 0; k < after.count(); ++k) {
    CHECK_THAT(after.cauchy_stress(k, 0), WithinRel(-p, 1e-9));
    CHECK_THAT(after.cauchy_stress(k, 1), WithinRel(-p * nu / (1 - nu), 1e-9));
    CHECK_THAT(after.position(k, 0) - x0(k, 0), WithinRel(-p * x0(k, 0) / M, 1e-9));
    CHECK(after.volume(k) == std::pow(0.5 * h, Dim));
    for (int i = 1; i < Dim; ++i) CHECK(after.position(k, i) == x0(k, i));
  }
}

TEST_CASE("a bar under its own weight has the exact displacements at its nodes") {
  const double g = 9.81, rho = 3, h = 0.25, L = 5 * h;
  const auto material = LinearElastic<double>::from_young(1e4, 0);
  auto bar = column<1>(5, h, material);
  bar.gravity = {{g}};  // hanging from the fixed end: u = rho g / E (L x - x^2 / 2)
  REQUIRE(bar.solve().converged);
  const auto u = read(bar.u);
  for (int I = 0; I <= 5; ++I) {
    const double x = I * h;
    CHECK_THAT(u(I, 0), WithinAbs(rho * g / 1e4 * (L * x - 0.5 * x * x), 1e-12 * rho * g * L * L / 1e4));
  }
  CHECK(u(6, 0) == 0);  // no mass
}

TEST_CASE("two bodies in series strain by their own moduli") {
  auto bar = column<1>(6, 1, LinearElastic<double>::from_young(100, 0));
  bar.bodies = {{0, 4, LinearElastic<double>::from_young(100, 0)},
                {4, 12, LinearElastic<double>::from_young(400, 0)}};
  bar.load.stress[0][0] = 3;
  REQUIRE(bar.solve().converged);
  const auto u = read(bar.u);
  CHECK_THAT(u(2, 0), WithinRel(3 * 2 / 100., 1e-9));
  CHECK_THAT(u(6, 0), WithinRel(3 * 2 / 100. + 3 * 4 / 400., 1e-9));
  CHECK_THAT(bar.strain(), WithinRel(3 / 100., 1e-9));
}

TEST_CASE("an initial stress that carries the load leaves nothing to solve") {
  auto bar = column<1>(6, 1, LinearElastic<double>::from_young(100, 0));
  bar.load.stress[0][0] = 3;
  edit(bar.block, [](const auto& particles) {
    for (int k = 0; k < particles.count(); ++k) particles.cauchy_stress(k, 0) = 3;
  });
  const auto result = bar.solve();
  CHECK(result.converged);
  CHECK(result.iterations == 0);
  CHECK(bar.strain() == 0);
  // Half of it leaves half of the strain.
  edit(bar.block, [](const auto& particles) {
    for (int k = 0; k < particles.count(); ++k) particles.cauchy_stress(k, 0) = 1.5;
  });
  REQUIRE(bar.solve().converged);
  CHECK_THAT(bar.strain(), WithinRel(0.015, 1e-9));
  const auto particles = read(bar.block);
  for (int k = 0; k < particles.count(); ++k) CHECK_THAT(particles.cauchy_stress(k, 0), WithinRel(3., 1e-9));
}

TEMPLATE_TEST_CASE_SIG("patch test: a free body of any cells takes the stress on its surface", "",
                       ((int Dim), Dim), 1, 2, 3) {
  const auto grid = column_grid<Dim>({{8, 8, 7}}, 0.5);
  Random random(94);
  // A box of cells with a hole and a rough side.
  const auto block = fill_cells<Dim, double>(grid, 2, 1., [&](const auto& cell) {
    bool hole = Dim > 1;
    for (int i = 0; i < Dim; ++i) {
      if (cell[i] < 1 || cell[i] > 5) return false;
      hole = hole && cell[i] == 3;
    }
    return !hole && (cell[0] < 5 || Dim == 1 || random(0, 1) < 0.5);
  });
  Problem<Dim, LinearBasis<Dim, double>> body({grid}, block, LinearElastic<double>::from_young(1000, 0.3));
  const double stress[6] = {-3, 2, 0.9, 0.7, -0.4, 0.5};
  for (int i = 0; i < Dim; ++i)
    for (int j = i; j < Dim; ++j) body.load.stress[0][symmetric_index(i, j)] = stress[symmetric_index(i, j)];
  CHECK_FALSE(body.unsupported().found);
  REQUIRE(body.solve().converged);
  body.strain();
  const auto particles = read(body.block);
  for (int k = 0; k < particles.count(); ++k)
    for (int i = 0; i < Dim; ++i)
      for (int j = i; j < Dim; ++j)
        CHECK_THAT(particles.cauchy_stress(k, symmetric_index(i, j)),
                   WithinAbs(stress[symmetric_index(i, j)], 3e-8));
}

TEST_CASE("patch test on a distorted mesh") {
  // The midpoints of the halves integrate J^-T det J, bilinear in 2D, exactly.
  const auto mesh = make_distorted_mesh<2, double>(0.15, {{7, 6, 1}});
  const auto on_host = make_distorted_mesh<2, double, Host>(0.15, {{7, 6, 1}});
  const auto& grid = on_host.grid;
  std::vector<Vector<2, double>> positions;
  std::vector<double> volumes;
  for_each_cell(grid, [&](const auto& cell) {
    if (cell[0] < 1 || cell[0] > 5 || cell[1] < 1 || cell[1] > 4) return;
    for (const double xi : {0.25, 0.75})
      for (const double eta : {0.25, 0.75}) {
        Vector<2, double> x = {{0, 0}}, dxi = x, deta = x;
        for (int a = 0; a < 4; ++a) {
          const auto corner =
              grid.node_position(grid.node_index(Vector<2, int>{{cell[0] + (a & 1), cell[1] + (a >> 1)}}));
          const double s = a & 1 ? xi : 1 - xi, t = a >> 1 ? eta : 1 - eta;
          x += s * t * corner;
          dxi += (a & 1 ? t : -t) * corner;
          deta += (a >> 1 ? s : -s) * corner;
        }
        positions.push_back(x);
        volumes.push_back(0.25 * (dxi[0] * deta[1] - dxi[1] * deta[0]));
      }
  });
  const auto block = allocate_particles<2, double, Device>(static_cast<int>(positions.size()));
  edit(block, [&](const auto& particles) {
    for (int k = 0; k < particles.count(); ++k) {
      const auto n = static_cast<size_t>(k);
      for (int i = 0; i < 2; ++i) particles.position(k, i) = positions[n][i];
      particles.mass(k) = particles.volume(k) = volumes[n];
    }
  });
  Problem<2, MappedLinearBasis<2, double>> body({mesh.grid}, block,
                                                LinearElastic<double>::from_young(1000, 0.3));
  body.load.stress[0] = {{-3, 2, 0, 0.7}};
  CHECK_FALSE(body.unsupported().found);
  REQUIRE(body.solve().converged);
  body.strain();
  const auto particles = read(body.block);
  for (int k = 0; k < particles.count(); ++k)
    for (const auto& [c, value] : {std::pair(0, -3.), std::pair(1, 2.), std::pair(3, 0.7)})
      CHECK_THAT(particles.cauchy_stress(k, c), WithinAbs(value, 3e-8));
}

TEST_CASE("a solution ends where it is told to") {
  auto bar = column<1>(40, 1, LinearElastic<double>::from_young(100, 0));
  bar.gravity = {{1}};
  StaticOptions options;
  options.max_iterations = 3;
  const auto short_of = bar.solve(options);
  CHECK_FALSE(short_of.converged);
  CHECK(short_of.iterations == 3);
  CHECK(short_of.residual > options.residual);

  bar.assemble();
  Stiffness<LinearBasis<1, double>, 1, double, Device> K(bar.state.particles, bar.bodies, bar.basis,
                                                         bar.state.occupancy.bins, Scatter::gathered);
  int calls = 0;
  const auto stopped =
      solve_displacement(Exec(), K, bar.state.nodes, bar.u, StaticOptions{}, [&](int n, double r) {
        CHECK(n == calls++);
        CHECK(r <= 1e3);
        return n < 5;
      });
  CHECK_FALSE(stopped.converged);
  CHECK(stopped.iterations == 5);

  options.max_iterations = 1000;
  options.residual = 1e-4;
  const auto coarse = bar.solve(options);
  CHECK(coarse.converged);
  options.residual = 1e-13;
  CHECK(bar.solve(options).iterations >= coarse.iterations);
}

TEST_CASE("forces on a motion without strain have no static state") {
  // One particle in the middle of a cell between rollers in x: nodes that move along y by turns strain
  // nothing.
  const auto grid = column_grid<2>({{2, 2, 1}}, 1);
  const auto block =
      fill_cells<2, double>(grid, 1, 1., [](const auto& cell) { return cell[0] == 0 && cell[1] == 0; });
  Problem<2, LinearBasis<2, double>> body({grid}, block, LinearElastic<double>::from_young(1000, 0.3));
  body.fix([](const auto& ijk) { return ijk[1] == 0 && ijk[0] == 0 ? 3 : 1; });
  body.assemble();
  edit(body.state.nodes.sums, [&](const auto& sums) {
    for (const int I : {0, 1, 3, 4}) sums(I, 4) = I == 0 || I == 4 ? 1 : -1;
  });
  Stiffness<LinearBasis<2, double>, 2, double, Device> K(body.state.particles, body.bodies, body.basis,
                                                         body.state.occupancy.bins, Scatter::gathered);
  CHECK_FALSE(solve_displacement(Exec(), K, body.state.nodes, body.u, StaticOptions{}, never_stop).converged);
}

TEST_CASE("a load without support is found, with what is missing") {
  const auto box = [](const auto& cell) { return cell[0] > 1 && cell[0] < 5 && cell[1] > 1 && cell[1] < 5; };
  auto body = plate(box);  // nodes 2, ..., 5 in both directions, 9 m^2, middle (3.5, 3.5)
  body.gravity = {{0, -10}};
  const auto falling = body.unsupported();
  REQUIRE(falling.found);
  CHECK_THAT(falling.force[0], WithinAbs(0, 1e-12));
  CHECK_THAT(falling.force[1], WithinRel(-90., 1e-12));
  CHECK_THAT(falling.torque[2], WithinAbs(0, 1e-11));
  for (int i = 0; i < 2; ++i) CHECK_THAT(falling.middle[i], WithinRel(3.5, 1e-12));
  CHECK_THAT(falling.share, WithinRel(1., 1e-12));

  // A roller along the lower edge holds it; one along the left edge does not.
  body.fix([](const auto& ijk) { return ijk[1] == 2 ? 2 : 0; });
  CHECK_FALSE(body.unsupported().found);
  body.fix([](const auto& ijk) { return ijk[0] == 2 ? 1 : 0; });
  const auto sliding = body.unsupported();
  REQUIRE(sliding.found);
  CHECK_THAT(sliding.force[1], WithinRel(-90., 1e-12));
  // A hinge at (2, 5) leaves the turn about it, which moves the middle by (1.5, 1.5) and a point at the
  // body's size of sqrt(4.5) from it by sqrt(4.5) more: m = (1.5, 1.5, sqrt(4.5)), |m|^2 = 9. The weight does
  // -90 * 1.5 on it, so that -15 m is left.
  body.fix([](const auto& ijk) { return ijk[0] == 2 && ijk[1] == 5 ? 3 : 0; });
  const auto swinging = body.unsupported();
  REQUIRE(swinging.found);
  for (int i = 0; i < 2; ++i) CHECK_THAT(swinging.force[i], WithinRel(-22.5, 1e-12));
  CHECK_THAT(swinging.torque[2], WithinRel(-15 * 4.5, 1e-12));
  // Above the middle it holds; the nodes are at 2, ..., 5, so two of them do it.
  body.fix([](const auto& ijk) { return (ijk[0] == 3 || ijk[0] == 4) && ijk[1] == 5 ? 3 : 0; });
  CHECK_FALSE(body.unsupported().found);
}

TEST_CASE("a torque without support is found in 2D and 3D") {
  auto body =
      plate([](const auto& cell) { return cell[0] > 1 && cell[0] < 5 && cell[1] > 1 && cell[1] < 5; });
  body.assemble();
  const auto force_at = [&](int i, int j, int c, double f) {
    edit(body.state.nodes.sums, [&](const auto& sums) {
      sums(body.basis.grid.node_index(Vector<2, int>{{i, j}}), 3 + c) += f;
    });
  };
  force_at(2, 3, 1, -4);  // a couple of 4 N over 3 m
  force_at(5, 3, 1, 4);
  const auto turning =
      find_unsupported_load(Exec(), body.state.nodes, body.state.occupancy.bins, body.basis, 1e-10);
  REQUIRE(turning.found);
  CHECK_THAT(turning.torque[2], WithinRel(12., 1e-12));
  for (int i = 0; i < 2; ++i) CHECK_THAT(turning.force[i], WithinAbs(0, 1e-12));

  const auto grid = column_grid<3>({{5, 5, 5}}, 1);
  Problem<3, LinearBasis<3, double>> cube({grid},
                                          fill_cells<3, double>(grid, 2, 1.,
                                                                [](const auto& cell) {
                                                                  return cell[0] > 0 && cell[0] < 4 &&
                                                                         cell[1] > 0 && cell[1] < 4 &&
                                                                         cell[2] > 0 && cell[2] < 4;
                                                                }),
                                          LinearElastic<double>::from_young(1000, 0.3));
  cube.assemble();
  edit(cube.state.nodes.sums, [&](const auto& sums) {
    const auto node = [&](int i, int j, int k) { return grid.node_index(Vector<3, int>{{i, j, k}}); };
    sums(node(2, 1, 2), 4 + 2) = -5;  // about x: 5 N along z over 3 m along y
    sums(node(2, 4, 2), 4 + 2) = 5;
  });
  const auto about_x =
      find_unsupported_load(Exec(), cube.state.nodes, cube.state.occupancy.bins, cube.basis, 1e-10);
  REQUIRE(about_x.found);
  CHECK_THAT(about_x.torque[0], WithinRel(15., 1e-12));
  for (int i = 1; i < 3; ++i) CHECK_THAT(about_x.torque[i], WithinAbs(0, 1e-11));
  for (int i = 0; i < 3; ++i) CHECK_THAT(about_x.force[i], WithinAbs(0, 1e-12));
}

TEST_CASE("of two bodies the one without support is found") {
  auto bodies = plate([](const auto& cell) { return cell[0] == 0 || cell[0] == 5; });
  bodies.fix([](const auto& ijk) { return ijk[0] == 0 ? 3 : 0; });
  bodies.gravity = {{0, -1}};
  const auto free = bodies.unsupported();
  REQUIRE(free.found);
  CHECK_THAT(free.middle[0], WithinRel(5.5, 1e-12));
  CHECK_THAT(free.force[1], WithinRel(-8., 1e-12));
  bodies.fix([](const auto& ijk) { return ijk[0] == 0 || ijk[0] == 5 ? 3 : 0; });
  CHECK_FALSE(bodies.unsupported().found);
}
