// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Runs of both engines that the tests of several bases have in common; `Engines` is a BothEngines.
#pragma once

#include "both_engines.hpp"
#include "four_fields.hpp"

namespace vsb::test {

template <int Dim, class Real>
SymmetricTensor<Dim, Real> full_tensor() {
  constexpr double values[6] = {-2, 1, 0.5, 0.7, -0.4, 0.3};
  SymmetricTensor<Dim, Real> s;
  for (int c = 0; c < s.size; ++c) s[c] = static_cast<Real>(values[c]);
  return s;
}

/// Other tractions from node to node.
template <int Dim>
TractionMask striped(const Vector<Dim, int>& ijk) {
  TractionMask mask = 0;
  for (int i = 0; i < Dim; ++i)
    mask |= static_cast<TractionMask>((ijk[i] + 3) / (1 + i) % 3 == 1 ? 1 << i : 0) | (ijk[i] > 6 ? 2u : 0u);
  return mask;
}

template <int Dim, class Real>
UniformVirtualStress<Dim, Real> four_uniform_stresses(Real amplitude) {
  UniformVirtualStress<Dim, Real> f;
  f.count = 4;
  for (int k = 0; k < f.count; ++k)
    f.stress[k] = amplitude * static_cast<Real>(0.5 - 0.3 * k) * full_tensor<Dim, Real>();
  f.stress[3] = pressure_stress<Dim>(amplitude);
  return f;
}

/// A hash of all numbers of a block of particles (FNV-1a).
template <int Dim, class Real>
std::uint64_t hash_of(const ParticleBlock<Dim, Real, Device>& particles) {
  std::uint64_t hash = 14695981039346656037u;
  const auto host = host_copy(particles).block;
  for (size_t k = 0; k < host.span() * sizeof(Real); ++k)
    hash = (hash ^ reinterpret_cast<const unsigned char*>(host.data())[k]) * 1099511628211u;
  return hash;
}

/// Without load, cells cubes or not, at rest and moving.
template <int Dim, class Real, class Engines>
void check_free_bodies() {
  for (const bool equal_spacing : {true, false})
    for (const double drift : {0., 5.}) {
      if (sizeof(Real) == 4 && drift > 0) continue;
      Engines engines({equal_spacing, drift});
      // In single precision the direction in which a node turns around, and damping acts, hangs on round-off.
      engines.options.damping = drift > 0 || sizeof(Real) == 4 ? Real(0) : Real(0.05);
      engines.options.gravity[Dim - 1] = -engines.amplitude;
      engines.run(elastic<Dim, Real>(), DeterminantVolume{}, [](int) { return NoVirtualStress{}; });
      CAPTURE(equal_spacing, drift, engines.moved);
      check_same(engines);
      CHECK((engines.moved > 10 || drift == 0));
      CHECK((engines.lanes.repacked > 0 || drift == 0 || Dim == 1));
    }
}

/// Positions by the velocity before the re-map, as in the paper: other positions than by the re-mapped one,
/// the same on both engines. On cells that are cubes or not; with surface points none of the lanes' own.
template <int Dim, class Real, class Engines>
void check_grid_velocity() {
  for (const bool equal_spacing : {true, false}) {
    const auto run = [&](PositionVelocity position_velocity) {
      Engines engines({equal_spacing, sizeof(Real) == 4 ? 0. : 2.});
      engines.options.position_velocity = position_velocity;
      engines.declare_everywhere(1);
      UniformVirtualStress<Dim, Real> f;
      f.count = 1;
      f.stress[0] = pressure_stress<Dim>(engines.amplitude);
      engines.run(elastic<Dim, Real>(), DeterminantVolume{}, [&](int) { return f; });
      check_same(engines);
      return engines;
    };
    const auto strain = run(PositionVelocity::strain), grid = run(PositionVelocity::grid);
    // What single precision shows of bodies that hardly move is round-off.
    const double moved_apart = difference(read(strain.copy), read(grid.copy), strain.grid).position;
    CHECK((moved_apart > 1e-9 * strain.amplitude || sizeof(Real) == 4));
  }
}

/// With a share of PIC in the velocities, on cells that are cubes or not: other velocities than without, the
/// same on both engines. set_up gets the engines before the run.
template <int Dim, class Real, class Engines, class SetUp>
void check_pic(const SetUp& set_up) {
  for (const bool equal_spacing : {true, false}) {
    const auto run = [&](Real pic) {
      Engines engines({equal_spacing, sizeof(Real) == 4 ? 0. : 2.});
      set_up(engines);
      engines.options.pic = pic;
      engines.declare_everywhere(1);
      UniformVirtualStress<Dim, Real> f;
      f.count = 1;
      f.stress[0] = pressure_stress<Dim>(engines.amplitude);
      engines.run(elastic<Dim, Real>(), DeterminantVolume{}, [&](int) { return f; });
      check_same(engines);
      return engines;
    };
    const auto flip = run(0), mixed = run(Real(0.02));
    CHECK(difference(read(flip.copy), read(mixed.copy), flip.grid).velocity > 1e-3);
  }
}

/// A step of particles next to the faces of their cells: nodes with next to no mass, and accelerations as
/// large as that is small. Their positions are the same to the last bit in both engines.
template <int Dim, class Real, class Engines>
void check_slivers() {
  BodyShape shape;
  shape.slivers = true;
  shape.drift = 1;
  for (const unsigned seed : {81u, 82u, 83u}) {
    Engines engines(shape, seed);
    engines.declare_everywhere(1);
    UniformVirtualStress<Dim, Real> f;
    f.count = 1;
    f.stress[0] = pressure_stress<Dim>(Real(2));
    engines.run(
        elastic<Dim, Real>(), DeterminantVolume{}, [&](int) { return f; }, 1);
    CAPTURE(seed);
    check_same(engines, 64 * epsilon<Real>);
  }
}

/// Under a pressure or another uniform stress, of another size in every step.
template <int Dim, class Real, class Engines>
void check_uniform_stress(bool equal_spacing, bool pressure) {
  const double drift = sizeof(Real) == 4 ? 0 : pressure ? 2 : 5;
  Engines engines({equal_spacing, drift});
  engines.declare_everywhere(1);
  engines.run(elastic<Dim, Real>(), DeterminantVolume{}, [&](int n) {
    UniformVirtualStress<Dim, Real> f;
    f.count = 1;
    const auto factor = engines.amplitude * static_cast<Real>(0.02 * n);
    f.stress[0] = factor * (pressure ? pressure_stress<Dim>(Real(2)) : full_tensor<Dim, Real>());
    return f;
  });
  CAPTURE(equal_spacing, pressure, engines.moved);
  check_same(engines);
  engines.check_boundary();
  CHECK((engines.moved > 0 || drift == 0));
  // With B-splines N1 is three nodes deep.
  CHECK(((Engines::splines && Dim > 1) || engines.load_seen[static_cast<int>(GroupLoad::none)]));
  CHECK(engines.load_seen[static_cast<int>(GroupLoad::part)]);
  CHECK((Dim == 1 || engines.load_seen[static_cast<int>(GroupLoad::whole)]));
  CHECK(!engines.load_seen[static_cast<int>(GroupLoad::mixed)]);
}

/// Under tractions that change from node to node, some of them at all active nodes.
template <int Dim, class Real, class Engines>
void check_mixed_tractions() {
  for (const TractionMask at_all_active_nodes : {0u, 2u}) {
    Engines engines({true, sizeof(Real) == 4 ? 0. : 5.});
    engines.declare([](const Vector<Dim, int>& ijk) { return striped<Dim>(ijk); });
    engines.declare_everywhere(8);
    engines.at_all_active_nodes = at_all_active_nodes;
    const auto f = four_uniform_stresses<Dim, Real>(engines.amplitude);
    engines.run(elastic<Dim, Real>(), DeterminantVolume{}, [&](int) { return f; });
    CAPTURE(at_all_active_nodes, engines.moved);
    check_same(engines);
    engines.check_boundary();
    CHECK(engines.load_seen[static_cast<int>(GroupLoad::mixed)]);
  }
}

/// Sliding along a wall and fixed to it.
template <int Dim, class Real, class Engines>
void check_body_at_a_wall() {
  for (const int fixed : {1, (1 << Dim) - 1}) {
    Engines engines({false, 0, true});
    engines.lanes.memory.walls.fixed[0][0] = static_cast<ComponentMask>(fixed);
    engines.lanes.memory.walls.fixed[Dim - 1][1] = 1;  // far from the body
    engines.options.gravity[0] = -5 * engines.amplitude;
    engines.options.damping = Real(0.1);
    engines.declare_everywhere(1);
    if (fixed == 1 && sizeof(Real) == 8)
      edit(engines.block, [](const auto& p) {
        for (int k = 0; k < p.count(); ++k)
          for (int i = 1; i < Dim; ++i) p.velocity(k, i) += 1;
      });
    UniformVirtualStress<Dim, Real> f;
    f.count = 1;
    f.stress[0] = pressure_stress<Dim>(engines.amplitude);
    engines.run(elastic<Dim, Real>(), DeterminantVolume{}, [&](int) { return f; });
    CAPTURE(fixed, engines.moved);
    check_same(engines);
    engines.check_boundary();
  }
}

/// Under fields of all kinds, everywhere the same or other ones from node to node.
template <int Dim, class Real, class Engines>
void check_fields_of_all_kinds() {
  for (const bool mixed : {false, true}) {
    Engines engines({!mixed, sizeof(Real) == 4 ? 0. : 5.});
    const auto f = four_fields<Dim, Real>(engines.grid, engines.amplitude);
    if (mixed) {
      engines.declare([](const Vector<Dim, int>& ijk) {
        TractionMask mask = 0;
        for (int i = 0; i < Dim; ++i)
          if (const int k = (ijk[i] + i + 10) / 2 % 5; k < 4) mask |= 1u << k;
        return mask;
      });
      engines.at_all_active_nodes = 4;
    } else {
      engines.declare_everywhere(15);
    }
    engines.run(elastic<Dim, Real>(), DeterminantVolume{}, [&](int n) {
      auto now = f;
      for (int k = 0; k < 4; ++k) now.factor[k] *= static_cast<Real>(0.01 * n);
      return now;
    });
    CAPTURE(mixed, engines.moved);
    check_same(engines);
    engines.check_boundary();
    CHECK(engines.load_seen[static_cast<int>(GroupLoad::mixed)] == mixed);
    CHECK((Dim == 1 || mixed || engines.load_seen[static_cast<int>(GroupLoad::whole)]));
  }
}

}  // namespace vsb::test
