// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The mean divergence: its formula, with functions that hold too little volume, what a wall mirrors, that it
/// is symmetric and never more than what it is the mean of, and what a step makes of it.
#include <common_steps.hpp>
#include <map>
#include <vsb/physics/virtual_stress.hpp>

#include "support.hpp"
#include "wide_bases.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

template <int Dim>
using Fields = typename Nodes<Dim, double, Device>::Fields;

/// Particles in a random nodal velocity field, which the test may change: their divergence and its mean.
template <class Basis>
struct Strained {
  static constexpr int Dim = Basis::dimension;
  Basis basis;
  ParticleBlock<Dim, double, Device> block;
  State<Dim, double, Device> state;
  Fields<Dim> velocity;

  Strained(const Basis& b, const ParticleBlock<Dim, double, Device>& particles)
      : basis(b),
        block(particles),
        state(make_state(particles.particles, b)),
        velocity("vsb::test_velocity", static_cast<size_t>(b.node_count()), Dim) {
    REQUIRE(update_occupancy(Exec(), state.particles, state.occupancy, basis) == -1);
  }
  void draw(Random& random) {
    edit(velocity, [&](const auto& host) {
      for (size_t I = 0; I < host.extent(0); ++I)
        for (size_t i = 0; i < Dim; ++i) host(I, i) = random(-1, 1);
    });
  }
  std::vector<double> own() const {
    const auto v = read(velocity);
    const auto particles = read(block);
    std::vector<double> theta;
    for (int p = 0; p < particles.count(); ++p)
      theta.push_back(trace(basis.shape(particles.position_of(p)).gradient(v)));
    return theta;
  }
  std::vector<double> mean(Scatter strategy = Scatter::gathered) {
    return mean({{0, state.particles.count(), LinearElastic<double>::from_young(1, 0.3)}}, strategy);
  }
  std::vector<double> mean(const std::vector<Body<double>>& bodies, Scatter strategy = Scatter::gathered) {
    average_divergence(Exec(), state.particles, state.occupancy.bins, velocity, bodies, basis,
                       state.mean_divergence, strategy);
    const auto host = read(state.mean_divergence.of_particle);
    return {host.data(), host.data() + host.extent(0)};
  }
};

/// The mean by its formula; functions by their positions, in half cells from the lowest node of the grid, and
/// small ones with the largest around, of those as large the nearest.
template <int Dim>
std::vector<double> mean_by_formula(const UniformGrid<Dim, double>& grid, bool linear,
                                    const Particles<Dim, double, Kokkos::HostSpace>& particles,
                                    const std::vector<double>& theta) {
  using Centre = std::array<int, 3>;
  struct Sums {
    double volume = 0, divergence = 0;
  };
  const auto functions = [&](int p) {
    std::map<Centre, double> M;
    for (int a = 0; a < 1 << Dim; ++a) {
      Centre centre{};
      double weight = 1;
      for (int i = 0; i < Dim; ++i) {
        const double q = (particles.position(p, i) - grid.lower[i]) / grid.spacing[i];
        const int below = static_cast<int>(std::floor(linear ? q : q - 0.5));
        const double xi = linear ? 0 : q - 0.5 - below;
        const int upper = a >> i & 1;
        weight *= upper ? xi : 1 - xi;
        centre[static_cast<size_t>(i)] = below + upper;
      }
      if (weight > 0) M[centre] += weight;
    }
    return M;
  };
  std::map<Centre, Sums> sums;
  for (int p = 0; p < particles.count(); ++p)
    for (const auto& [centre, M] : functions(p)) {
      sums[centre].volume += M * particles.volume(p);
      sums[centre].divergence += M * particles.volume(p) * theta[static_cast<size_t>(p)];
    }
  const double least = linear ? 0 : 0.1 * grid.cell_volume();
  std::map<Centre, Centre> merged_into;
  for (const auto& [centre, own] : sums) {
    merged_into[centre] = centre;
    if (own.volume >= least) continue;
    const auto axes = [&, &from = centre](const Centre& other) {
      int different = 0;
      for (size_t i = 0; i < 3; ++i) {
        if (std::abs(other[i] - from[i]) > 1) return 9;
        different += other[i] != from[i];
      }
      return different;
    };
    double largest = 0;
    for (const auto& [other, s] : sums)
      if (axes(other) < 9) largest = std::max(largest, s.volume);
    // Of those as near, the first, x fastest.
    using Rank = std::array<int, 4>;
    Rank first{9};
    for (const auto& [other, s] : sums) {
      const Rank rank{axes(other), other[2], other[1], other[0]};
      if (s.volume < least || s.volume < 0.95 * largest || rank[0] >= 9 || rank >= first) continue;
      first = rank;
      merged_into[centre] = other;
    }
  }
  std::map<Centre, Sums> together;
  for (const auto& [centre, own] : sums) {
    together[merged_into[centre]].volume += own.volume;
    together[merged_into[centre]].divergence += own.divergence;
  }
  std::vector<double> mean;
  for (int p = 0; p < particles.count(); ++p) {
    mean.push_back(0);
    for (const auto& [centre, M] : functions(p)) {
      const auto& of = together[merged_into[centre]];
      mean.back() += M * of.divergence / of.volume;
    }
  }
  return mean;
}

