// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The uniform grid's numbering and the multilinear basis on it.
#include "bins_of_basis.hpp"

using namespace vsb;
using namespace vsb::test;

TEST_CASE("nodes and cells are numbered along x first") {
  const UniformGrid<3, double> grid({{0, 10, 100}}, {{1, 2, 4}}, {{3, 2, 5}});
  CHECK(grid.node_count() == 4 * 3 * 6);
  CHECK(grid.cell_count() == 3 * 2 * 5);
  CHECK(grid.cell_volume() == 8);
  CHECK(grid.node_stride(0) == 1);
  CHECK(grid.node_stride(1) == 4);
  CHECK(grid.node_stride(2) == 12);
  CHECK(grid.node_index({{1, 2, 3}}) == 1 + 2 * 4 + 3 * 12);
  CHECK(grid.cell_index({{2, 1, 3}}) == 2 + 1 * 3 + 3 * 6);
  CHECK(grid.row_index({{2, 1, 3}}) == 1 + 3 * 2);
  const auto x = grid.node_position(1 + 2 * 4 + 3 * 12);
  CHECK(x[0] == 1);
  CHECK(x[1] == 14);
  CHECK(x[2] == 112);

  const UniformGrid<1, float> line({{-1}}, {{0.5f}}, {{7}});
  CHECK(line.node_count() == 8);
  CHECK(line.node_position(7)[0] == 2.5f);
  CHECK(line.row_index({{6}}) == 0);
}

TEMPLATE_TEST_CASE_SIG("node numbers and node coordinates are inverse", "", ((int Dim), Dim), 1, 2, 3) {
  const auto grid = make_grid<Dim, double>();
  for (int node = 0; node < grid.node_count(); ++node) {
    const auto ijk = grid.node_ijk(node);
    for (int i = 0; i < Dim; ++i) CHECK((ijk[i] >= 0 && ijk[i] <= grid.cells[i]));
    CHECK(grid.node_index(ijk) == node);
  }
}

TEMPLATE_TEST_CASE_SIG("the basis reproduces multilinear fields and their gradients", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (1, float), (2, float), (3, float)) {
  const auto grid = make_grid<Dim, Real>();
  const LinearBasis<Dim, Real> basis{grid};
  constexpr double slope[3] = {0.7, -0.4, 0.3};
  // f = prod_i (2 + slope_i x_i), whose derivatives are products of the other factors.
  const auto factor = [&](const Vector<Dim, Real>& x, int i) {
    return 2 + slope[i] * static_cast<double>(x[i]);
  };
  const auto f = [&](const Vector<Dim, Real>& x) {
    double product = 1;
    for (int i = 0; i < Dim; ++i) product *= factor(x, i);
    return product;
  };
  Random random(2);
  for (int trial = 0; trial < 200; ++trial) {
    const auto x = random_point(grid, random);
    REQUIRE(basis.contains(x));
    const auto shape = basis.shape(x);
    double one = 0, value = 0, zero[Dim] = {}, gradient[Dim] = {}, position[Dim] = {},
           identity[Dim][Dim] = {};
    std::set<int> nodes;
    for (int a = 0; a < basis.support; ++a) {
      const auto xa = grid.node_position(shape.node[a]);
      CHECK(shape.N[a] >= 0);
      nodes.insert(shape.node[a]);
      one += static_cast<double>(shape.N[a]);
      value += static_cast<double>(shape.N[a]) * f(xa);
      for (int i = 0; i < Dim; ++i) {
        const auto dN = static_cast<double>(shape.dN[a][i]);
        zero[i] += dN;
        gradient[i] += dN * f(xa);
        position[i] += static_cast<double>(shape.N[a]) * static_cast<double>(xa[i]);
        for (int j = 0; j < Dim; ++j) identity[j][i] += dN * static_cast<double>(xa[j]);
      }
    }
    // Positions up to 3.25, gradients up to 4 per metre, values of f up to 20.
    const double round_off = 1000 * epsilon<Real>;
    CHECK(static_cast<int>(nodes.size()) == basis.support);
    CHECK_THAT(one, WithinAbs(1, 4 * epsilon<Real>));
    CHECK_THAT(value, WithinAbs(f(x), round_off));
    for (int i = 0; i < Dim; ++i) {
      CHECK_THAT(zero[i], WithinAbs(0, 16 * epsilon<Real>));
      CHECK_THAT(position[i], WithinAbs(static_cast<double>(x[i]), 16 * epsilon<Real>));
      CHECK_THAT(gradient[i], WithinAbs(slope[i] * f(x) / factor(x, i), round_off));
      for (int j = 0; j < Dim; ++j) CHECK_THAT(identity[i][j], WithinAbs(i == j, 100 * epsilon<Real>));
    }
  }
}

