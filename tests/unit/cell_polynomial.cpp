// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Polynomials on a cell, of numbers and of packs, against the nodes' basis functions.
#include <vsb/physics/cell_polynomial.hpp>
#include <vsb/physics/multilinear.hpp>
#include <vsb/views/pack.hpp>

#include "lane_by_lane.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

/// The basis functions at lane l of xi, in double.
template <int Dim>
struct Basis {
  double N[1 << Dim];
  Vector<Dim, double> dN[1 << Dim];
  template <class T>
  Basis(const Vector<Dim, T>& xi, int l) {
    Vector<Dim, double> x, one;
    for (int i = 0; i < Dim; ++i) {
      x[i] = lane(xi[i], l);
      one[i] = 1;
    }
    multilinear(x, one, N, dN);
  }
};

constexpr int particles = 6;
/// Numbers below 2, up to 2^Dim of them in sums over `particles`, each with at most Dim + 2 roundings.
template <class T>
constexpr double tolerance = 16 * particles* epsilon<typename Traits<T>::real>;

template <class T, class Expected>
void check_lanes(const T& value, const Expected& expected) {
  for (int l = 0; l < Traits<T>::width; ++l)
    CHECK_THAT(lane(value, l), WithinAbs(static_cast<double>(expected(l)), tolerance<T>));
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("a nodal field and its gradient at any position", "", ((int Dim, typename T), Dim, T),
                       (1, double), (2, double), (3, double), (1, (Pack<double, 4>)), (2, (Pack<double, 4>)),
                       (3, (Pack<double, 4>)), (3, (Pack<float, 8>))) {
  Random random(92);
  for (int n = 0; n < 10; ++n) {
    const auto f = draw_vector<(1 << Dim), T>(random, -1, 1);
    const auto xi = draw_vector<Dim, T>(random, 0, 1);
    CellPolynomial<Dim, T> c = f;
    coefficients_from_nodes<Dim>(c);
    check_lanes(value_at<Dim>(c, xi), [&](int l) {
      const Basis<Dim> at(xi, l);
      double sum = 0;
      for (int a = 0; a < 1 << Dim; ++a) sum += at.N[a] * lane(f[a], l);
      return sum;
    });
    static_for<Dim>([&](auto j) {
      check_lanes(derivative_at<j, Dim>(c, xi), [&](int l) {
        const Basis<Dim> at(xi, l);
        double sum = 0;
        for (int a = 0; a < 1 << Dim; ++a) sum += at.dN[a][j] * lane(f[a], l);
        return sum;
      });
    });
  }
}

TEMPLATE_TEST_CASE_SIG("sums over particles at the nodes from moments", "", ((int Dim, typename T), Dim, T),
                       (1, double), (2, double), (3, double), (1, (Pack<double, 4>)), (2, (Pack<double, 4>)),
                       (3, (Pack<double, 4>)), (3, (Pack<float, 8>))) {
  using Polynomial = CellPolynomial<Dim, T>;
  Random random(93);
  for (int n = 0; n < 4; ++n) {
    std::vector<Vector<Dim, T>> xi;
    std::vector<T> w;
    std::vector<Vector<Dim, T>> direction;
    Polynomial zero;
    for (int k = 0; k < 1 << Dim; ++k) zero[k] = T(0);
    Polynomial m = zero, m_of = zero, g = zero;
    for (int p = 0; p < particles; ++p) {
      xi.push_back(draw_vector<Dim, T>(random, 0, 1));
      w.push_back(Traits<T>::draw(random, -1, 1));
      direction.push_back(draw_vector<Dim, T>(random, -1, 1));
      const auto q = monomials<Dim>(xi.back());
      add_moments<Dim>(m, w.back(), xi.back());
      add_moments_of<Dim>(m_of, w.back(), q);
      add_gradient_moments<Dim>(g, direction.back(), q);
    }
    // A constant along one direction, and the gradients with it from the moments of w at hand: that of all
    // directions is not needed.
    const auto c = draw_vector<Dim, T>(random, -1, 1);
    Polynomial but_last = m;
    but_last[(1 << Dim) - 1] = T(std::numeric_limits<typename Traits<T>::real>::quiet_NaN());
    auto of_c = gradient_moments<Dim>(c, but_last);
    auto along_last = gradient_moments_along<Dim - 1, Dim>(c[Dim - 1], but_last);

    for (auto* moments : {&m, &m_of, &g, &of_c, &along_last}) nodes_from_moments<Dim>(*moments);
    for (int a = 0; a < 1 << Dim; ++a) {
      const auto sum = [&](const auto& term) {
        return [&, term](int l) {
          double total = 0;
          for (size_t p = 0; p < particles; ++p) total += term(p, l, Basis<Dim>(xi[p], l));
          return total;
        };
      };
      const auto weighted =
          sum([&](size_t p, int l, const Basis<Dim>& at) { return at.N[a] * lane(w[p], l); });
      check_lanes(m[a], weighted);
      check_lanes(m_of[a], weighted);
      check_lanes(g[a], sum([&](size_t p, int l, const Basis<Dim>& at) {
                    double s = 0;
                    for (int i = 0; i < Dim; ++i) s += at.dN[a][i] * lane(direction[p][i], l);
                    return s;
                  }));
      check_lanes(of_c[a], sum([&](size_t p, int l, const Basis<Dim>& at) {
                    double s = 0;
                    for (int i = 0; i < Dim; ++i) s += at.dN[a][i] * lane(c[i], l);
                    return lane(w[p], l) * s;
                  }));
      check_lanes(along_last[a], sum([&](size_t p, int l, const Basis<Dim>& at) {
                    return lane(w[p], l) * lane(c[Dim - 1], l) * at.dN[a][Dim - 1];
                  }));
    }
  }
}

TEMPLATE_TEST_CASE_SIG("a field that varies linearly, from second moments", "",
                       ((int Dim, typename T), Dim, T), (1, double), (2, double), (3, double),
                       (2, (Pack<double, 4>)), (3, (Pack<float, 8>))) {
  Random random(5);
  const double epsilon = std::numeric_limits<typename Traits<T>::real>::epsilon();
  const auto b = draw_vector<Dim, T>(random, -1, 1);
  Matrix<Dim, T> d;
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) d(i, j) = Traits<T>::draw(random, -1, 1);
  SecondMoments<Dim, T> moments;
  moments.set_zero();
  double expected[8][1 << Dim] = {};
  for (int p = 0; p < 20; ++p) {
    const auto xi = draw_vector<Dim, T>(random, 0, 1);
    const T w = Traits<T>::draw(random, 0.5, 1.5);
    moments.add(w, xi);
    for (int l = 0; l < Traits<T>::width; ++l) {
      const Basis<Dim> at(xi, l);
      for (int a = 0; a < 1 << Dim; ++a)
        for (int i = 0; i < Dim; ++i) {
          double s = lane(b[i], l);
          for (int j = 0; j < Dim; ++j) s += lane(d(i, j), l) * lane(xi[j], l);
          expected[l][a] += lane(w, l) * s * at.dN[a][i];
        }
    }
  }
  auto sum = gradient_moments<Dim>(b, d, moments);
  nodes_from_moments<Dim>(sum);
  for (int l = 0; l < Traits<T>::width; ++l)
    for (int a = 0; a < 1 << Dim; ++a) {
      CAPTURE(l, a);
      CHECK(std::abs(lane(sum[a], l) - expected[l][a]) < 500 * epsilon);
    }
}

