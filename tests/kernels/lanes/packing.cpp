// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Particles packed by cell: every one in its entry and back again, in memory that follows the body.
#include <vsb/kernels/lanes/build.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

template <int Dim, class Real>
struct Packed {
  ParticleBlock<Dim, Real, Device> block, back;
  LaneMemory<Dim, Real, Device> memory;
  int lost;

  Packed(const UniformGrid<Dim, Real>& grid, const ParticleBlock<Dim, Real, Device>& particles)
      : block(particles), back(allocate_particles<Dim, Real, Device>(particles.particles.count())) {
    memory.grid = grid;
    lost = pack_particles(Exec(), block.particles, memory);
  }
  /// Every particle is in one entry, and in that of the cell and xi where it is; ghosts weigh nothing.
  void check() const {
    REQUIRE(lost == -1);
    const auto& lanes = memory.lanes;
    const auto p = read(block);
    const auto id = read(lanes.id);
    const auto data = read(lanes.data);
    const auto groups = read(lanes.groups);
    std::vector<int> seen(static_cast<size_t>(p.count()), 0);
    int wrong = 0;
    for (int g = 0; g < lanes.group_count; ++g)
      for (int s = 0; s < groups(g).capacity; ++s)
        for (int l = 0; l < lanes.width; ++l) {
          const size_t e = static_cast<size_t>((groups(g).first + s) * lanes.width + l);
          if (id(e) < 0) {
            if (s >= groups(g).slots) continue;  // nobody looks there
            wrong += data(e, static_cast<size_t>(lanes.mass_column)) != 0;
            wrong += data(e, static_cast<size_t>(lanes.volume_column)) != 0;
            continue;
          }
          wrong += s >= groups(g).slots;
          ++seen[static_cast<size_t>(id(e))];
          for (int i = 0; i < Dim; ++i) {
            const Real x = p.position(id(e), i), h = memory.grid.spacing[i];
            const auto xi = static_cast<double>(data(e, static_cast<size_t>(i)));
            const double expected =
                static_cast<double>((x - memory.grid.lower[i]) / h) - lanes.cell(groups(g), l)[i];
            wrong += !(std::abs(xi - expected) <= 4 * epsilon<Real> * memory.grid.cells[i]);
            wrong += !(xi >= 0 && xi <= 1 + 16 * epsilon<Real> * memory.grid.cells[i]);
          }
        }
    for (const int count : seen) wrong += count != 1;
    CHECK(wrong == 0);
  }
  /// Positions come back to round-off, all else to the bit.
  void check_back() const {
    unpack_particles(Exec(), memory, back.particles);
    const auto before = read(block), after = read(back);
    int wrong = 0;
    for (int k = 0; k < before.count(); ++k) {
      for (int i = 0; i < Dim; ++i) {
        const double round_off =
            4 * epsilon<Real> *
            std::max<double>(std::abs(memory.grid.lower[i]),
                             memory.grid.cells[i] * static_cast<double>(memory.grid.spacing[i]));
        wrong += !(std::abs(static_cast<double>(after.position(k, i) - before.position(k, i))) <= round_off);
        wrong += after.velocity(k, i) != before.velocity(k, i);
      }
      wrong += after.mass(k) != before.mass(k);
      wrong += after.volume(k) != before.volume(k);
      for (int c = 0; c < before.stress_size; ++c)
        wrong += after.cauchy_stress(k, c) != before.cauchy_stress(k, c);
      for (int c = 0; c < static_cast<int>(before.material_state.extent(1)); ++c)
        wrong += after.material_state(k, c) != before.material_state(k, c);
    }
    CHECK(wrong == 0);
  }
};

