// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What can be told of particles while cell lanes hold them: their balance, the first spoilt one, and single
/// fields by number, all as of the same particles unpacked.
#include <vsb/kernels/boundary/flag_boundary_particles.hpp>
#include <vsb/kernels/lanes/balance.hpp>
#include <vsb/kernels/lanes/health.hpp>
#include <vsb/kernels/lanes/read.hpp>

#include "both_engines.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

/// A body that has moved on from cell to cell between walls, its weight on it, with rows of material state.
template <int Dim, class Real>
struct MovedBody : BothEngines<Dim, Real> {
  UniformVirtualStress<Dim, Real> field;

  explicit MovedBody(RemapMethod remap_method = RemapMethod::chosen)
      : BothEngines<Dim, Real>({false, sizeof(Real) == 4 ? 0. : 1., true}) {
    this->remember(symmetric_components(Dim));
    Random random(7);
    edit(this->block, [&](const auto& p) {
      for (int k = 0; k < p.count(); ++k)
        for (int c = 0; c < p.stress_size; ++c) p.material_state(k, c) = random.draw<Real>(-1, 1);
    });
    auto& memory = this->lanes.memory;
    memory.remap_method = remap_method;
    for (int i = 0; i < Dim; ++i)
      memory.walls.fixed[0][0] = static_cast<ComponentMask>(memory.walls.fixed[0][0] | 1 << i);
    this->options.gravity[Dim - 1] = this->amplitude * Real(-3);
    field.count = 1;
    field.stress[0] = pressure_stress<Dim>(Real(2) * this->amplitude);
    for (int c = 3; c < field.stress[0].size; ++c) field.stress[0][c] = this->amplitude * Real(0.3);
    // Not everywhere, so that nodes with and without it are told apart.
    this->declare([](const Vector<Dim, int>& ijk) { return ijk[0] > 12 ? 1u : 0u; });
    this->run(
        elastic<Dim, Real>(), DeterminantVolume{}, [&](int) { return field; }, 60);
    REQUIRE((this->moved > 0 || sizeof(Real) == 4));
  }

  /// The unpacked particles as the particle kernels take them.
  State<Dim, Real, Device> unpacked() {
    auto s = this->state;
    s.particles = this->copy.particles;
    mark_anew(s.occupancy);
    REQUIRE(update_occupancy(Exec(), s.particles, s.occupancy, this->basis) == -1);
    return s;
  }
};

}  // namespace

TEMPLATE_TEST_CASE_SIG("the balance of lanes is that of their particles", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (2, float),
                       (3, double)) {
  for (const auto remap_method : {RemapMethod::mass_matrix, RemapMethod::second_sweep}) {
    MovedBody<Dim, Real> body(remap_method);
    auto& memory = body.lanes.memory;
    const auto sums = read(memory.nodes.data);
    const auto sums_before = std::vector<Real>(sums.data(), sums.data() + sums.span());
    const auto matrices = read(memory.lanes.mass_matrices);
    const auto matrices_before = std::vector<Real>(matrices.data(), matrices.data() + matrices.span());
    const double modulus = elastic<Dim, Real>().constrained_modulus();
    const auto check = [&](const auto& field) {
      auto state = body.unpacked();
      const auto expected = balance(Exec(), state, {{0, body.copy.particles.count(), elastic<Dim, Real>()}},
                                    body.basis, field, body.options);
      const auto found = balance(Exec(), body.lanes, modulus, field, body.options.gravity);
      const double tolerance = 10 * engine_tolerance<Real>, force = expected.internal_force;
      REQUIRE((expected.unbalanced_force > 0 && expected.kinetic_energy > 0));
      CHECK_THAT(found.unbalanced_force, WithinRel(expected.unbalanced_force, tolerance));
      CHECK_THAT(found.internal_force, WithinRel(force, tolerance));
      CHECK_THAT(found.kinetic_energy, WithinRel(expected.kinetic_energy, tolerance));
      CHECK_THAT(found.strain_energy, WithinRel(expected.strain_energy, tolerance));
      for (int i = 0; i < Dim; ++i)
        CHECK_THAT(found.net_force[i], WithinAbs(expected.net_force[i], tolerance * force));
      for (int i = 0; i < 3; ++i)
        CHECK_THAT(found.net_torque[i], WithinAbs(expected.net_torque[i], 10 * tolerance * force));
      return found;
    };
    CHECK(std::abs(check(body.field).net_force[0]) > 1e-3 * check(body.field).internal_force);
    CHECK(check(NoVirtualStress{}).net_force[0] == 0);
    const auto after = read(memory.nodes.data), matrices_after = read(memory.lanes.mass_matrices);
    CHECK(std::equal(sums_before.begin(), sums_before.end(), after.data()));
    CHECK(std::equal(matrices_before.begin(), matrices_before.end(), matrices_after.data()));
    CHECK(matrices_before.empty() == (remap_method == RemapMethod::second_sweep));
  }
}

