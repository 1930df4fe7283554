// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// N1 and the tractions of nodes on cell lanes: against the particle kernels and against Algorithm 1 written
/// out, as bodies are packed and as they move.

#include "algorithm_1.hpp"
#include "both_engines.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

template <int Dim, class Real>
std::vector<bool> void_cells(const UniformGrid<Dim, Real>& grid,
                             const ParticleBlock<Dim, Real, Device>& block) {
  std::vector<bool> is_void(static_cast<size_t>(grid.cell_count()), true);
  const auto p = read(block);
  for (int k = 0; k < p.count(); ++k) {
    int cell = 0;
    for (int i = Dim - 1; i >= 0; --i) {
      const double q = static_cast<double>((p.position(k, i) - grid.lower[i]) / grid.spacing[i]);
      cell = cell * grid.cells[i] + std::min(static_cast<int>(q), grid.cells[i] - 1);
    }
    is_void[static_cast<size_t>(cell)] = false;
  }
  return is_void;
}

/// Checks the tractions at the nodes, and what the groups know of them. Returns the size of N1.
template <int Dim, class Real>
int check_marks(const LaneState<Dim, Real, Device>& s, const std::vector<bool>& is_void,
                const std::vector<TractionMask>& declared) {
  const auto& grid = s.memory.grid;
  const auto& lanes = s.memory.lanes;
  const auto list = list_nodes(grid);
  const auto n1 = algorithm_1(list, is_void);
  std::set<int> active;
  for (size_t cell = 0; cell < is_void.size(); ++cell)
    if (!is_void[cell]) active.insert(list.nodes_of_cell[cell].begin(), list.nodes_of_cell[cell].end());
  std::vector<TractionMask> expected(declared.size(), 0);
  int wrong = 0, loaded = 0;
  const auto mine = tractions_of_nodes(s);
  for (size_t I = 0; I < mine.size(); ++I) {
    const int node = static_cast<int>(I);
    if (n1.count(node))
      expected[I] = declared[I];
    else if (active.count(node))
      expected[I] = declared[I] & s.boundary.at_all_active_nodes;
    wrong += mine[I] != expected[I];
    loaded += expected[I] != 0;
  }
  CHECK(wrong == 0);
  CHECK(count_loaded_nodes(Exec(), lanes, s.boundary) == loaded);

  // The groups' classes, from the tractions that should be there.
  const auto groups = read(lanes.groups);
  int wrong_groups = 0;
  for (int g = 0; g < lanes.group_count; ++g) {
    std::set<TractionMask> masks;
    bool whole = true, same = true;
    for (int l = 0; l < lanes.width; ++l) {
      int loaded_corners = 0;
      for (int a = 0; a < 1 << Dim; ++a) {
        auto ijk = lanes.cell(groups(g), l);
        bool inside = true;
        for (int i = 0; i < Dim; ++i) {
          ijk[i] += a >> i & 1;
          inside = inside && ijk[i] >= 0 && ijk[i] <= grid.cells[i];
        }
        const TractionMask mask = inside ? expected[static_cast<size_t>(grid.node_index(ijk))] : 0;
        const bool bit = groups(g).loaded[a >> 1] >> (l + (a & 1)) & 1;
        wrong_groups += bit != (mask != 0);
        if (mask != 0) {
          masks.insert(mask);
          ++loaded_corners;
        }
      }
      whole = whole && (loaded_corners == 0 || loaded_corners == 1 << Dim);
    }
    same = masks.size() < 2;
    const auto load = masks.empty() ? GroupLoad::none
                      : !same       ? GroupLoad::mixed
                      : whole       ? GroupLoad::whole
                                    : GroupLoad::part;
    wrong_groups += groups(g).load != load;
    if (load == GroupLoad::whole || load == GroupLoad::part)
      wrong_groups += groups(g).tractions != *masks.begin();
  }
  CHECK(wrong_groups == 0);
  return static_cast<int>(n1.size());
}

