// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Virtual stress at all active nodes: resultants on closed bodies of any shape anywhere on the grid, and
/// bodies in equilibrium with the field.
#include <vsb/kernels/boundary/self_balance.hpp>
#include <vsb/physics/traction_fields.hpp>

#include "random_body.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

template <int Dim>
TractionFields<Dim, double> one_field(const StressField<Dim, double>& field) {
  TractionFields<Dim, double> fields;
  fields.count = 1;
  fields.field[0] = field;
  fields.factor[0] = 1;
  return fields;
}

template <int Dim>
AffineStress<Dim, double> some_affine_stress() {
  AffineStress<Dim, double> field;
  for (int c = 0; c < field.value.size; ++c) {
    field.value[c] = 1.0 - 0.3 * c;
    for (int k = 0; k < Dim; ++k) field.gradient[k][c] = 0.2 + 0.1 * k - 0.07 * c * (k + 1);
  }
  return field;
}

/// The cross product x x f, of vectors in up to three dimensions.
template <int Dim>
Vector<3, double> cross(const Vector<Dim, double>& x, const Vector<Dim, double>& f) {
  auto a = Vector<3, double>::zero(), b = a, c = a;
  for (int i = 0; i < Dim; ++i) {
    a[i] = x[i];
    b[i] = f[i];
  }
  for (int i = 0; i < 3; ++i) c[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
  return c;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("a pressure on a closed body has no resultant at all nodes", "", ((int Dim), Dim), 2,
                       3) {
  double worst_boundary = 0;
  for (unsigned seed = 0; seed < 10; ++seed) {
    RandomBody<Dim> body(seed);
    UniformVirtualStress<Dim, double> pressure;
    pressure.count = 1;
    pressure.stress[0] = pressure_stress<Dim>(3.0);
    const double scale = 3 * body.area;
    const auto all = body.resultant(pressure, true), boundary = body.resultant(pressure, false);
    CHECK(length(all.net_force) < 1e-13 * scale);
    CHECK(length(all.net_torque) < 1e-12 * scale * body.half_width);
    worst_boundary = std::max(worst_boundary, length(boundary.net_force) / scale);
  }
  CHECK(worst_boundary > 1e-3);  // what the mode is for
}

TEMPLATE_TEST_CASE_SIG("the resultant of an affine stress is its divergence times the volume", "",
                       ((int Dim), Dim), 1, 2, 3) {
  for (unsigned seed = 20; seed < 26; ++seed) {
    RandomBody<Dim> body(seed);
    const auto affine = some_affine_stress<Dim>();
    const auto b = body.resultant(one_field<Dim>(affine), true);
    Vector<Dim, double> expected = Vector<Dim, double>::zero(), centroid = expected;
    const auto p = read(body.block);
    const double V = body.volume();
    for (int i = 0; i < Dim; ++i) {
      for (int k = 0; k < Dim; ++k) expected[i] += V * affine.gradient[k](i, k);
      for (int n = 0; n < p.count(); ++n) centroid[i] += p.volume(n) / V * p.position(n, i);
    }
    for (int i = 0; i < Dim; ++i) CHECK_THAT(b.net_force[i], WithinAbs(expected[i], 1e-12 * body.area));
    if (Dim == 1) continue;
    const auto torque = cross(centroid, expected);
    for (int i = 0; i < 3; ++i) CHECK_THAT(b.net_torque[i], WithinAbs(torque[i], 1e-11 * body.area));
  }
}

TEMPLATE_TEST_CASE_SIG("a self-balanced blend has no resultant, wherever its kinks are", "", ((int Dim), Dim),
                       1, 2, 3) {
  double worst = 0;
  for (unsigned seed = 40; seed < 46; ++seed) {
    RandomBody<Dim> body(seed);
    Vector<Dim, double> across;
    for (int i = 0; i < Dim; ++i) across[i] = 1;
    auto fields = one_field<Dim>(RadialBlend<Dim, double>{
        body.center, across, 0.6, 1.9, pressure_stress<Dim>(2.0), SymmetricTensor<Dim, double>::zero()});
    const double scale = 2 * body.area;
    worst = std::max(worst, length(body.resultant(fields, true).net_force) / scale);
    auto near = body.center;
    near[0] += 0.3;
    fields.balance = balancing_force(Exec(), body.block.particles, fields, 1, near);
    fields.balanced = 1;
    const auto b = body.resultant(fields, true);
    CHECK(length(b.net_force) < 1e-13 * scale);
    CHECK(length(b.net_torque) < 1e-12 * scale * body.half_width);
  }
  CHECK(worst > 1e-4);
}

TEST_CASE("particles on a line are balanced without a spin about it") {
  const UniformGrid<3, double> grid({{0, 0, 0}}, {{1, 1, 1}}, {{6, 6, 6}});
  const auto block = allocate_particles<3, double, Device>(4);
  edit(block, [](const auto& p) {
    for (int k = 0; k < 4; ++k) {
      p.position(k, 0) = 2.3 + 0.4 * k;
      p.position(k, 1) = p.position(k, 2) = 2.5;
      p.mass(k) = p.volume(k) = 1;
    }
  });
  const auto fields = one_field<3>(some_affine_stress<3>());
  const auto force = balancing_force(Exec(), block.particles, fields, 1, Vector<3, double>{{2, 2, 2}});
  const auto divergence = fields.at(Vector<3, double>{{0, 0, 0}}, 1).divergence;
  for (int i = 0; i < 3; ++i) {
    CHECK_THAT(force.constant[i], WithinAbs(-divergence[i], 1e-14));
    for (int j = 0; j < 3; ++j) CHECK(force.spin(i, j) == 0);
  }
}

TEMPLATE_TEST_CASE_SIG("a neutrally buoyant body that begins in equilibrium stays at rest", "",
                       ((int Dim), Dim), 2, 3) {
  for (const bool at_all_active_nodes : {true, false}) {
    if (!at_all_active_nodes && Dim == 3) continue;
    RandomBody<Dim> body(7, Dim == 2 ? 6 : 3);
    const auto affine = some_affine_stress<Dim>();
    const auto fields = one_field<Dim>(affine);
    StepOptions<Dim, double> options{};
    const double density = 2;
    edit(body.block, [&](const auto& p) {
      for (int k = 0; k < p.count(); ++k) {
        p.mass(k) = density * p.volume(k);
        const auto stress = affine.at(p.position_of(k)).stress;
        for (int c = 0; c < stress.size; ++c) p.cauchy_stress(k, c) = stress[c];
      }
    });
    const auto divergence = affine.at(Vector<Dim, double>::zero()).divergence;
    for (int i = 0; i < Dim; ++i) options.gravity[i] = -divergence[i] / density;
    const auto rock = LinearElastic<double>::from_young(100, 0.3);
    const std::vector<Body<double>> bodies{{0, body.block.particles.count(), rock}};
    options.dt = time_step(0.5, 1, rock.constrained_modulus(), density);
    auto state = make_state(body.block.particles, body.basis);
    Kokkos::deep_copy(state.occupancy.tractions, 1u);
    state.occupancy.at_all_active_nodes = at_all_active_nodes ? 1 : 0;
    const auto start = read(body.block);
    const int steps = at_all_active_nodes ? 1000 : 20;
    for (int n = 0; n < steps; ++n) REQUIRE(step(Exec(), state, bodies, body.basis, fields, options) == -1);
    const auto p = read(body.block);
    double fastest = 0, farthest = 0;
    for (int k = 0; k < p.count(); ++k)
      for (int i = 0; i < Dim; ++i) {
        fastest = std::max(fastest, std::abs(p.velocity(k, i)));
        farthest = std::max(farthest, std::abs(p.position(k, i) - start.position(k, i)));
      }
    const double fall = length(options.gravity) * steps * options.dt;  // what gravity alone would make of it
    if (at_all_active_nodes) {
      CHECK(fastest < 1e-12 * fall);
      CHECK(farthest < 1e-12 * fall * steps * options.dt);
    } else {
      CHECK(fastest > 1e-3 * fall);  // at the boundary nodes alone the divergence does not carry the body
    }
  }
}