TEMPLATE_TEST_CASE_SIG("interpolate and gradient of a shape take the field node by node", "",
                       ((int Dim), Dim), 1, 2, 3) {
  const auto grid = make_grid<Dim, double>();
  const LinearBasis<Dim, double> basis{grid};
  const double A[3][3] = {{1, 2, 3}, {-4, 5, -6}, {7, 8, 10}};
  const auto linear = [&](const Vector<Dim, double>& x, int i) {
    double v = 0.5 * i;
    for (int j = 0; j < Dim; ++j) v += A[i][j] * x[j];
    return v;
  };
  const auto field = [&](int node, int i) { return linear(grid.node_position(node), i); };
  Random random(3);
  const auto x = random_point(grid, random);
  const auto v = basis.shape(x).interpolate(field);
  const auto L = basis.shape(x).gradient(field);
  for (int i = 0; i < Dim; ++i) {
    CHECK_THAT(v[i], WithinAbs(linear(x, i), 1e-13));
    for (int j = 0; j < Dim; ++j) CHECK_THAT(L(i, j), WithinAbs(A[i][j], 1e-12));
  }
}

TEMPLATE_TEST_CASE_SIG("at a node its own basis function is one and all others vanish", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, float)) {
  const auto grid = make_grid<Dim, Real>();
  const LinearBasis<Dim, Real> basis{grid};
  for (int node = 0; node < grid.node_count(); ++node) {
    REQUIRE(basis.contains(grid.node_position(node)));
    const auto shape = basis.shape(grid.node_position(node));
    int found = 0;
    for (int a = 0; a < basis.support; ++a) {
      CHECK_THAT(shape.N[a], WithinAbs(shape.node[a] == node ? 1 : 0, 8 * epsilon<Real>));
      found += shape.node[a] == node;
    }
    CHECK(found == 1);
  }
}

TEMPLATE_TEST_CASE_SIG("containment", "", ((int Dim, typename Real), Dim, Real), (1, double), (2, double),
                       (3, double), (1, float), (2, float), (3, float)) {
  const auto grid = make_grid<Dim, Real>();
  const LinearBasis<Dim, Real> basis{grid};
  Vector<Dim, Real> inside;
  for (int i = 0; i < Dim; ++i) inside[i] = grid.lower[i] + Real(0.6) * grid.spacing[i];
  REQUIRE(basis.contains(inside));
  const Real nan = std::numeric_limits<Real>::quiet_NaN(), infinity = std::numeric_limits<Real>::infinity();
  for (int i = 0; i < Dim; ++i) {
    const auto with = [&](Real value) {
      auto x = inside;
      x[i] = value;
      return x;
    };
    const Real low = grid.lower[i], high = low + static_cast<Real>(grid.cells[i]) * grid.spacing[i];
    for (const Real face : {low, high}) {
      const Real step = 2 * std::numeric_limits<Real>::epsilon() * std::abs(face);
      for (const Real x : {face - step, face, face + step}) {
        CAPTURE(i, face, x - face);
        REQUIRE(basis.contains(with(x)));
        const auto shape = basis.shape(with(x));
        CHECK(basis.bin(with(x)) == shape.node[0]);
        for (int a = 0; a < basis.support; ++a) {
          CHECK((shape.node[a] >= 0 && shape.node[a] < basis.node_count()));
          CHECK(static_cast<double>(shape.N[a]) > -100 * epsilon<Real>);
        }
      }
    }
    const Real little = Real(1e-4) * grid.spacing[i];
    for (const Real x : {low - little, high + little, low - 1, high + 1, Real(-1e30), Real(1e30), nan,
                         infinity, -infinity}) {
      CAPTURE(i, x);
      CHECK_FALSE(basis.contains(with(x)));
    }
  }
}

TEMPLATE_TEST_CASE_SIG("bins, their support nodes and their points belong together", "", ((int Dim), Dim), 1,
                       2, 3) {
  const auto grid = make_grid<Dim, double>();
  const LinearBasis<Dim, double> basis{grid};
  std::set<int> cell_bins;
  for_each_cell(grid, [&](const Vector<Dim, int>& cell) {
    Vector<Dim, double> x;
    for (int i = 0; i < Dim; ++i) x[i] = grid.lower[i] + (cell[i] + 0.3) * grid.spacing[i];
    const int bin = basis.bin(x);
    CHECK((bin >= 0 && bin < basis.bin_count()));
    CHECK(cell_bins.insert(bin).second);  // no two cells share a bin
    check_nodes_of_bin(basis, bin, x);
  });
  check_bins_of_nodes(basis, cell_bins);
}
