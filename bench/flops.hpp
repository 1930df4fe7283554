// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The additions and multiplications of a step on cell lanes, counted by running the formulas of physics/ in
/// the order of kernels/lanes/sweeps.hpp and sums.hpp on a number type that counts. Adding a constant
/// zero and multiplying by a constant one are not counted; nor is the work at the nodes.
#pragma once

#include <vsb/physics/cell_polynomial.hpp>
#include <vsb/physics/kinematics.hpp>
#include <vsb/physics/linear_elastic.hpp>

namespace vsb::bench {

/// A number that counts what is done with it.
class Counted {
 public:
  static inline long count = 0;
  Counted() = default;
  Counted(double value) : value_(value), constant_(true) {}

  friend Counted operator+(const Counted& a, const Counted& b) {
    if (a.is(0)) return b;
    return b.is(0) ? a : result(a.value_ + b.value_);
  }
  friend Counted operator-(const Counted& a, const Counted& b) {
    return b.is(0) ? a : result(a.value_ - b.value_);
  }
  friend Counted operator*(const Counted& a, const Counted& b) {
    if (a.is(1)) return b;
    return b.is(1)                      ? a
           : a.constant_ && b.constant_ ? Counted(a.value_ * b.value_)
                                        : result(a.value_ * b.value_);
  }
  Counted operator-() const { return *this; }
  Counted& operator+=(const Counted& b) { return *this = *this + b; }
  Counted& operator-=(const Counted& b) { return *this = *this - b; }
  Counted& operator*=(const Counted& b) { return *this = *this * b; }

  /// Of a particle or a node: not known before the program runs.
  static Counted variable() {
    Counted x(1.5);
    x.constant_ = false;
    return x;
  }

 private:
  bool is(double value) const { return constant_ && value_ == value; }
  static Counted result(double value) {
    ++count;
    Counted r(value);
    r.constant_ = false;
    return r;
  }
  double value_ = 0;
  bool constant_ = false;
};

struct StepFlops {
  double per_particle, per_cell;
};

template <int Dim>
StepFlops count_step_flops() {
  const Counted x = Counted::variable();
  Vector<Dim, Counted> xi;
  CellPolynomial<Dim, Counted> c, sum;
  SymmetricTensor<Dim, Counted> sigma;
  Matrix<Dim, Counted> L;
  for (int i = 0; i < Dim; ++i) xi[i] = x;
  for (int k = 0; k < c.size; ++k) c[k] = sum[k] = x;
  for (int k = 0; k < sigma.size; ++k) sigma[k] = x;
  const LinearElastic<double> material{2, 3};

  using Functions = CornerFunctions<Dim, Counted>;
  const auto momentum = [&](const Functions& N) {
    for (int i = 0; i < Dim; ++i) N.add(sum, x * x);
  };
  Counted::count = 0;
  const Functions before(xi);
  for (int i = 0; i < Dim; ++i) (void)(x + before.interpolate(c));  // sweep B: v
  momentum(before);                                                 //          and the momentum of the re-map
  static_for<Dim>([&](auto i) {                                     // sweep C: dt L
    static_for<Dim>([&](auto j) { L(i, j) = derivative_at<j, Dim>(c, xi); });
  });
  (void)material.advance(sigma, L, Counted(1));  //          stress
  (void)DeterminantVolume{}(x, L, Counted(1));   //          volume
  const Functions still(xi);
  for (int i = 0; i < Dim; ++i) (void)(xi[i] + still.interpolate(c));  //      position
  const Functions after(xi);
  after.add(sum, x);                  // sweep A: mass
  momentum(after);                    //          momentum
  const auto q = monomials<Dim>(xi);  //          force
  const Counted weight = x * x;
  for (int k = 0; k < sigma.size; ++k)
    if (Dim == 3 || k < Dim || k == 3) sigma[k] = sigma[k] * weight;
  for (int i = 0; i < Dim; ++i) {
    Vector<Dim, Counted> w;
    for (int j = 0; j < Dim; ++j) w[j] = x;
    add_gradient_moments<Dim>(sum, w, q);
  }
  StepFlops flops;
  flops.per_particle = static_cast<double>(Counted::count);
  Counted::count = 0;
  for (int n = 0; n < Dim; ++n) coefficients_from_nodes<Dim>(c);  // dt v*
  for (int n = 0; n < Dim; ++n) nodes_from_moments<Dim>(c);       // f
  flops.per_cell = static_cast<double>(Counted::count);
  return flops;
}

/// Numbers that the two sweeps must read and write per particle: B reads xi, v, m and writes v; C and A, the
/// particle staying at hand, read xi, v, m, V, sigma and write xi, V, sigma.
template <int Dim>
constexpr int step_words() {
  return (3 * Dim + 1) + (2 * Dim + 2 + symmetric_components(Dim)) + (Dim + 1 + symmetric_components(Dim));
}

}  // namespace vsb::bench
