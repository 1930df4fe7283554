// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Quadratic polynomials on a node-centred cell, of numbers and of packs, against the nodes' B-splines
/// written out.
#include <vsb/physics/quadratic_polynomial.hpp>
#include <vsb/views/pack.hpp>

#include "lane_by_lane.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

/// The quadratic B-spline at t, in cells from its node, and its derivative.
double bspline(double t) {
  const double a = std::abs(t);
  return a < 0.5 ? 0.75 - t * t : a < 1.5 ? 0.5 * (1.5 - a) * (1.5 - a) : 0;
}
double slope(double t) {
  const double a = std::abs(t), sign = t < 0 ? -1 : 1;
  return a < 0.5 ? -2 * t : a < 1.5 ? -sign * (1.5 - a) : 0;
}

/// N_a in lane l of xi, derived along direction j if that is not negative. The middle node is at 1/2.
template <int Dim, class T>
double basis(const Vector<Dim, T>& xi, int l, int a, int j = -1) {
  double product = 1;
  for (int i = 0; i < Dim; ++i, a /= 3) {
    const double t = lane(xi[i], l) - 0.5 - (a % 3 - 1);
    product *= i == j ? slope(t) : bspline(t);
  }
  return product;
}

constexpr int particles = 6;
/// Numbers below 2, up to 3^Dim of them in sums over `particles`, each with a few roundings.
template <class T>
constexpr double tolerance = 32 * particles* epsilon<typename Traits<T>::real>;

template <class T, class Expected>
void check_lanes(const T& value, const Expected& expected) {
  for (int l = 0; l < Traits<T>::width; ++l)
    CHECK_THAT(lane(value, l), WithinAbs(static_cast<double>(expected(l)), tolerance<T>));
}

/// No moment is superfluous.
struct All {
  static constexpr bool of(int) { return false; }
};

}  // namespace

TEMPLATE_TEST_CASE_SIG("a nodal field on a node-centred cell and its gradient", "",
                       ((int Dim, typename T), Dim, T), (1, double), (2, double), (3, double),
                       (1, (Pack<double, 4>)), (2, (Pack<double, 4>)), (3, (Pack<double, 4>)),
                       (3, (Pack<float, 8>))) {
  Random random(94);
  for (int n = 0; n < 10; ++n) {
    const auto f = draw_vector<stencil_size(Dim), T>(random, -1, 1);
    const auto xi = draw_vector<Dim, T>(random, 0, 1);
    QuadraticPolynomial<Dim, T> c = f;
    quadratic_from_nodes<Dim>(c);
    const Powers<Dim, T> powers(xi);
    const auto expected = [&](int j) {
      return [&, j](int l) {
        double sum = 0;
        for (int a = 0; a < f.size; ++a) sum += basis<Dim>(xi, l, a, j) * lane(f[a], l);
        return sum;
      };
    };
    check_lanes(quadratic_at<Dim>(c, powers), expected(-1));
    Vector<Dim, T> gradient;
    check_lanes(quadratic_at<Dim>(c, powers, gradient), expected(-1));
    for (int j = 0; j < Dim; ++j) check_lanes(gradient[j], expected(j));
  }
}

TEMPLATE_TEST_CASE_SIG("sums over particles on a node-centred cell, from products and from moments", "",
                       ((int Dim, typename T), Dim, T), (1, double), (2, double), (3, double),
                       (1, (Pack<double, 4>)), (2, (Pack<double, 4>)), (3, (Pack<double, 4>)),
                       (3, (Pack<float, 8>))) {
  Random random(95);
  using Polynomial = QuadraticPolynomial<Dim, T>;
  Polynomial zero;
  for (int k = 0; k < zero.size; ++k) zero[k] = T(0);
  for (int n = 0; n < 4; ++n) {
    Polynomial sum = zero, moments = zero;
    std::vector<Vector<Dim, T>> xi;
    std::vector<T> w;
    for (int p = 0; p < particles; ++p) {
      xi.push_back(draw_vector<Dim, T>(random, 0, 1));
      w.push_back(Traits<T>::draw(random, -1, 1));
      add_product<Dim>(sum, w.back(), TensorProduct<Dim, T>::splines(xi.back()));
      add_monomials<All, Dim>(moments, w.back(), TensorProduct<Dim, T>::monomials(Powers<Dim, T>(xi.back())));
    }
    // Of the derivative along direction j, moments with the highest power of it are not needed.
    Polynomial of_slope[Dim];
    static_for<Dim>([&](auto j) {
      auto needed = moments;
      for (int k = 0; k < needed.size; ++k)
        if (stencil_digit(k, j) == 2)
          needed[k] = T(std::numeric_limits<typename Traits<T>::real>::quiet_NaN());
      of_slope[j] = zero;
      add_slope_moments<j, Dim>(of_slope[j], T(typename Traits<T>::real(0.5)), needed);
      nodes_from_quadratic<Dim>(of_slope[j]);
    });
    nodes_from_quadratic<Dim>(moments);
    for (int a = 0; a < sum.size; ++a) {
      const auto expected = [&](int j, double factor) {
        return [&, j, factor](int l) {
          double total = 0;
          for (size_t p = 0; p < particles; ++p) total += factor * basis<Dim>(xi[p], l, a, j) * lane(w[p], l);
          return total;
        };
      };
      check_lanes(sum[a], expected(-1, 1));
      check_lanes(moments[a], expected(-1, 1));
      for (int j = 0; j < Dim; ++j) check_lanes(of_slope[j][a], expected(j, 0.5));
    }
  }
}

TEMPLATE_TEST_CASE_SIG("products give a node with next to no weight its sum to round-off", "",
                       ((int Dim), Dim), 1, 2, 3) {
  // Beside a heavy particle at the other end: moments would leave epsilon of that one.
  const double delta = 1e-6;
  Vector<Dim, double> near, far;
  for (int i = 0; i < Dim; ++i) {
    near[i] = delta;
    far[i] = 2 * delta;
  }
  QuadraticPolynomial<Dim, double> sum;
  for (int k = 0; k < sum.size; ++k) sum[k] = 0;
  for (const auto& xi : {near, far}) add_product<Dim>(sum, 1.0, TensorProduct<Dim, double>::splines(xi));
  double expected_near = 1, expected_far = 1;
  for (int i = 0; i < Dim; ++i) {
    expected_near *= 0.5 * delta * delta;
    expected_far *= 2 * delta * delta;
  }
  // xi - 1/2 is rounded to 2^-54, of delta some 1e-10.
  CHECK_THAT(sum[sum.size - 1] / (expected_near + expected_far), WithinAbs(1, 4e-10));
}
