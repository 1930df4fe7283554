// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The consistent mass matrix of a cell against sums of products of the nodes' basis functions.
#include <vsb/physics/cell_mass_matrix.hpp>
#include <vsb/physics/multilinear.hpp>
#include <vsb/views/pack.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

template <int Dim>
struct Brute {
  double M[1 << Dim][1 << Dim] = {};
  void add(double m, const Vector<Dim, double>& xi) {
    Vector<Dim, double> one, dN[1 << Dim];
    for (int i = 0; i < Dim; ++i) one[i] = 1;
    double N[1 << Dim];
    multilinear(xi, one, N, dN);
    for (int a = 0; a < 1 << Dim; ++a)
      for (int b = 0; b < 1 << Dim; ++b) M[a][b] += m * N[a] * N[b];
  }
};

/// Column b of the matrix: times(M, unit vector b).
template <int Dim, class T>
Vector<(1 << Dim), T> column(const CellMassMatrix<Dim, T>& M, int b) {
  auto u = Vector<(1 << Dim), T>::zero();
  u[b] = T(1);
  return times<Dim>(M, u);
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("the mass matrix of a cell, entry by entry", "", ((int Dim), Dim), 1, 2, 3) {
  Random random(7);
  // Anywhere, and all next to a face, where a node has next to no mass.
  for (const double highest : {1., 1e-7}) {
    auto M = CellMassMatrix<Dim, double>::zero();
    Brute<Dim> expected;
    for (int p = 0; p < 20; ++p) {
      Vector<Dim, double> xi;
      for (int i = 0; i < Dim; ++i) xi[i] = random(0, i == 0 ? highest : 1);
      const double m = random(0.5, 2);
      add_mass<Dim>(M, m, xi);
      expected.add(m, xi);
    }
    for (int b = 0; b < 1 << Dim; ++b) {
      const auto found = column<Dim>(M, b);
      for (int a = 0; a < 1 << Dim; ++a) CHECK_THAT(found[a], WithinRel(expected.M[a][b], 1e-14));
    }
  }
}

TEMPLATE_TEST_CASE_SIG("the mass matrix in lanes", "", ((int Dim, typename T, int W), Dim, T, W),
                       (1, double, 4), (2, double, 4), (3, double, 4), (3, float, 8)) {
  using P = Pack<T, W>;
  Random random(11);
  CellMassMatrix<Dim, P> M;
  for (int k = 0; k < M.size; ++k) M[k] = P(T(0));
  Brute<Dim> expected[W];
  for (int p = 0; p < 8; ++p) {
    Vector<Dim, P> xi;
    P m;
    for (int l = 0; l < W; ++l) {
      Vector<Dim, double> x;
      m.set(l, random.draw<T>(0.5, 2));
      for (int i = 0; i < Dim; ++i) {
        xi[i].set(l, random.draw<T>(0, 1));
        x[i] = static_cast<double>(xi[i][l]);
      }
      expected[l].add(static_cast<double>(m[l]), x);
    }
    add_mass<Dim>(M, m, xi);
  }
  Vector<(1 << Dim), P> u;
  for (int b = 0; b < 1 << Dim; ++b)
    for (int l = 0; l < W; ++l) u[b].set(l, static_cast<T>(1 + b + 10 * l));
  const auto found = times<Dim>(M, u);
  for (int a = 0; a < 1 << Dim; ++a)
    for (int l = 0; l < W; ++l) {
      double sum = 0;
      for (int b = 0; b < 1 << Dim; ++b) sum += expected[l].M[a][b] * (1 + b + 10 * l);
      CHECK_THAT(static_cast<double>(found[a][l]), WithinRel(sum, 64 * epsilon<T>));
    }
}
