// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Quadratic B-splines and uGIMP: their functions by hand and by their definitions, and their bins.
#include "wide_bases.hpp"

#include <array>
#include <map>
#include <set>

#include "bins_of_basis.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

double hat(double distance) {
  return std::max(0.0, 1 - std::abs(distance));
}

/// The integral of the hat function from minus infinity to x.
double hat_integral(double x) {
  if (x <= -1) return 0;
  if (x >= 1) return 1;
  return x < 0 ? 0.5 * (1 + x) * (1 + x) : 1 - 0.5 * (1 - x) * (1 - x);
}

}  // namespace

TEST_CASE("quadratic B-splines by hand") {
  const auto expect = [](double xi, std::array<double, 3> N, std::array<double, 3> dN) {
    const auto f = quadratic_bspline(xi);
    for (size_t k = 0; k < 3; ++k) {
      CAPTURE(xi, k);
      CHECK(f.N[k] == N[k]);
      CHECK(f.dN[k] == dN[k]);
    }
  };
  expect(0, {{1. / 8, 3. / 4, 1. / 8}}, {{-0.5, 0, 0.5}});
  expect(0.5, {{0, 0.5, 0.5}}, {{0, -1, 1}});
  expect(-0.5, {{0.5, 0.5, 0}}, {{-1, 1, 0}});
  expect(0.25, {{1. / 32, 22. / 32, 9. / 32}}, {{-0.25, -0.5, 0.75}});
}

TEST_CASE("uGIMP by hand") {
  const auto expect = [](double xi, double l, std::array<double, 3> N, std::array<double, 3> dN) {
    const auto f = uniform_gimp(xi, l);
    for (size_t k = 0; k < 3; ++k) {
      CAPTURE(xi, l, k);
      CHECK(f.N[k] == N[k]);
      CHECK(f.dN[k] == dN[k]);
    }
  };
  expect(0, 0.25, {{1. / 16, 7. / 8, 1. / 16}}, {{-0.5, 0, 0.5}});
  expect(0.375, 0.25, {{0, 0.625, 0.375}}, {{0, -1, 1}});  // the particle lies between two nodes
  expect(-0.375, 0.25, {{0.375, 0.625, 0}}, {{-1, 1, 0}});
  expect(0.125, 0.25, {{1. / 64, 54. / 64, 9. / 64}}, {{-0.25, -0.5, 0.75}});
  expect(0.25, 0.25, {{0, 0.75, 0.25}}, {{0, -1, 1}});  // its end is at the node
}

TEST_CASE("uGIMP is the mean of the hat function over the particle; half a cell makes it a B-spline") {
  Random random(91);
  for (int trial = 0; trial < 2000; ++trial) {
    const double xi = random(-0.5, 0.5), l = random(0.01, 0.5);
    const auto f = uniform_gimp(xi, l);
    for (int k = 0; k < 3; ++k) {
      const double distance = xi - (k - 1);
      CAPTURE(xi, l, k);
      CHECK_THAT(f.N[k],
                 WithinAbs((hat_integral(distance + l) - hat_integral(distance - l)) / (2 * l), 1e-13));
      CHECK_THAT(f.dN[k], WithinAbs((hat(distance + l) - hat(distance - l)) / (2 * l), 1e-13));
      CHECK_THAT(uniform_gimp(xi, 0.5).N[k], WithinAbs(quadratic_bspline(xi).N[k], 1e-15));
      CHECK_THAT(uniform_gimp(xi, 0.5).dN[k], WithinAbs(quadratic_bspline(xi).dN[k], 1e-15));
    }
  }
}