/// Few particles of very different volumes: some functions hold a hundredth of a cell.
template <int Dim>
ParticleBlock<Dim, double, Device> slivers(const UniformGrid<Dim, double>& grid, unsigned seed) {
  const auto block = random_particles(grid, Dim == 1 ? 12 : Dim == 2 ? 40 : 90, seed);
  Random random(seed + 1);
  edit(block, [&](const auto& particles) {
    for (int p = 0; p < particles.count(); ++p)
      particles.volume(p) = grid.cell_volume() * std::pow(10., random(-3, 0));
  });
  return block;
}

template <class Basis>
void check_formula(const UniformGrid<Basis::dimension, double>& grid, const Basis& basis, unsigned seed) {
  constexpr bool linear = Basis::ghost_layers == 0;
  Strained<Basis> strained(basis, slivers(grid, seed));
  Random random(seed + 2);
  for (int trial = 0; trial < 3; ++trial) {
    strained.draw(random);
    const auto theta = strained.own();
    const auto expected = mean_by_formula(grid, linear, read(strained.block), theta);
    for (const auto strategy : {Scatter::gathered, Scatter::atomic}) {
      const auto mean = strained.mean(strategy);
      double worst = 0;
      for (size_t p = 0; p < mean.size(); ++p) worst = std::max(worst, std::abs(mean[p] - expected[p]));
      CHECK(worst < 1e-12);
    }
  }
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("the mean divergence is what its formula says, slivers included", "", ((int Dim), Dim),
                       1, 2, 3) {
  const auto grid = make_grid<Dim, double>();
  check_formula(grid, LinearBasis<Dim, double>{grid}, 11);
  for (const unsigned seed : {21u, 31u, 41u})
    check_formula(grid, WideBasis<QuadraticBSplineBasis<Dim, double>>::on(grid), seed);
}

TEST_CASE("bodies of one stiffness that follow each other have one mean divergence") {
  const auto grid = make_grid<2, double>();
  Strained<LinearBasis<2, double>> strained({grid}, random_particles(grid, 40, 61));
  Random random(62);
  strained.draw(random);
  const auto rock = LinearElastic<double>::from_young(1, 0.3),
             other = LinearElastic<double>::from_young(2, 0.3);
  const auto whole = strained.mean();
  const auto of = [&](const Material<double>& second, const Material<double>& third) {
    return strained.mean({{0, 10, rock}, {10, 25, second}, {25, 40, third}});
  };
  CHECK(of(rock, rock) == whole);
  CHECK(of(rock, other) != whole);
  // Each side of an interface is as if the other were not there.
  const auto first = of(rock, other), split = of(other, other);
  CHECK(std::equal(first.begin() + 25, first.end(),
                   of(rock, DruckerPrager<double>::von_mises(2, 0.3, 1, 0)).begin() + 25));
  CHECK(std::equal(first.begin(), first.begin() + 10, split.begin()) == false);
}

TEMPLATE_TEST_CASE_SIG("the mean divergence is symmetric and never larger, beside walls too", "",
                       ((int Dim), Dim), 2, 3) {
  const auto grid = make_grid<Dim, double>();
  auto basis = WideBasis<QuadraticBSplineBasis<Dim, double>>::on(grid);
  for (int i = 0; i < Dim; ++i) basis.walls.fixed[i][i % 2] = static_cast<ComponentMask>(1 << i);
  Strained<decltype(basis)> strained(basis, slivers(grid, 51));
  const auto particles = read(strained.block);
  Random random(52);
  std::vector<double> theta[2], mean[2];
  for (int k = 0; k < 2; ++k) {
    strained.draw(random);
    theta[k] = strained.own();
    mean[k] = strained.mean();
  }
  const auto product = [&](const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (size_t p = 0; p < a.size(); ++p) sum += particles.volume(static_cast<int>(p)) * a[p] * b[p];
    return sum;
  };
  const double scale = product(theta[0], theta[0]) + product(theta[1], theta[1]);
  CHECK_THAT(product(theta[0], mean[1]), WithinAbs(product(mean[0], theta[1]), 1e-13 * scale));
  for (int k = 0; k < 2; ++k) CHECK(product(mean[k], mean[k]) < product(theta[k], theta[k]));
}

TEST_CASE("the mean divergence of a half beside a wall is that of the whole") {
  const auto basis_on = [](double lower, int cells, bool wall) {
    auto basis = WideBasis<QuadraticBSplineBasis<2, double>>::on(
        UniformGrid<2, double>({{lower, 0.}}, {{1., 1.}}, {{cells, 4}}));
    if (wall) basis.walls.fixed[0][0] = 1;
    return basis;
  };
  const auto half_basis = basis_on(0, 4, true), whole_basis = basis_on(-4, 8, false);
  const UniformGrid<2, double> half_grid({{0., 0.}}, {{1., 1.}}, {{4, 4}});
  const auto half = fill_cells<2, double>(
      half_grid, 2, 1., [](const auto& cell) { return cell[0] < 3 && cell[1] > 0 && cell[1] < 3; });
  const int n = half.particles.count();
  const auto whole = allocate_particles<2, double, Device>(2 * n);
  const auto from = read(half);
  edit(whole, [&](const auto& to) {
    for (int p = 0; p < 2 * n; ++p) {
      to.position(p, 0) = (p < n ? 1 : -1) * from.position(p % n, 0);
      to.position(p, 1) = from.position(p % n, 1);
      to.volume(p) = from.volume(p % n);
      to.mass(p) = from.mass(p % n);
    }
  });
  Strained<decltype(half_basis)> of_half(half_basis, half), of_whole(whole_basis, whole);
  const auto fill = [](auto& strained) {
    const auto& grid = strained.basis.grid;
    edit(strained.velocity, [&](const auto& v) {
      for (int I = 0; I < grid.node_count(); ++I) {
        const auto x = grid.node_position(I);
        v(I, 0) = x[0] * (1 + std::sin(x[1] + x[0] * x[0]));
        v(I, 1) = std::cos(3 * x[1]) * x[0] * x[0];
      }
    });
  };
  fill(of_half);
  fill(of_whole);
  const auto a = of_half.mean(), b = of_whole.mean(), own = of_half.own();
  double differences = 0;
  for (size_t p = 0; p < a.size(); ++p) {
    CHECK_THAT(a[p], WithinAbs(b[p], 1e-13));
    differences += std::abs(a[p] - own[p]);
  }
  CHECK(differences > 0.1 * static_cast<double>(n));
}

TEST_CASE("a share of the divergence gives way, by the material") {
  const Matrix<2, double> L{{{0.3, 0.1}, {-0.2, 0.5}}};
  const double nu = 0.4;
  const auto elastic = LinearElastic<double>::from_young(7, nu);
  CHECK_THAT(averaged_share<2>(elastic), WithinRel(2 * nu, 1e-14));
  CHECK_THAT(averaged_share<3>(Hencky<double>::from_young(7, nu)), WithinRel(3 * nu / (1 + nu), 1e-14));
  CHECK(averaged_share<2>(LinearElastic<double>::from_young(7, -0.2)) == 0);
  CHECK(averaged_share<2>(LinearElastic<double>::from_young(7, 0)) == 0);
  CHECK(averaged_share<3>(DruckerPrager<double>::von_mises(7, 0.2, 1, 0)) == 1);
  // In the plane lambda tr(eps) takes the mean, and nothing else does.
  const double mean = -0.4;
  const auto zero = SymmetricTensor<2, double>::zero();
  auto expected = elastic.strained(zero, L, 1.);
  for (int i = 0; i < 2; ++i) expected[i] += elastic.lambda * (mean - trace(L));
  const auto stress = elastic.strained(zero, with_mean_divergence(L, mean, averaged_share<2>(elastic)), 1.);
  for (const int c : {0, 1, 3}) CHECK_THAT(stress[c], WithinAbs(expected[c], 1e-13));
}
