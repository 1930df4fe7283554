// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Particles on cell lanes from cell to cell: fast flows keep every particle, mass and momentum; what leaves
/// the grid is reported.
#include <cstdio>

#include <common_steps.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

/// Every number from 0 on once, among the entries in use.
template <int Dim, class Real>
bool all_there(const CellLanes<Dim, Real, Device>& lanes) {
  const auto id = read(lanes.id);
  const auto groups = read(lanes.groups);
  const auto data = read(lanes.data);
  std::vector<int> seen(static_cast<size_t>(lanes.particle_count), 0);
  for (int g = 0; g < lanes.group_count; ++g)
    for (int s = 0; s < groups(g).capacity; ++s)
      for (int l = 0; l < lanes.width; ++l) {
        const auto e = static_cast<size_t>((groups(g).first + s) * lanes.width + l);
        const int p = id(e);
        if (p < 0) {
          if (s >= groups(g).slots) continue;  // nobody reads what such a slot holds
          for (int i = 0; i < Dim; ++i)        // ghosts stay in their cells, or they would grow without bound
            if (const auto xi = data(e, static_cast<size_t>(i)); !(xi >= 0 && xi < 1)) return false;
          continue;
        }
        if (s >= groups(g).slots) return false;
        ++seen[static_cast<size_t>(p)];
      }
  return std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; });
}

/// A block of 5 x 5 x 5 cells without stress, which moves by `step` cells a step.
template <int Dim, class Real, template <int, class, class> class StateOf = LaneState>
struct TranslatingBlock {
  UniformGrid<Dim, Real> grid;
  ParticleBlock<Dim, Real, Device> block, after;
  StateOf<Dim, Real, Device> s;
  StepOptions<Dim, Real> options;
  LinearElastic<Real> material = LinearElastic<Real>::from_young(0.01, 0.3);
  int lost = -1;

  TranslatingBlock(const Vector<3, double>& step, int cells, int from) {
    grid = make_grid<Dim, Real>({{cells, cells, cells}});
    block = fill_cells<Dim, Real>(grid, 2, Real(1), [&](const Vector<Dim, int>& cell) {
      for (int i = 0; i < Dim; ++i)
        if (cell[i] < from || cell[i] >= from + 5) return false;
      return true;
    });
    after = allocate_particles<Dim, Real, Device>(block.particles.count());
    Random random(88);
    options.dt = Real(0.01);
    edit(block, [&](const auto& p) {
      for (int k = 0; k < p.count(); ++k) {
        for (int i = 0; i < Dim; ++i) {
          p.position(k, i) += grid.spacing[i] * random.draw<Real>(-0.2, 0.2);
          p.velocity(k, i) = static_cast<Real>(step[i] / 0.01) * grid.spacing[i];
        }
        p.mass(k) *= random.draw<Real>(0.9, 1.1);
      }
    });
    set_grid(s, grid);
    Kokkos::deep_copy(after.block, block.block);
    REQUIRE(pack_lanes(Exec(), after.particles, s) == -1);
    prepare_lane_step(Exec(), s, NoVirtualStress{});
  }
  bool advance(int steps) {
    for (int n = 0; n < steps && lost < 0; ++n)
      lost = lane_step(Exec(), s, material, DeterminantVolume{}, NoVirtualStress{}, options);
    unpack_particles(Exec(), s.memory, after.particles);
    return lost < 0;
  }
};

/// After so many steps of a translation every particle is where it must be, with its mass.
template <int Dim, class Real, template <int, class, class> class StateOf>
void check_arrival(const TranslatingBlock<Dim, Real, StateOf>& translation, const Vector<3, double>& step,
                   int steps) {
  const auto before = read(translation.block), after = read(translation.after);
  int wrong = 0;
  double error = 0;
  for (int k = 0; k < before.count(); ++k) {
    wrong += after.mass(k) != before.mass(k);
    for (int i = 0; i < Dim; ++i)
      error = std::max(error, std::abs(static_cast<double>((after.position(k, i) - before.position(k, i)) /
                                                           translation.grid.spacing[i]) -
                                       steps * step[i]));
  }
  CHECK(wrong == 0);
  // A position in a cell, below 1, is rounded once a step, and a position in the grid once.
  CHECK(error < (steps + 4 * translation.grid.cells[0]) * epsilon<Real>);
}

template <int Dim, class Real>
double momentum(const ParticleBlock<Dim, Real, Device>& block, int i) {
  const auto p = read(block);
  double sum = 0;
  for (int k = 0; k < p.count(); ++k)
    sum += static_cast<double>(p.mass(k)) * static_cast<double>(p.velocity(k, i));
  return sum;
}