TEMPLATE_TEST_CASE_SIG("a field along one direction that varies along one, from as many moments as it needs",
                       "", ((int Dim, typename T), Dim, T), (1, double), (2, double), (3, double),
                       (2, (Pack<double, 4>)), (3, (Pack<float, 8>))) {
  const double epsilon = std::numeric_limits<typename Traits<T>::real>::epsilon();
  static_for<Dim>([&](auto i) {
    static_for<Dim>([&](auto j) {
      Random random(6);
      const T b = Traits<T>::draw(random, -1, 1), d = Traits<T>::draw(random, -1, 1);
      SecondMoments<Dim, T> moments;
      moments.set_zero();
      double expected[8][1 << Dim] = {};
      for (int p = 0; p < 20; ++p) {
        const auto xi = draw_vector<Dim, T>(random, 0, 1);
        const T w = Traits<T>::draw(random, 0.5, 1.5);
        moments.template add_along<j>(w, xi);
        for (int l = 0; l < Traits<T>::width; ++l) {
          const Basis<Dim> at(xi, l);
          for (int a = 0; a < 1 << Dim; ++a)
            expected[l][a] += lane(w, l) * (lane(b, l) + lane(d, l) * lane(xi[j], l)) * at.dN[a][i];
        }
      }
      auto sum = gradient_moments_along<i, j, Dim>(b, d, moments);
      nodes_from_moments<Dim>(sum);
      for (int l = 0; l < Traits<T>::width; ++l)
        for (int a = 0; a < 1 << Dim; ++a) {
          CAPTURE(int(i), int(j), l, a);
          CHECK(std::abs(lane(sum[a], l) - expected[l][a]) < 500 * epsilon);
        }
    });
  });
}
