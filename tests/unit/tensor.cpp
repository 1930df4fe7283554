// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Small vectors, matrices and symmetric tensors.
#include <set>
#include <vsb/views/tensor.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

TEST_CASE("symmetric_index gives each pair of a dimension its own index") {
  for (const int dimension : {1, 2, 3}) {
    std::set<int> indices;
    for (int i = 0; i < 3; ++i)
      indices.insert(symmetric_index(i, i));  // the normal components, in any dimension
    for (int i = 0; i < dimension; ++i)
      for (int j = 0; j < dimension; ++j) {
        CHECK(symmetric_index(i, j) == symmetric_index(j, i));
        indices.insert(symmetric_index(i, j));
      }
    CAPTURE(dimension);
    const int size = symmetric_components(dimension);
    CHECK(static_cast<int>(indices.size()) == size);
    CHECK(*indices.begin() == 0);
    CHECK(*indices.rbegin() == size - 1);
  }
}

TEST_CASE("components are stored in the order xx yy zz xy yz xz") {
  const SymmetricTensor<3, double> s{{1, 2, 3, 12, 23, 13}};
  CHECK(s(0, 0) == 1);
  CHECK(s(1, 1) == 2);
  CHECK(s(2, 2) == 3);
  CHECK(s(0, 1) == 12);
  CHECK(s(2, 1) == 23);
  CHECK(s(0, 2) == 13);
  CHECK(sizeof(SymmetricTensor<1, double>) == 3 * sizeof(double));
  CHECK(sizeof(SymmetricTensor<2, double>) == 4 * sizeof(double));
  CHECK(sizeof(s) == 6 * sizeof(double));
}

TEST_CASE("traction of a stress on a face") {
  const SymmetricTensor<1, double> s1{{2, 30, 40}};
  CHECK((s1 * Vector<1, double>{{5}})[0] == 10);

  const SymmetricTensor<2, double> s2{{1, 2, 1000, 4}};
  const auto t2 = s2 * Vector<2, double>{{1, 10}};
  CHECK(t2[0] == 41);
  CHECK(t2[1] == 24);

  const SymmetricTensor<3, double> s3{{1, 2, 3, 4, 5, 6}};
  const auto t3 = s3 * Vector<3, double>{{1, 10, 100}};
  CHECK(t3[0] == 1 + 40 + 600);
  CHECK(t3[1] == 4 + 20 + 500);
  CHECK(t3[2] == 6 + 50 + 300);
}

TEST_CASE("determinants and traces of matrices worked out by hand") {
  CHECK(determinant(Matrix<1, double>{{{-3}}}) == -3);
  CHECK(determinant(Matrix<2, double>{{{3, 1}, {4, 2}}}) == 2);
  CHECK(determinant(Matrix<3, double>{{{2, -1, 3}, {0, 4, 5}, {1, -2, 6}}}) == 51);
  CHECK(trace(Matrix<1, double>{{{-3}}}) == -3);
  CHECK(trace(Matrix<2, double>{{{3, 1}, {4, 2}}}) == 5);
  CHECK(trace(Matrix<3, double>{{{2, -1, 3}, {0, 4, 5}, {1, -2, 6}}}) == 12);
}

TEMPLATE_TEST_CASE_SIG("determinant is alternating and one for the identity", "", ((int Dim), Dim), 2, 3) {
  CHECK(determinant(Matrix<Dim, float>::identity()) == 1);
  Random random(1);
  Matrix<Dim, double> m;
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) m(i, j) = random(-1, 1);
  for (int row = 1; row < Dim; ++row) {
    auto swapped = m, repeated = m;
    for (int j = 0; j < Dim; ++j) {
      std::swap(swapped(0, j), swapped(row, j));
      repeated(row, j) = m(0, j);
    }
    CHECK_THAT(determinant(swapped), WithinAbs(-determinant(m), 1e-15));
    CHECK_THAT(determinant(repeated), WithinAbs(0, 1e-15));
  }
}

TEST_CASE("vectors and tensors add, subtract and scale component by component") {
  const Vector<3, double> a{{1, 2, 3}}, b{{10, 20, 30}};
  const auto sum = a + b, difference = b - a, multiple = 2. * a;
  for (int i = 0; i < 3; ++i) {
    CHECK(sum[i] == 11 * (i + 1));
    CHECK(difference[i] == 9 * (i + 1));
    CHECK(multiple[i] == 2 * (i + 1));
    CHECK(Vector<3, double>::zero()[i] == 0);
  }
  CHECK(dot(a, b) == 10 + 40 + 90);

  const SymmetricTensor<2, double> s{{1, 2, 3, 4}}, t{{10, 20, 30, 40}};
  const auto total = s + t, rest = t - s, scaled = 3. * s;
  const auto isotropic = SymmetricTensor<2, double>::isotropic(7), zero = SymmetricTensor<2, double>::zero();
  for (int c = 0; c < 4; ++c) {
    CHECK(total[c] == 11 * (c + 1));
    CHECK(rest[c] == 9 * (c + 1));
    CHECK(scaled[c] == 3 * (c + 1));
    CHECK(isotropic[c] == (c < 3 ? 7 : 0));
    CHECK(zero[c] == 0);
  }
}
