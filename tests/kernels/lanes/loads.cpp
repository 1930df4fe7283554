// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// 100 steps on cell lanes are 100 steps of the particle kernels: tractions on boundary particles, material
/// points and nodes, and by the original virtual stress boundary method.
#include <cstdio>
#include <vsb/physics/traction_fields.hpp>

#include "both_engines.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

template <int Dim, class Real>
using Uniform = UniformVirtualStress<Dim, Real>;

/// Three tractions that grow by the step.
template <int Dim, class Real>
Uniform<Dim, Real> three_stresses(Real amplitude, int n) {
  constexpr double values[6] = {-2, 1, 0.5, 0.7, -0.4, 0.3};
  Uniform<Dim, Real> f;
  f.count = 3;
  f.stress[0] = pressure_stress<Dim>(Real(2));
  f.stress[1] = pressure_stress<Dim>(Real(-1));
  for (int c = 0; c < f.stress[2].size; ++c) f.stress[2][c] = static_cast<Real>(values[c]);
  for (int k = 0; k < 3; ++k) f.stress[k] = amplitude * static_cast<Real>(0.01 * (n + 20)) * f.stress[k];
  return f;
}

/// The same, but in the place of the second one a blend between two pressures about the cavity of
/// BothEngines' body.
template <int Dim, class Real>
TractionFields<Dim, Real> three_fields(const UniformGrid<Dim, Real>& grid, Real amplitude, int n) {
  TractionFields<Dim, Real> f;
  const auto uniform = three_stresses<Dim, Real>(amplitude, n);
  Vector<Dim, Real> centre, across;
  for (int i = 0; i < Dim; ++i) {
    centre[i] = grid.lower[i] + Real(6.7) * grid.spacing[i];
    across[i] = Real(1);
  }
  f.count = 3;
  f.field[0] = UniformStress<Dim, Real>{uniform.stress[0]};
  f.field[1] = RadialBlend<Dim, Real>{centre,
                                      across,
                                      grid.spacing[0],
                                      3 * grid.spacing[0],
                                      pressure_stress<Dim>(amplitude),
                                      pressure_stress<Dim>(-amplitude)};
  f.field[2] = UniformStress<Dim, Real>{uniform.stress[2]};
  f.factor[0] = f.factor[2] = Real(1);
  f.factor[1] = static_cast<Real>(0.01 * (n + 20));
  return f;
}

/// `count` points of every carrier: boundary particles near particles, some of them in void cells, a few far
/// away, material points, and nodes; under one or two of three tractions.
template <int Dim, class Real>
SurfacePoints<Dim, Real, Device> points_of_all_kinds(const BothEngines<Dim, Real>& engines, int count) {
  const auto& basis = engines.basis;
  const auto& grid = basis.grid;
  const auto particles = read(engines.block);
  const auto points =
      allocate_surface_points<Dim, Real, Device>(3 * count, basis.node_count(), basis.bin_count());
  Random random(17);
  const auto x = read(points.position), a = read(points.area);
  const auto tractions = read(points.tractions);
  const auto carrier = read(points.carrier);
  for (int b = 0; b < 3 * count; ++b) {
    const int kind = b % 3, p = random.index(particles.count());
    const bool far_away = b % 21 == 0;
    carrier(b) = kind == 0   ? static_cast<int>(carried_by_grid)
                 : kind == 1 ? p
                             : static_cast<int>(carried_by_none);
    for (int i = 0; i < Dim; ++i) {
      const Real h = grid.spacing[i];
      if (kind == 2)
        x(b, i) = grid.lower[i] + h * static_cast<Real>(random.index(i == 0 ? 26 : 10));
      else
        x(b, i) = particles.position(p, i);
      if (kind == 0) x(b, i) += h * random.draw<Real>(-0.5, 0.5);
      if (far_away && i == 0) x(b, i) = grid.lower[i] + h * random.draw<Real>(28, 37);
      a(b, i) = random.draw<Real>(-0.02, 0.02);
    }
    tractions(b) = 1u + static_cast<unsigned>(b % 5);
  }
  Kokkos::deep_copy(points.position, x);
  Kokkos::deep_copy(points.area, a);
  Kokkos::deep_copy(points.tractions, tractions);
  Kokkos::deep_copy(points.carrier, carrier);
  return points;
}

