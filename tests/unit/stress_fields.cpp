// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Stress fields: their divergence against finite differences, hand values, continuity, and their sums.
#include <vsb/physics/traction_fields.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

/// Components that are all different.
template <int Dim>
SymmetricTensor<Dim, double> tensor(double first, double step) {
  SymmetricTensor<Dim, double> s;
  for (int c = 0; c < s.size; ++c) s[c] = first + step * c * c;
  return s;
}

template <int Dim>
Vector<Dim, double> vector(double first, double step) {
  Vector<Dim, double> v;
  for (int i = 0; i < Dim; ++i) v[i] = first + step * i;
  return v;
}

template <int Dim>
Vector<Dim, double> unit(Vector<Dim, double> v) {
  const double length = std::sqrt(dot(v, v));
  for (int i = 0; i < Dim; ++i) v[i] /= length;
  return v;
}

/// One field of every kind, with values, slopes and directions that tell the components apart.
template <int Dim>
std::vector<StressField<Dim, double>> one_of_each() {
  std::vector<StressField<Dim, double>> fields;
  fields.push_back(UniformStress<Dim, double>{tensor<Dim>(2, 1)});
  AffineStress<Dim, double> affine{tensor<Dim>(-1, 0.5), {}};
  for (int k = 0; k < Dim; ++k) affine.gradient[k] = tensor<Dim>(3 + k, 0.7 - k);
  fields.push_back(affine);
  fields.push_back(HydrostaticStress<Dim, double>{9.5, 0.1, 0.7, unit(vector<Dim>(0.3, 0.4))});
  const auto one = vector<Dim>(1, 0);
  fields.push_back(RadialBlend<Dim, double>{vector<Dim>(0.2, -0.3), one, 0.4, 1.1, tensor<Dim>(4, -0.5),
                                            tensor<Dim>(-2, 0.25)});
  auto about_last = one;
  about_last[Dim - 1] = Dim == 3 ? 0 : 1;
  fields.push_back(RadialBlend<Dim, double>{vector<Dim>(0.2, -0.3), about_last, 0.3, 0.9, tensor<Dim>(1, 1),
                                            tensor<Dim>(0, -1)});
  fields.push_back(PlanarBlend<Dim, double>{vector<Dim>(-0.5, 0.2), vector<Dim>(0.6, 0.5), tensor<Dim>(1, 2),
                                            tensor<Dim>(-3, 0.5)});
  if constexpr (Dim == 2) fields.push_back(ExactEllipse<double>{0.15, 0.1, 2.0, 1.0, 0.5, 0.3});
  return fields;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("the divergence is that of the stress", "", ((int Dim), Dim), 1, 2, 3) {
  const double d = 1e-5;
  for (const auto& field : one_of_each<Dim>()) {
    Random random(3);
    int checked = 0;
    for (int n = 0; n < 400; ++n) {
      Vector<Dim, double> x;
      for (int i = 0; i < Dim; ++i) x[i] = random(-1.6, 1.6);
      if (dot(x, x) < 0.09) continue;  // the hole of the ellipse
      auto difference = Vector<Dim, double>::zero();
      bool smooth = true;  // no kink within d
      for (int j = 0; j < Dim; ++j) {
        auto lower = x, upper = x;
        lower[j] -= d;
        upper[j] += d;
        const auto below = field.at(lower), above = field.at(upper);
        for (int i = 0; i < Dim; ++i) {
          difference[i] += (above.stress(i, j) - below.stress(i, j)) / (2 * d);
          smooth = smooth && std::abs(above.divergence[i] - below.divergence[i]) < 1e-2;
        }
      }
      if (!smooth) continue;
      ++checked;
      for (int i = 0; i < Dim; ++i) CHECK_THAT(field.at(x).divergence[i], WithinAbs(difference[i], 1e-6));
    }
    CHECK(checked > 300);
  }
}

namespace {

/// The largest change of a component from one point to the next on a way of so many steps.
template <int Dim>
double largest_change(const StressField<Dim, double>& field, const Vector<Dim, double>& from,
                      const Vector<Dim, double>& along, int steps) {
  double most = 0;
  auto before = field.at(from).stress;
  for (int s = 1; s <= steps; ++s) {
    const auto now = field.at(from + (double(s) / steps) * along).stress;
    for (int c = 0; c < now.size; ++c) most = std::max(most, std::abs(now[c] - before[c]));
    before = now;
  }
  return most;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("fields have no jump anywhere", "", ((int Dim), Dim), 1, 2, 3) {
  for (const auto& field : one_of_each<Dim>()) {
    Random random(4);
    for (int ray = 0; ray < 20; ++ray) {
      Vector<Dim, double> from, along;
      for (int i = 0; i < Dim; ++i) {
        from[i] = random(0.3, 0.5);  // clear of the hole of the ellipse
        along[i] = random(0.0, 1.2);
      }
      // Steps of a quarter change it by a quarter; a jump stays.
      const double coarse = largest_change(field, from, along, 500);
      CHECK(largest_change(field, from, along, 2000) <= 0.3 * coarse + 1e-14);
    }
  }
}

TEST_CASE("affine stress by hand") {
  // sbar = value + x dx + y dy with components xx yy zz xy: fbar = (dxx/dx + dxy/dy, dxy/dx + dyy/dy).
  const AffineStress<2, double> field{{{1, 2, 3, 4}}, {{{10, 20, 30, 40}}, {{100, 200, 300, 400}}}};
  const auto bar = field.at({{0.5, 0.25}});
  for (int c = 0; c < 4; ++c) CHECK(bar.stress[c] == (c + 1) * (1 + 5 + 25));
  CHECK(bar.divergence[0] == 10 + 400);
  CHECK(bar.divergence[1] == 40 + 200);
}

TEST_CASE("water at rest by hand") {
  const HydrostaticStress<2, double> kink{10, 2, 0, {{0, 1}}}, wide{10, 2, 0.5, {{0, 1}}};
  for (const auto& water : {kink, wide}) {
    const auto deep = water.at({{7, -1}});
    for (int c = 0; c < 3; ++c) CHECK(deep.stress[c] == -30);
    CHECK(deep.stress[3] == 0);
    CHECK(deep.divergence[0] == 0);
    CHECK(deep.divergence[1] == 10);
    for (int c = 0; c < 4; ++c) CHECK(water.at({{7, 2.25}}).stress[c] == 0);
    CHECK(water.at({{7, 2.25}}).divergence[1] == 0);
  }
  CHECK(wide.at({{0, 2}}).stress[0] == -10 * 0.5 / 8);
  CHECK(wide.at({{0, 2}}).divergence[1] == 5);
  // Down along x in 1D.
  const HydrostaticStress<1, double> down{10, -1, 0, {{-1}}};  // x = 1 is the surface
  CHECK(down.at({{3}}).stress[0] == -20);
  CHECK(down.at({{3}}).divergence[0] == -10);
}

TEST_CASE("a column of particles displaces the water up to the level, wherever that is") {
  const double w = 0.25;
  for (const double level : {0.9, 1.0, 1.03, 1.1249, 1.125, 1.2, 1.7}) {
    const HydrostaticStress<1, double> water{10, level, w, {{1}}};
    double force = 0;
    for (int p = 0; p < 8; ++p) force += w * water.at({{w * (p + 0.5)}}).divergence[0];
    CHECK_THAT(force, WithinRel(10 * level, 1e-14));
  }
}

TEST_CASE("radial and planar blends by hand") {
  const SymmetricTensor<2, double> p{{-8, -8, -8, 0}}, q{{0, 4, 2, 4}};
  const RadialBlend<2, double> ring{{{1, 2}}, {{1, 1}}, 1, 3, p, q};
  const auto middle = ring.at({{1, 4}});  // r = 2, e_r = (0, 1)
  const double mean[] = {-4, -2, -3, 2};
  for (int c = 0; c < 4; ++c) CHECK(middle.stress[c] == mean[c]);
  CHECK(middle.divergence[0] == -0.5 * (0 - 4));  // -1 / (b - a) (S_inner - S_outer) e_r
  CHECK(middle.divergence[1] == -0.5 * (-8 - 4));
  CHECK(ring.at({{1, 2}}).stress[0] == -8);  // on the axis
  CHECK(ring.at({{1, 2}}).divergence[0] == 0);
  CHECK(ring.at({{1, 9}}).stress[3] == 4);

  const RadialBlend<3, double> pipe{{{0, 5, 0}},
                                    {{1, 0, 1}},
                                    1,
                                    2,
                                    SymmetricTensor<3, double>::isotropic(-6),
                                    SymmetricTensor<3, double>::zero()};
  CHECK(pipe.at({{0, -77, 1.5}}).stress[1] == -3);
  CHECK(pipe.at({{0, -77, 1.5}}).divergence[2] == 6);
  CHECK(pipe.at({{0, -77, 1.5}}).divergence[1] == 0);

  const RadialBlend<1, double> wall{{{1}}, {{1}}, 1, 3, {{-6, -6, -6}}, {{0, 0, 0}}};  // two planes
  CHECK(wall.at({{3}}).divergence[0] == 3);
  CHECK(wall.at({{-1}}).divergence[0] == -3);

  const PlanarBlend<2, double> slab{{{1, 0}}, {{0, 4}}, p, q};
  CHECK(slab.at({{-3, 1}}).stress[0] == -6);
  CHECK(slab.at({{-3, 1}}).divergence[0] == 1);  // (xy of q - p) / 4
  CHECK(slab.at({{-3, 1}}).divergence[1] == 3);  // (yy of q - p) / 4
  CHECK(slab.at({{-3, -1}}).stress[0] == -8);
  CHECK(slab.at({{-3, 4.5}}).stress[3] == 4);
}

TEMPLATE_TEST_CASE_SIG("the fields of a mask add up, each with its factor", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, float), (2, double),
                       (3, double)) {
  TractionFields<Dim, Real> fields;
  // Not a constant: g++ 12.2 for AVX-512 folds a constant times {1, 1, 1, 0, 0, 0} to {2, 2, 2, 2, 0, 0}.
  const auto one = SymmetricTensor<Dim, Real>::isotropic(Random(1).draw<Real>(1, 1));
  fields.count = 3;
  fields.field[0] = UniformStress<Dim, Real>{one};
  fields.field[1] = AffineStress<Dim, Real>{Real(2) * one, {}};
  auto up = Vector<Dim, Real>::zero();
  up[Dim - 1] = 1;
  fields.field[2] = HydrostaticStress<Dim, Real>{4, 10, 0, up};
  for (int k = 0; k < 3; ++k) fields.factor[k] = static_cast<Real>(k + 1);
  const auto x = Vector<Dim, Real>::zero();
  for (TractionMask mask = 0; mask < 16; ++mask) {
    const double expected = (mask & 1 ? 1 : 0) + (mask & 2 ? 4 : 0) - (mask & 4 ? 120 : 0);
    const auto bar = fields.at(x, mask);
    for (int c = 0; c < bar.stress.size; ++c) CHECK(bar.stress[c] == (c < 3 ? expected : 0));
    CHECK(bar.divergence[Dim - 1] == (mask & 4 ? 12 : 0));
  }
  fields.balanced = 2;
  for (int i = 0; i < Dim; ++i) fields.balance.constant[i] = 5;
  CHECK(fields.at(x, 1).divergence[0] == 0);
  CHECK(fields.at(x, 2).divergence[0] == 5);
}

namespace {
struct Shear {
  double slope;
  KOKKOS_FUNCTION VirtualStressValue<2, double> operator()(const Vector<2, double>& x) const {
    return {{{0, 0, 0, slope * x[0]}}, {{0, slope}}};
  }
};
}  // namespace

TEST_CASE("a function of one's own acts where a traction is declared") {
  const auto field = virtual_stress_of(Shear{3});
  static_assert(decltype(field)::loaded && !decltype(field)::cell_quadrature);
  CHECK(field.at(Vector<2, double>{{2, 0}}, 4).stress[3] == 6);
  CHECK(field.at(Vector<2, double>{{2, 0}}, 4).divergence[1] == 3);
  CHECK(field.at(Vector<2, double>{{2, 0}}, 0).stress[3] == 0);
}