TEMPLATE_LIST_TEST_CASE("wide bases: partition of unity, linear fields, gradients, continuity", "",
                        WideBases) {
  constexpr int Dim = TestType::dimension;
  const auto inner = make_grid<Dim, double>();
  const auto basis = WideBasis<TestType>::on(inner);
  Random random(92);
  for (int trial = 0; trial < 300; ++trial) {
    const auto x = random_point(inner, random);
    REQUIRE(basis.contains(x));
    const auto shape = basis.shape(x);
    double one = 0, zero[Dim] = {}, position[Dim] = {}, identity[Dim][Dim] = {};
    std::set<int> nodes;
    for (int a = 0; a < basis.support; ++a) {
      REQUIRE((shape.node[a] >= 0 && shape.node[a] < basis.node_count()));
      const auto xa = basis.grid.node_position(shape.node[a]);
      CHECK(shape.N[a] >= 0);
      nodes.insert(shape.node[a]);
      one += shape.N[a];
      for (int i = 0; i < Dim; ++i) {
        zero[i] += shape.dN[a][i];
        position[i] += shape.N[a] * xa[i];
        for (int j = 0; j < Dim; ++j) identity[j][i] += shape.dN[a][i] * xa[j];
      }
    }
    CHECK(static_cast<int>(nodes.size()) == basis.support);
    CHECK_THAT(one, WithinAbs(1, 1e-14));
    for (int i = 0; i < Dim; ++i) {
      CHECK_THAT(zero[i], WithinAbs(0, 1e-13));
      CHECK_THAT(position[i], WithinAbs(x[i], 1e-13));
      for (int j = 0; j < Dim; ++j) CHECK_THAT(identity[i][j], WithinAbs(i == j, 1e-12));
    }

    // Gradients against central differences, node by node; functions of order 1 and cells of 0.25 m and more:
    // the differences are off by 1e-16 / delta and, where a second derivative jumps, by delta / h^2.
    constexpr double delta = 1e-7;
    for (int i = 0; i < Dim; ++i) {
      auto up = x, down = x;
      up[i] += delta;
      down[i] -= delta;
      std::map<int, double> difference;
      const auto above = basis.shape(up), below = basis.shape(down);
      for (int a = 0; a < basis.support; ++a) difference[above.node[a]] += above.N[a] / (2 * delta);
      for (int a = 0; a < basis.support; ++a) difference[below.node[a]] -= below.N[a] / (2 * delta);
      for (int a = 0; a < basis.support; ++a) {
        CHECK_THAT(shape.dN[a][i], WithinAbs(difference[shape.node[a]], 2e-5));
        difference.erase(shape.node[a]);
      }
      for (const auto& [node, d] : difference) CHECK_THAT(d, WithinAbs(0, 2e-5));
    }
  }
}

TEMPLATE_LIST_TEST_CASE("wide bases: points lie in the grid without its ghost layer", "", WideBases) {
  constexpr int Dim = TestType::dimension;
  const auto inner = make_grid<Dim, double>();
  const auto basis = WideBasis<TestType>::on(inner);
  auto middle = inner.lower;
  for (int i = 0; i < Dim; ++i) middle[i] += 0.6 * inner.spacing[i];
  REQUIRE(basis.contains(middle));
  for (int i = 0; i < Dim; ++i) {
    const double low = inner.lower[i], high = low + inner.cells[i] * inner.spacing[i];
    const auto with = [&](double value) {
      auto x = middle;
      x[i] = value;
      return x;
    };
    for (const double face : {low, high})
      for (const double x : {face - 1e-15, face, face + 1e-15}) {
        REQUIRE(basis.contains(with(x)));
        const auto shape = basis.shape(with(x));
        for (int a = 0; a < basis.support; ++a)
          CHECK((shape.node[a] >= 0 && shape.node[a] < basis.node_count()));
      }
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double x : {low - 1e-5, high + 1e-5, low - 0.9 * inner.spacing[i], -1e30, 1e30, nan})
      CHECK_FALSE(basis.contains(with(x)));
  }
}

TEMPLATE_LIST_TEST_CASE("wide bases: bins, their support nodes and their points belong together", "",
                        WideBases) {
  constexpr int Dim = TestType::dimension;
  const auto inner = make_grid<Dim, double>();
  const auto basis = WideBasis<TestType>::on(inner);
  Random random(93);
  std::set<int> bins;
  for (int trial = 0; trial < 5000; ++trial) {
    const auto x = random_point(inner, random);
    const int bin = basis.bin(x);
    const auto centre = basis.grid.node_position(bin);
    for (int i = 0; i < Dim; ++i) CHECK(std::abs(x[i] - centre[i]) <= 0.5 * inner.spacing[i]);
    bins.insert(bin);
    check_nodes_of_bin(basis, bin, x);
  }
  CHECK(static_cast<int>(bins.size()) == inner.node_count());
  check_bins_of_nodes(basis, bins);
}