template <int Dim, class Real>
using Original = OriginalVirtualStress<Uniform<Dim, Real>, UniformGrid<Dim, Real>, Device>;

/// Tractions 1 and 2 by the original method, traction 0 by the modified one, at nodes of eight kinds.
template <int Dim, class Real>
void declare_both_methods(BothEngines<Dim, Real>& engines) {
  engines.declare([](const Vector<Dim, int>& ijk) {
    TractionMask mask = 0;
    for (int i = 0; i < Dim; ++i) mask ^= static_cast<TractionMask>((ijk[i] + i) / 2 % 8);
    return mask;
  });
  engines.lanes.original = 6;
}

/// The bits of 60 steps of a moving body under loads of all these kinds.
template <int Dim, class Real>
std::uint64_t state_hash() {
  BothEngines<Dim, Real> engines({false, 5});
  declare_both_methods(engines);
  engines.surface = points_of_all_kinds(engines, 100);
  const auto f = three_stresses<Dim, Real>(engines.amplitude, 100);
  auto modified = f;
  modified.stress[1] = modified.stress[2] = SymmetricTensor<Dim, Real>::zero();
  engines.run_with_loads(
      elastic<Dim, Real>(), DeterminantVolume{},
      [&](int) {
        return Original<Dim, Real>{f, engines.basis.grid, engines.state.occupancy.cells, 6, 2};
      },
      [&](int) { return modified; }, [&](int) { return add_lane_loads(Exec(), engines.lanes, f); }, 60);
  REQUIRE(engines.moved > 20);
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a
  const auto add = [&](const auto& view) {
    const auto host = read(view);
    for (size_t k = 0; k < host.span() * sizeof(*host.data()); ++k)
      hash = (hash ^ reinterpret_cast<const unsigned char*>(host.data())[k]) * 1099511628211u;
  };
  add(engines.copy.block);
  add(engines.lanes.surface.xi);
  add(engines.lanes.surface.area);
  return hash;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("boundary particles, material points and nodes under tractions", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (2, float), (3, float)) {
  for (const bool equal_spacing : {false, true}) {
    BothEngines<Dim, Real> engines({equal_spacing, sizeof(Real) == 4 ? 0. : 5.});
    engines.surface = points_of_all_kinds(engines, 100);
    const auto cells_before = read(pack_surface_points(Exec(), engines.surface, engines.basis.grid).cell);
    const auto field_at = [&](int n) {
      return three_fields<Dim, Real>(engines.basis.grid, engines.amplitude, n);
    };
    engines.run_with_loads(
        elastic<Dim, Real>(), DeterminantVolume{},
        [&](int n) { return OnSurfacePoints<TractionFields<Dim, Real>>{field_at(n)}; },
        [](int) { return NoVirtualStress{}; },
        [&](int n) { return add_lane_loads(Exec(), engines.lanes, field_at(n)); });
    CAPTURE(equal_spacing, engines.moved);
    check_same(engines);
    // The points themselves: where they are and how large; material points are where their particles are.
    const auto theirs = read(engines.state.surface.position), their_area = read(engines.state.surface.area);
    const auto mine = allocate_surface_points<Dim, Real, Device>(300, 1, 1);
    Kokkos::deep_copy(mine.position, engines.surface.position);
    Kokkos::deep_copy(mine.area, engines.surface.area);
    unpack_surface_points(Exec(), engines.lanes.surface, engines.basis.grid, mine);
    const auto x = read(mine.position), a = read(mine.area);
    const auto cells = read(engines.lanes.surface.cell);
    const auto carrier = read(engines.surface.carrier);
    const auto particles = read(engines.copy);
    double off = 0, area_off = 0, from_particle = 0;
    int changed = 0;
    for (int b = 0; b < 300; ++b) {
      bool moved = false;
      for (int i = 0; i < Dim; ++i) {
        const double h = engines.basis.grid.spacing[i];
        off = std::max(off, std::abs(static_cast<double>(x(b, i) - theirs(b, i))) / h);
        area_off = std::max(area_off, std::abs(static_cast<double>(a(b, i) - their_area(b, i))) / 0.02);
        if (carrier(b) >= 0)
          from_particle = std::max(
              from_particle, std::abs(static_cast<double>(x(b, i) - particles.position(carrier(b), i))) / h);
        moved = moved || cells(b, i) != cells_before(b, i);
      }
      changed += moved;
    }
    // A boundary particle in a void cell feels in full the velocity of nodes with little mass, to which the
    // position of a particle beside a face is rounded in the grid.
    CHECK(off < 10 * engine_tolerance<Real>);
    CHECK(area_off < engine_tolerance<Real>);
    CHECK(from_particle < engine_tolerance<Real>);
    if (sizeof(Real) == 8) {
      CHECK(engines.moved > 10);
      CHECK(changed > 10);
    }
  }
}

TEMPLATE_TEST_CASE_SIG("the original method beside the modified one", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (2, float), (3, float)) {
  for (const bool uniform : {true, false}) {
    BothEngines<Dim, Real> engines({!uniform, sizeof(Real) == 4 ? 0. : 5.});
    declare_both_methods(engines);
    const auto run = [&](const auto& field_at, const auto& without_original) {
      engines.run_with_loads(
          elastic<Dim, Real>(), DeterminantVolume{},
          [&](int n) {
            using Field = std::decay_t<decltype(field_at(0))>;
            return OriginalVirtualStress<Field, UniformGrid<Dim, Real>, Device>{
                field_at(n), engines.basis.grid, engines.state.occupancy.cells, 6, 2};
          },
          [&](int n) { return without_original(field_at(n)); },
          [&](int n) { return add_lane_loads(Exec(), engines.lanes, field_at(n)); });
    };
    if (uniform)
      run([&](int n) { return three_stresses<Dim, Real>(engines.amplitude, n); },
          [](auto f) {
            f.stress[1] = f.stress[2] = SymmetricTensor<Dim, Real>::zero();
            return f;
          });
    else
      run([&](int n) { return three_fields<Dim, Real>(engines.basis.grid, engines.amplitude, n); },
          [](auto f) {
            f.factor[1] = f.factor[2] = Real(0);
            return f;
          });
    CAPTURE(uniform, engines.moved);
    check_same(engines);
    engines.check_boundary();
    CHECK(engines.load_seen[static_cast<int>(GroupLoad::mixed)]);
  }
}

TEMPLATE_TEST_CASE_SIG("the original method alone keeps up the boundary", "", ((int Dim), Dim), 1, 2, 3) {
  BothEngines<Dim, double> engines({false, 1.5});
  engines.declare_everywhere(1);
  engines.lanes.original = 1;
  const auto field_at = [](int n) { return three_stresses<Dim, double>(1, n); };
  engines.run_with_loads(
      elastic<Dim, double>(), DeterminantVolume{},
      [&](int n) {
        return Original<Dim, double>{field_at(n), engines.basis.grid, engines.state.occupancy.cells, 1, 3};
      },
      [](int) { return NoVirtualStress{}; },
      [&](int n) { return add_lane_loads(Exec(), engines.lanes, field_at(n)); });
  check_same(engines);
  engines.check_boundary();
  CHECK(engines.moved > 0);
}

TEST_CASE("a surface point that leaves the grid is reported") {
  BothEngines<2, double> engines({});
  const auto& grid = engines.basis.grid;
  engines.surface = points_of_all_kinds(engines, 2);
  auto& lanes = engines.lanes;
  const auto points = pack_surface_points(Exec(), engines.surface, grid);
  edit(points.cell, [&](const auto& cell) { cell(4, 1) = grid.cells[1]; });
  REQUIRE(pack_lanes(Exec(), engines.block.particles, lanes) == -1);
  lanes.surface = points;
  prepare_lane_step(Exec(), lanes, NoVirtualStress{});
  const auto before = read(lanes.memory.nodes.data);
  CHECK(add_lane_loads(Exec(), lanes, three_stresses<2, double>(1, 0)) == 4);
  const auto after = read(lanes.memory.nodes.data);
  CHECK(std::equal(before.data(), before.data() + before.span(), after.data()));
  edit(points.cell, [&](const auto& cell) { cell(4, 1) = grid.cells[1] - 1; });  // outside the box: no load
  CHECK(add_lane_loads(Exec(), lanes, three_stresses<2, double>(1, 0)) == -1);
}

TEST_CASE("print state hashes of loads on cell lanes", "[.][state_hashes]") {  // run by kernels/same_bits.py
  std::printf("hash %016llx\n", static_cast<unsigned long long>(state_hash<2, double>()));
  std::printf("hash %016llx\n", static_cast<unsigned long long>(state_hash<3, double>()));
}