TEMPLATE_TEST_CASE_SIG("the first spoilt particle in lanes, and its field", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, float), (3, double)) {
  MovedBody<Dim, Real> body;
  auto& memory = body.lanes.memory;
  const auto& lanes = memory.lanes;
  const auto index = index_lanes(Exec(), lanes);
  const auto entry = read(index.entry);
  const auto found = [&](int particle, ParticleField field) {
    const auto invalid = find_invalid(Exec(), memory);
    CHECK(invalid.particle == particle);
    CHECK(static_cast<int>(invalid.field) == static_cast<int>(field));
  };
  const auto spoil = [&](int p, int column, Real value) {
    edit(lanes.data, [&](const auto& host) {
      host(static_cast<size_t>(entry(static_cast<size_t>(p))), static_cast<size_t>(column)) = value;
    });
  };
  const Real nan = std::numeric_limits<Real>::quiet_NaN(), infinity = std::numeric_limits<Real>::infinity();
  const int last = body.copy.particles.count() - 1;
  // What ghosts hold is nobody's business.
  const auto id = read(lanes.id);
  const auto groups = read(lanes.groups);
  size_t ghost = 0;
  while (id(ghost) >= 0 || ghost >= lanes.end(groups(0))) ++ghost;
  REQUIRE(ghost < lanes.end(groups(0)));
  edit(lanes.data, [&](const auto& host) {
    for (int c = 0; c < lanes.columns(); ++c) host(ghost, static_cast<size_t>(c)) = nan;
  });
  found(-1, ParticleField::none);
  spoil(last, lanes.volume_column, 0);
  found(last, ParticleField::volume);
  spoil(last, lanes.stress_column + lanes.stress_size - 1, -infinity);
  found(last, ParticleField::cauchy_stress);
  spoil(last, lanes.velocity_column + Dim - 1, nan);
  found(last, ParticleField::velocity);
  spoil(last, lanes.xi_column, nan);
  found(last, ParticleField::position);
  spoil(last / 2, lanes.volume_column, Real(-1e-9));
  found(last / 2, ParticleField::volume);
  spoil(0, lanes.velocity_column, infinity);
  found(0, ParticleField::velocity);
}

TEMPLATE_TEST_CASE_SIG("single fields of particles in lanes, by number", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, float), (3, double)) {
  MovedBody<Dim, Real> body;
  const auto& memory = body.lanes.memory;
  const auto& lanes = memory.lanes;
  const auto index = index_lanes(Exec(), lanes);
  const auto expected = read(body.copy);
  const int n = expected.count(), first = n / 3, count = n / 2;  // some in the middle
  using Rows = Kokkos::View<double**, Kokkos::LayoutRight, Device>;
  const auto rows_of = [&](int columns, const auto& functor) {
    const Rows rows("vsb::rows", static_cast<size_t>(count), static_cast<size_t>(columns));
    Kokkos::parallel_for("vsb::test", Kokkos::RangePolicy<Exec>(Exec(), 0, count), functor(rows));
    return read(rows);
  };
  int wrong = 0;
  const auto positions = rows_of(Dim, [&](const Rows& rows) {
    return kernel::ReadLanePositions<Dim, Real, Device>{lanes, index, memory.grid, first, rows};
  });
  const auto stresses = rows_of(lanes.stress_size, [&](const Rows& rows) {
    return kernel::ReadLaneColumns<Dim, Real, Device>{
        lanes, index, first, lanes.stress_column, lanes.stress_size, rows};
  });
  const auto volumes = rows_of(1, [&](const Rows& rows) {
    return kernel::ReadLaneColumns<Dim, Real, Device>{lanes, index, first, lanes.volume_column, 1, rows};
  });
  for (int r = 0; r < count; ++r) {
    for (int i = 0; i < Dim; ++i)
      wrong += positions(r, i) != static_cast<double>(expected.position(first + r, i));
    for (int c = 0; c < lanes.stress_size; ++c)
      wrong += stresses(r, c) != static_cast<double>(expected.cauchy_stress(first + r, c));
    wrong += volumes(r, 0) != static_cast<double>(expected.volume(first + r));
  }
  CHECK(wrong == 0);

  const Kokkos::View<Real*, Device> strain("vsb::strain", static_cast<size_t>(n));
  Kokkos::parallel_for("vsb::test", Kokkos::RangePolicy<Exec>(Exec(), 0, lanes.group_count),
                       kernel::LanePlasticStrain<Dim, Real, Device>{lanes, strain});
  const auto measure = read(strain);
  const auto points = unpack_mass_points(Exec(), memory);
  const auto position = read(points.position), mass = read(points.mass);
  REQUIRE(points.count() == n);
  for (int p = 0; p < n; ++p) {
    SymmetricTensor<Dim, Real> plastic;
    for (int c = 0; c < plastic.size; ++c) plastic[c] = expected.material_state(p, c);
    wrong += measure(p) != equivalent_plastic_deviatoric_strain(plastic);
    for (int i = 0; i < Dim; ++i) wrong += position(p, i) != expected.position(p, i);
    wrong += mass(p) != expected.mass(p);
  }
  CHECK(wrong == 0);

  // Flags follow the lanes' own marks: those of the particle kernels where these find a particle in the same
  // cell.
  const Kokkos::View<unsigned char*, Device> flag("vsb::flags", static_cast<size_t>(count)),
      by_particles("vsb::flags", static_cast<size_t>(n));
  Kokkos::parallel_for(
      "vsb::test", Kokkos::RangePolicy<Exec>(Exec(), 0, count),
      kernel::FlagLaneParticle<Dim, Real, Device>{lanes, index, body.lanes.boundary.tractions, first, flag});
  const auto state = body.unpacked();
  flag_boundary_particles(Exec(), state.particles, state.occupancy.boundary, body.basis, by_particles);
  const auto mine = read(flag), theirs = read(by_particles);
  int flagged = 0;
  for (int r = 0; r < count; ++r) {
    wrong += mine(r) != theirs(first + r);
    flagged += mine(r);
  }
  CHECK(wrong == 0);
  CHECK(flagged > 0);
  CHECK(flagged < count);
}