template <int Dim, class Real>
UniformGrid<Dim, Real> shifted(const UniformGrid<Dim, Real>& grid, int cells, int count) {
  auto lower = grid.lower;
  Vector<Dim, int> n;
  for (int i = 0; i < Dim; ++i) {
    lower[i] -= grid.spacing[i] * static_cast<Real>(cells);
    n[i] = count;
  }
  return {lower, grid.spacing, n};
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("every particle is packed and comes back", "", ((int Dim, typename Real), Dim, Real),
                       (1, double), (2, double), (3, double), (1, float), (2, float), (3, float)) {
  for (const int nx : {1, 3, 4, 5, 8, 9, 70}) {
    const auto grid = make_grid<Dim, Real>({{nx, 5, 4}});
    for (const int n : {1, 7, 300}) {
      CAPTURE(nx, n);
      const Packed<Dim, Real> packed(grid, random_particles(grid, n, 83));
      packed.check();
      packed.check_back();
    }
  }
}

TEMPLATE_TEST_CASE_SIG("the state of a material comes along", "", ((int Dim), Dim), 1, 2, 3) {
  const auto grid = make_grid<Dim, double>();
  Packed<Dim, double> packed(grid, random_particles(grid, 60, 84));
  for (auto* block : {&packed.block, &packed.back}) allocate_material_state(*block, 60, Dim * Dim);
  edit(packed.block, [](const auto& p) {
    for (int k = 0; k < 60; ++k)
      for (int c = 0; c < Dim * Dim; ++c) p.material_state(k, c) = 100 * k + c;
  });
  packed.memory.lanes.state_size = Dim * Dim;
  REQUIRE(pack_particles(Exec(), packed.block.particles, packed.memory) == -1);
  packed.check_back();
  CHECK(read(packed.back).material_state(59, Dim * Dim - 1) == 5900 + Dim * Dim - 1);
}

TEMPLATE_TEST_CASE_SIG("particles that are handed over are packed where they are", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (3, float)) {
  const auto grid = make_grid<Dim, Real>();
  const int n = 200, state_size = 3;
  auto source = random_particles(grid, n, 86);
  allocate_material_state(source, n, state_size);
  edit(source, [](const auto& p) {
    for (int k = 0; k < n; ++k)
      for (int c = 0; c < state_size; ++c) p.material_state(k, c) = static_cast<Real>(100 * k + c);
  });
  LaneMemory<Dim, Real, Device> kept, reserved_rows, without_capacity;
  for (auto* m : {&kept, &reserved_rows, &without_capacity}) {
    m->grid = grid;
    m->lanes.state_size = state_size;
  }
  REQUIRE(pack_particles(Exec(), source.particles, kept) == -1);

  const auto copy_of_source = [&](ParticleBlock<Dim, Real, Device> copy) {
    allocate_material_state(copy, n, state_size);
    const auto columns = std::make_pair(0, copy.columns());
    const auto rows = std::make_pair(0, n);
    Kokkos::deep_copy(Kokkos::subview(copy.block, rows, columns),
                      Kokkos::subview(source.block, rows, columns));
    Kokkos::deep_copy(copy.state_block, source.state_block);
    return copy;
  };
  auto large = copy_of_source(allocate_particles_to_pack<Dim, Real, Device>(n, state_size));
  auto narrow = copy_of_source(allocate_particles<Dim, Real, Device>(n));
  const Real* const memory = large.block.data();

  // Nothing happens to particles of which one is outside.
  auto lost = copy_of_source(allocate_particles_to_pack<Dim, Real, Device>(n, state_size));
  edit(lost, [](const auto& p) { p.position(11, 0) = Real(1e6); });
  CHECK(pack_particles(Exec(), std::move(lost), reserved_rows) == 11);
  CHECK(lost.particles.count() == n);
  CHECK(read(lost).velocity(5, 0) == read(source).velocity(5, 0));

  REQUIRE(pack_particles(Exec(), std::move(large), reserved_rows) == -1);
  REQUIRE(pack_particles(Exec(), std::move(narrow), without_capacity) == -1);
  CHECK(large.particles.count() == 0);
  CHECK(narrow.particles.count() == 0);
  const auto slots = static_cast<size_t>(kept.lanes.slot_count) * kept.lanes.width;
  CHECK(reserved_rows.lanes.data.data() == memory);
  const auto expected = read(kept.lanes.data);
  const auto id = read(kept.lanes.id);
  for (const auto* m : {&reserved_rows, &without_capacity}) {
    const auto data = read(m->lanes.data);
    const auto who = read(m->lanes.id);
    REQUIRE(m->lanes.slot_count == kept.lanes.slot_count);
    int wrong = 0;
    for (size_t e = 0; e < slots; ++e) {
      wrong += who(e) != id(e);
      for (size_t c = 0; id(e) >= 0 && c < expected.extent(1); ++c) wrong += data(e, c) != expected(e, c);
    }
    CHECK(wrong == 0);
  }
}

TEMPLATE_TEST_CASE_SIG("particles on the faces of the grid", "", ((int Dim, typename Real), Dim, Real),
                       (1, double), (2, double), (3, double), (2, float)) {
  const auto grid = make_grid<Dim, Real>();
  const auto block = allocate_particles<Dim, Real, Device>(1 << Dim);
  edit(block, [&](const auto& p) {  // one in every corner
    for (int k = 0; k < p.count(); ++k) {
      for (int i = 0; i < Dim; ++i)
        p.position(k, i) =
            grid.lower[i] + ((k >> i & 1) ? grid.spacing[i] * static_cast<Real>(grid.cells[i]) : Real(0));
      p.mass(k) = p.volume(k) = Real(1);
    }
  });
  const Packed<Dim, Real> packed(grid, block);
  packed.check();
  packed.check_back();
}

TEMPLATE_TEST_CASE_SIG("the lowest number of a particle outside the grid is reported", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (3, float)) {
  const auto grid = make_grid<Dim, Real>();
  const Real bad[] = {Real(1e6), Real(-1e6), std::numeric_limits<Real>::quiet_NaN(),
                      std::numeric_limits<Real>::infinity()};
  for (const Real x : bad)
    for (int i = 0; i < Dim; ++i) {
      const auto block = random_particles(grid, 40, 85);
      edit(block, [&](const auto& p) { p.position(31, i) = p.position(17, i) = x; });
      CHECK(Packed<Dim, Real>(grid, block).lost == 17);
      edit(block, [&](const auto& p) {  // none inside
        for (int k = 0; k < p.count(); ++k) p.position(k, i) = x;
      });
      CHECK(Packed<Dim, Real>(grid, block).lost == 0);
    }
}

TEMPLATE_TEST_CASE_SIG("no particles at all", "", ((int Dim), Dim), 1, 2, 3) {
  const Packed<Dim, double> packed(make_grid<Dim, double>(), allocate_particles<Dim, double, Device>(0));
  CHECK(packed.lost == -1);
  CHECK(packed.memory.lanes.group_count == 0);
}

TEMPLATE_TEST_CASE_SIG("memory follows the body and not the grid", "", ((int Dim, typename Real), Dim, Real),
                       (1, double), (2, double), (3, double), (3, float)) {
  const auto tight = make_grid<Dim, Real>({{12, 12, 12}});
  const auto block = fill_cells<Dim, Real>(tight, 2, Real(1), [](const auto&) { return true; });
  const Packed<Dim, Real> close(tight, block);
  int cells = 1;
  for (int i = 0; i < Dim; ++i) cells *= 12;
  // Groups of whole rows, up to the next whole group; as many particles as slots but for the slack of one;
  // and one node group more than groups per row.
  const int width = close.memory.lanes.width, groups_per_row = (12 + width - 1) / width, rows = cells / 12;
  CHECK(close.memory.lanes.group_count == groups_per_row * rows);
  CHECK(close.memory.lanes.slot_count == groups_per_row * rows * ((1 << Dim) + close.memory.slack));
  const int node_rows = Dim == 1 ? 1 : Dim == 2 ? 13 : 169;
  CHECK(close.memory.lanes.node_count == node_rows * (groups_per_row + 1) * width);
  // 30 times the volume, and again with much more than that.
  for (const int n : {Dim == 1 ? 360 : Dim == 2 ? 66 : 38, 1000}) {
    const Packed<Dim, Real> wide(shifted(tight, n / 3, n), block);
    CHECK(wide.memory.lanes.node_count == close.memory.lanes.node_count);
    CHECK(wide.memory.lanes.slot_count == close.memory.lanes.slot_count);
    CHECK(wide.memory.lanes.group_count == close.memory.lanes.group_count);
    wide.check();
  }
}

TEMPLATE_TEST_CASE_SIG("two bodies far apart take the memory of two", "", ((int Dim), Dim), 1, 2, 3) {
  // 40 cells between them, in x and in the last direction.
  const auto grid = make_grid<Dim, double>({{64, 64, 64}});
  const auto count = [&](bool first, bool second) {
    const auto inside = [](const Vector<Dim, int>& cell, int from) {
      for (int i = 0; i < Dim; ++i)
        if (cell[i] < from || cell[i] >= from + 4) return false;
      return true;
    };
    const Packed<Dim, double> packed(grid, fill_cells<Dim, double>(grid, 1, 1., [&](const auto& cell) {
                                       return (first && inside(cell, 4)) || (second && inside(cell, 48));
                                     }));
    packed.check();
    return packed.memory.lanes;
  };
  const auto one = count(true, false), other = count(false, true), both = count(true, true);
  CHECK(both.node_count == one.node_count + other.node_count);
  CHECK(both.slot_count == one.slot_count + other.slot_count);
}