/// A block on its way out of the grid, in every direction.
template <int Dim, template <int, class, class> class StateOf>
void check_lost_particles() {
  for (const int side : {-1, 1})
    for (int i = 0; i < Dim; ++i) {
      Vector<3, double> step{{0, 0, 0}};
      step[i] = 0.1 * side;
      TranslatingBlock<Dim, double, StateOf> translation(step, 13, 4);  // 4 cells to each face
      // When the first ones are outside, and which.
      const auto p = read(translation.block);
      int first = -1, steps = 0;
      while (first < 0) {
        ++steps;
        for (int k = 0; k < p.count() && first < 0; ++k) {
          const double coordinate =
              (p.position(k, i) - translation.grid.lower[i]) / translation.grid.spacing[i] + steps * step[i];
          if (coordinate < 0 || coordinate > 13) first = k;
        }
      }
      CAPTURE(side, i, steps);
      CHECK(translation.advance(steps - 1));
      CHECK(!translation.advance(1));
      CHECK(translation.lost == first);
    }
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("a block flies a hundred cells in a thousand steps", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (3, float)) {
  // Along x, along the last direction, and along all diagonals but one, with other speeds in each.
  for (const Vector<3, double>& step :
       {Vector<3, double>{{0.1, 0, 0}},
        Vector<3, double>{{Dim == 1 ? 0.1 : 0, Dim == 2 ? -0.1 : 0, Dim == 3 ? -0.1 : 0}},
        Vector<3, double>{{0.1, -0.07, 0.09}}, Vector<3, double>{{-0.1, 0.1, -0.083}}}) {
    TranslatingBlock<Dim, Real> translation(step, 240, 115);
    CAPTURE(step[0], step[1], step[2]);
    const int slots = translation.s.memory.lanes.slot_count, nodes = translation.s.memory.lanes.node_count;
    const int stages = 10;
    for (int stage = 0; stage < stages; ++stage) {
      REQUIRE(translation.advance(1000 / stages));
      CHECK(all_there<Dim, Real>(translation.s.memory.lanes));
      // The block of 5 cells touches 6 in every direction, and cells beside it are held in reserve: 8 of 5,
      // with 9 of 6 nodes; along x, 4 groups of 1 or 2, with 5 of 2 or 3 node groups. Slots fill up to
      // twice the particles of a cell where a lattice is jittered.
      double more_cells = 4, more_nodes = 2.5;
      for (int i = 1; i < Dim; ++i) {
        more_cells *= 8. / 5;
        more_nodes *= 9. / 6;
      }
      CHECK(translation.s.memory.lanes.slot_count <= 2 * more_cells * slots);
      CHECK(translation.s.memory.lanes.node_count <= more_nodes * nodes);
    }
    CHECK(translation.s.repacked > 5);
    check_arrival(translation, step, 1000);
  }
}

TEMPLATE_TEST_CASE_SIG("a block that shakes as it flies keeps its momentum", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (3, float)) {
  TranslatingBlock<Dim, Real> translation({{0.1, -0.07, 0.05}}, 240, 115);
  translation.material = LinearElastic<Real>::from_young(10, 0.3);
  Random random(89);
  edit(translation.block, [&](const auto& p) {
    for (int k = 0; k < p.count(); ++k)
      for (int i = 0; i < Dim; ++i) p.velocity(k, i) += random.draw<Real>(-0.2, 0.2);
  });
  Kokkos::deep_copy(translation.after.block, translation.block.block);
  REQUIRE(pack_lanes(Exec(), translation.after.particles, translation.s) == -1);
  prepare_lane_step(Exec(), translation.s, NoVirtualStress{});
  REQUIRE(translation.advance(1000));
  CHECK(all_there<Dim, Real>(translation.s.memory.lanes));
  const auto before = read(translation.block), after = read(translation.after);
  double mass = 0, stress = 0;
  int wrong = 0;
  for (int k = 0; k < before.count(); ++k) {
    wrong += after.mass(k) != before.mass(k);
    mass += static_cast<double>(before.mass(k));
    stress = std::max(stress, std::abs(static_cast<double>(after.cauchy_stress(k, 0))));
  }
  CHECK(wrong == 0);
  CHECK(stress > 0.01);  // it does shake
  CHECK(stress < 10);
  for (int i = 0; i < Dim; ++i) {
    const double p0 = momentum(translation.block, i), speed = std::abs(p0) / mass;
    // Every velocity is rounded once a step, in any direction.
    CHECK_THAT(momentum(translation.after, i),
               WithinAbs(p0, std::sqrt(1000.) * epsilon<Real> * mass * speed));
  }
}

TEMPLATE_TEST_CASE_SIG("particles may cross several cells in a step", "", ((int Dim), Dim), 1, 2, 3) {
  TranslatingBlock<Dim, double> translation({{2.3, 3.7, -5.1}}, 120, 60);
  REQUIRE(translation.advance(10));
  CHECK(all_there<Dim, double>(translation.s.memory.lanes));
  const auto before = read(translation.block), after = read(translation.after);
  const double step[] = {2.3, 3.7, -5.1};
  double error = 0;
  for (int k = 0; k < before.count(); ++k)
    for (int i = 0; i < Dim; ++i)
      error = std::max(error,
                       std::abs((after.position(k, i) - before.position(k, i)) / translation.grid.spacing[i] -
                                10 * step[i]));
  CHECK(error < 1e-11);
}

TEMPLATE_TEST_CASE_SIG("the lowest number of the particles that leave the grid is reported", "",
                       ((int Dim), Dim), 1, 2, 3) {
  check_lost_particles<Dim, LaneState>();
  check_lost_particles<Dim, SplineLaneState>();
}

TEMPLATE_TEST_CASE_SIG("splines: a block flies thirty cells", "", ((int Dim, typename Real), Dim, Real),
                       (1, double), (2, double), (3, double), (3, float)) {
  for (const Vector<3, double>& step :
       {Vector<3, double>{{0.1, -0.07, 0.09}}, Vector<3, double>{{-0.1, 0.1, -0.083}}}) {
    TranslatingBlock<Dim, Real, SplineLaneState> translation(step, 90, 42);
    CAPTURE(step[0], step[1], step[2]);
    for (int stage = 0; stage < 3; ++stage) {
      REQUIRE(translation.advance(100));
      CHECK(all_there<Dim, Real>(translation.s.memory.lanes));
    }
    CHECK(translation.s.repacked > 0);
    check_arrival(translation, step, 300);
  }
}

TEMPLATE_TEST_CASE_SIG("velocities that are not numbers lose particles, and nothing else", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (3, float)) {
  for (const Real bad : {std::numeric_limits<Real>::quiet_NaN(), std::numeric_limits<Real>::infinity(),
                         std::numeric_limits<Real>::max()})
    for (int i = 0; i < Dim; ++i) {
      TranslatingBlock<Dim, Real> translation({{0.01, 0, 0}}, 13, 4);
      edit(translation.after, [&](const auto& p) { p.velocity(7, i) = bad; });
      REQUIRE(pack_lanes(Exec(), translation.after.particles, translation.s) == -1);
      prepare_lane_step(Exec(), translation.s, NoVirtualStress{});
      CAPTURE(bad, i);
      const int lost = lane_step(Exec(), translation.s, translation.material, DeterminantVolume{},
                                 NoVirtualStress{}, translation.options);
      CHECK((lost >= 0 && lost <= 7));
    }
}

TEMPLATE_TEST_CASE_SIG("rounding strains a particle before a face by epsilon over its distance", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (3, float)) {
  // A cell with eight particles and beside it one with a single particle, delta before its upper corner: all
  // move alike, so nothing is strained but by the rounding of nodal masses and momenta.
  for (const double delta : {0.1, 1e-2, 1e-3, 1e-4, 1e-6}) {
    if (delta < 1e-5 && sizeof(Real) == 4) continue;
    const auto grid = make_grid<Dim, Real>({{12, 12, 12}});
    const int n = 1 + (1 << Dim);
    const auto block = allocate_particles<Dim, Real, Device>(n);
    constexpr double step = 0.012345;
    edit(block, [&](const auto& p) {
      for (int k = 0; k < n; ++k) {
        for (int i = 0; i < Dim; ++i) {
          const double coordinate = k == 0 ? 4 - delta : 4.25 + 0.5 * ((k - 1) >> i & 1);
          p.position(k, i) = grid.lower[i] + grid.spacing[i] * static_cast<Real>(coordinate);
          p.velocity(k, i) = -static_cast<Real>(step) * grid.spacing[i];
        }
        p.mass(k) = p.volume(k) = grid.cell_volume() / Real(1 << Dim);
      }
    });
    LaneState<Dim, Real, Device> s;
    s.memory.grid = grid;
    StepOptions<Dim, Real> options;
    options.dt = Real(1);
    REQUIRE(pack_lanes(Exec(), block.particles, s) == -1);
    prepare_lane_step(Exec(), s, NoVirtualStress{});
    // Of modulus 1 and without lateral strain: stress is strain.
    REQUIRE(lane_step(Exec(), s, LinearElastic<Real>::from_young(1, 0), DeterminantVolume{},
                      NoVirtualStress{}, options) == -1);
    unpack_particles(Exec(), s.memory, block.particles);
    const auto p = read(block);
    double strain = 0;
    for (int k = 0; k < n; ++k)
      for (int c = 0; c < p.stress_size; ++c)
        strain = std::max(strain, std::abs(static_cast<double>(p.cauchy_stress(k, c))));
    CAPTURE(delta);
    CHECK(strain <= 4 * epsilon<Real> / delta * step);
  }
}