/// Packs one or two particles into every cell that is not void, and checks.
template <int Dim, class Real>
int pack_and_check(const UniformGrid<Dim, Real>& grid, const std::vector<bool>& is_void, Random& random,
                   int masks) {
  const auto block = populate(grid, is_void, random);
  if (block.particles.count() == 0) return 0;
  LaneState<Dim, Real, Device> s;
  s.memory.grid = grid;
  std::vector<TractionMask> declared(static_cast<size_t>(grid.node_count()), 8);
  s.boundary.everywhere = 8;
  if (masks > 1) {
    s.boundary.at_all_active_nodes = 2;
    const BoundaryNodes<Device> on_nodes("vsb::declared", declared.size());
    s.boundary.declared = on_nodes;
    edit(on_nodes, [&](const auto& host) {
      for (size_t I = 0; I < declared.size(); ++I) {
        host(I) = static_cast<TractionMask>(random.index(masks));
        declared[I] |= host(I);
      }
    });
  }
  REQUIRE(pack_lanes(Exec(), block.particles, s) == -1);
  return check_marks(s, is_void, declared);
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("random bodies on cell lanes", "", ((int Dim, typename Real), Dim, Real), (1, double),
                       (2, double), (3, double), (2, float)) {
  Random random(86);
  const int rows = Dim == 3 ? 4 : 6;
  for (const int nx : {1, 2, 5, 63, 64, 65, 130, 200})
    for (const double fill : {0.02, 0.5, 0.9, 0.99}) {
      const auto grid = make_grid<Dim, Real>({{nx, rows, rows - 1}});
      std::vector<bool> is_void(static_cast<size_t>(grid.cell_count()));
      for (size_t c = 0; c < is_void.size(); ++c) is_void[c] = random(0, 1) > fill;
      CAPTURE(nx, fill);
      pack_and_check(grid, is_void, random, random.index(2) == 0 ? 1 : 4);
    }
}

TEMPLATE_TEST_CASE_SIG("rows of full words, at the faces of the grid and off them", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (3, float)) {
  Random random(87);
  for (const int nx : {60, 64, 128, 200})
    for (const int margin : {0, 1, 3})
      for (const bool cavity : {false, true}) {
        const auto grid = make_grid<Dim, Real>({{nx + 2 * margin, 7 + 2 * margin, 7 + 2 * margin}});
        std::vector<bool> is_void;
        for_each_cell(grid, [&](const Vector<Dim, int>& cell) {
          bool full = true, hole = cavity;
          for (int i = 0; i < Dim; ++i) {
            full = full && cell[i] >= margin && cell[i] < grid.cells[i] - margin;
            hole = hole && std::abs(cell[i] - (i == 0 ? margin + nx / 2 : margin + 3)) == 0;
          }
          is_void.push_back(!full || hole);
        });
        CAPTURE(nx, margin, cavity);
        const int n1 = pack_and_check(grid, is_void, random, 1);
        CHECK((n1 > 0) == (margin > 0 || cavity));
        // A hole of one cell, three away from all else: the nodes of 3^Dim cells.
        if (margin == 0 && cavity) CHECK(n1 == static_cast<int>(std::pow(4, Dim)));
      }
}

TEMPLATE_TEST_CASE_SIG("a body with a cavity that moves, through many packings", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (2, float)) {
  // 0.114 cells a step in x, less in the other directions; nothing but the marks is looked at.
  const auto grid = make_grid<Dim, Real>({{60, 32, 24}});
  auto block = fill_cells<Dim, Real>(grid, 2, Real(1), [](const Vector<Dim, int>& cell) {
    bool hole = true;
    for (int i = 0; i < Dim; ++i) {
      if (cell[i] < 1 || cell[i] > 8) return false;
      hole = hole && cell[i] >= 4 && cell[i] <= 5;
    }
    return !hole;
  });
  StepOptions<Dim, Real> options;
  options.dt = Real(1);
  edit(block, [&](const auto& p) {
    for (int k = 0; k < p.count(); ++k)
      for (int i = 0; i < Dim; ++i)
        p.velocity(k, i) = grid.spacing[i] * static_cast<Real>(0.113707 / (i + 1));
  });
  LaneState<Dim, Real, Device> s;
  s.memory.grid = grid;
  s.boundary.everywhere = 1;
  REQUIRE(pack_lanes(Exec(), block.particles, s) == -1);
  UniformVirtualStress<Dim, Real> nothing;
  nothing.count = 1;
  nothing.stress[0] = SymmetricTensor<Dim, Real>::zero();
  const std::vector<TractionMask> declared(static_cast<size_t>(grid.node_count()), 1);
  const LinearElastic<Real> dust{0, 0};
  prepare_lane_step(Exec(), s, nothing);
  int different = 0;
  std::vector<bool> before;
  for (int n = 0; n < 300; ++n) {
    const bool without_field = n / 10 % 3 == 1;
    REQUIRE((without_field ? lane_step(Exec(), s, dust, DeterminantVolume{}, NoVirtualStress{}, options)
                           : lane_step(Exec(), s, dust, DeterminantVolume{}, nothing, options)) == -1);
    if (n % 3 != 0 || (without_field && n % 2 == 0)) continue;
    if (without_field) prepare_lane_step(Exec(), s, nothing);
    unpack_particles(Exec(), s.memory, block.particles);
    CAPTURE(n);
    const auto is_void = void_cells(grid, block);
    CHECK(check_marks(s, is_void, declared) > 0);
    different += is_void != before;
    before = is_void;
  }
  CHECK(different > 20);
  CHECK(s.repacked > 2);
}
