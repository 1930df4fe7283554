// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The void filter: histories worked out by hand, and random ones against a search over lists of cells.
#include <algorithm>
#include <queue>
#include <set>
#include <vsb/kernels/boundary/update_occupancy.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

/// A body of particles that is put into given cells, with a traction declared everywhere.
template <int Dim>
class Cloud {
 public:
  explicit Cloud(const UniformGrid<Dim, double>& grid, bool filtered = true)
      : basis{grid},
        block(allocate_particles<Dim, double, Device>(2 * grid.cell_count())),
        occupancy(allocate_occupancy<Device>(block.particles.count(), basis)) {
    Kokkos::deep_copy(occupancy.tractions, 1u);
    if (filtered) set_void_filter(occupancy, basis);
  }

  /// Fills cells (numbered along x first), the particles anywhere in them, and brings the occupancy up to
  /// date.
  void fill(const std::vector<int>& cells, Random& random) {
    edit(block, [&](const auto& particles) {
      for (int p = 0; p < particles.count(); ++p) {
        const auto at = basis.grid.cell_ijk(cells[static_cast<size_t>(p) % cells.size()]);
        for (int i = 0; i < Dim; ++i)
          particles.position(p, i) =
              basis.grid.lower[i] + (at[i] + random(0.01, 0.99)) * basis.grid.spacing[i];
        particles.volume(p) = 1;
      }
    });
    update();
  }
  void update() { REQUIRE(update_occupancy(Exec(), block.particles, occupancy, basis) == -1); }

  VoidFilterEffect effect() const {
    return void_filter_effect(Exec(), block.particles, occupancy.cells, basis, occupancy.tractions,
                              occupancy.boundary_node_count);
  }
  std::vector<int> loaded_nodes() const {
    const auto boundary = read(occupancy.boundary);
    std::vector<int> nodes;
    for (int node = 0; node < basis.node_count(); ++node)
      if (boundary(static_cast<size_t>(node)) != 0) nodes.push_back(node);
    return nodes;
  }
  /// Takes cells out of the set that the next update starts from.
  void remove_from_outside(const std::vector<int>& cells) {
    const int nx = basis.grid.cells[0];
    edit(occupancy.cells.outside, [&](const auto& rows) {
      for (const int cell : cells)
        rows(static_cast<size_t>(cell / nx), static_cast<size_t>(cell % nx / 64)) &=
            ~(std::uint64_t(1) << (cell % nx % 64));
    });
  }

  LinearBasis<Dim, double> basis;
  ParticleBlock<Dim, double, Device> block;
  Occupancy<Device> occupancy;
};

/// The cells that share a face with a cell.
template <int Dim>
std::vector<int> face_neighbours(const UniformGrid<Dim, double>& grid, int cell) {
  std::vector<int> found;
  const auto at = grid.cell_ijk(cell);
  for (int i = 0, stride = 1; i < Dim; stride *= grid.cells[i], ++i) {
    if (at[i] > 0) found.push_back(cell - stride);
    if (at[i] + 1 < grid.cells[i]) found.push_back(cell + stride);
  }
  return found;
}

/// O_n of the definition, from O_n-1 and the filled cells: a search that begins at every void cell that was
/// outside or neighbours one that was.
template <int Dim>
std::set<int> outside_after(const UniformGrid<Dim, double>& grid, const std::set<int>& before,
                            const std::set<int>& filled) {
  std::set<int> outside;
  std::queue<int> next;
  const auto visit = [&](int cell) {
    if (filled.count(cell) == 0 && outside.insert(cell).second) next.push(cell);
  };
  for (const int cell : before) {
    visit(cell);
    for (const int neighbour : face_neighbours(grid, cell)) visit(neighbour);
  }
  for (; !next.empty(); next.pop())
    for (const int neighbour : face_neighbours(grid, next.front())) visit(neighbour);
  return outside;
}

/// Algorithm 1 with E1 restricted to a set of void cells: cells touch where they share a corner.
template <int Dim>
std::vector<int> boundary_nodes(const UniformGrid<Dim, double>& grid, const std::set<int>& outside,
                                const std::set<int>& filled) {
  const auto corners = [&](int cell) {
    std::vector<int> nodes;
    for (int a = 0; a < grid.corners; ++a)
      nodes.push_back(grid.node_index(grid.cell_ijk(cell)) + grid.corner_offset(a));
    return nodes;
  };
  const auto nodes_of = [&](const std::set<int>& cells) {
    std::set<int> nodes;
    for (const int cell : cells)
      for (const int node : corners(cell)) nodes.insert(node);
    return nodes;
  };
  const auto touching = [&](const std::set<int>& cells, const std::set<int>& nodes) {
    std::set<int> found;
    for (const int cell : cells)
      for (const int node : corners(cell))
        if (nodes.count(node)) found.insert(cell);
    return found;
  };
  const auto active = nodes_of(filled);
  const auto e1 = touching(outside, active), e2 = touching(filled, nodes_of(e1));
  const auto of_e1 = nodes_of(e1), of_e2 = nodes_of(e2);
  std::vector<int> n1;
  for (const int node : active)
    if (of_e1.count(node) || of_e2.count(node)) n1.push_back(node);
  return n1;
}

/// The cells of rows of characters, the first row at the top: '#' filled; numbered as the grid does.
std::vector<int> cells_of(const std::vector<std::string>& picture) {
  std::vector<int> cells;
  const int nx = static_cast<int>(picture[0].size());
  for (size_t row = 0; row < picture.size(); ++row)
    for (int i = 0; i < nx; ++i)
      if (picture[picture.size() - 1 - row][static_cast<size_t>(i)] == '#')
        cells.push_back(static_cast<int>(row) * nx + i);
  return cells;
}

}  // namespace

TEST_CASE("a body with a hole, by hand") {
  Random random(101);
  Cloud<2> cloud(UniformGrid<2, double>({{0, 0}}, {{1, 1}}, {{9, 9}}));
  const auto show = [&](const std::vector<std::string>& picture) {
    cloud.fill(cells_of(picture), random);
    const auto effect = cloud.effect();
    CHECK(cloud.occupancy.boundary_node_count == static_cast<int>(cloud.loaded_nodes().size()));
    return std::array<int, 3>{effect.false_voids, effect.dropped_nodes, cloud.occupancy.boundary_node_count};
  };
  using Counts = std::array<int, 3>;  // false voids, dropped nodes, boundary nodes
  // 7 x 7 cells have 8 x 8 nodes: 28 at the rim, 20 one cell inside, and the 16 of the 3 x 3 cells around the
  // hole.
  const Counts start = show({".........", ".#######.", ".#######.", ".#######.", ".###.###.", ".#######.",
                             ".#######.", ".#######.", "........."});
  CHECK(start == Counts{0, 0, 64});

  // A solid body: a cell inside turns void. Unfiltered, its 16 nodes would be loaded, 48 + 16 = 64.
  Cloud<2> solid(cloud.basis.grid);
  const std::vector<std::string> whole{".........", ".#######.", ".#######.", ".#######.", ".#######.",
                                       ".#######.", ".#######.", ".#######.", "........."};
  auto holed = whole;
  holed[4][4] = '.';
  solid.fill(cells_of(whole), random);
  CHECK(solid.occupancy.boundary_node_count == 48);
  solid.fill(cells_of(holed), random);
  CHECK(solid.occupancy.boundary_node_count == 48);
  CHECK(solid.effect().false_voids == 1);
  CHECK(solid.effect().dropped_nodes == 16);
  // It opens to the outside through a channel: now it is loaded, and stays so when the channel closes behind
  // it.
  auto open = holed;
  open[5][4] = open[6][4] = open[7][4] = '.';
  solid.fill(cells_of(open), random);
  CHECK(solid.effect().false_voids == 0);
  CHECK(solid.effect().dropped_nodes == 0);
  solid.fill(cells_of(holed), random);
  CHECK(solid.occupancy.boundary_node_count == 64);
  CHECK(solid.effect().false_voids == 0);
  // A corner is no connection.
  Cloud<2> corner(cloud.basis.grid);
  auto diagonal = whole;
  diagonal[2][2] = '.';
  corner.fill(cells_of(whole), random);
  corner.fill(cells_of(diagonal), random);
  CHECK(corner.effect().false_voids == 1);
  diagonal[1][1] = '.';
  corner.fill(cells_of(diagonal), random);
  CHECK(corner.effect().false_voids == 1);
  diagonal[1][2] = '.';
  corner.fill(cells_of(diagonal), random);
  CHECK(corner.effect().false_voids == 0);
}

TEST_CASE("the outside moves with the body") {
  // A hole of one cell, refilled while its neighbour turns void: the same hole, a cell further.
  Random random(102);
  Cloud<2> cloud(UniformGrid<2, double>({{0, 0}}, {{1, 1}}, {{9, 5}}));
  for (int at = 2; at <= 6; ++at) {
    std::vector<std::string> picture(5, ".#######.");
    picture.front() = picture.back() = ".........";
    picture[2][static_cast<size_t>(at)] = '.';
    cloud.fill(cells_of(picture), random);
    CAPTURE(at);
    CHECK(cloud.effect().false_voids == 0);
  }
  // Closed altogether, and open again: inside.
  const std::vector<std::string> closed{".........", ".#######.", ".#######.", ".#######.", "........."};
  auto again = closed;
  again[2][4] = '.';
  cloud.fill(cells_of(closed), random);
  cloud.fill(cells_of(again), random);
  CHECK(cloud.effect().false_voids == 1);
}

TEST_CASE("what is known to lie in the body does not count at the start either") {
  // In a row of cells up to the last bit of a word: void in the middle, and at the far face of the grid.
  Random random(103);
  for (const int nx : {9, 63, 64, 65, 127, 128}) {
    Cloud<1> cloud(UniformGrid<1, double>({{0}}, {{1}}, {{nx}}));
    std::vector<int> filled;
    for (int cell = 2; cell < nx - 1; ++cell)
      if (cell != 5) filled.push_back(cell);
    std::vector<int> body(filled);
    body.push_back(5);
    body.push_back(nx - 1);
    cloud.remove_from_outside(body);
    cloud.fill(filled, random);
    CAPTURE(nx);
    CHECK(cloud.effect().false_voids == 2);
    const std::vector<int> left{2, 3};
    CHECK(cloud.loaded_nodes() == left);
  }
}

TEST_CASE("a void inside the body is no underfilled cell") {
  Random random(104);
  const UniformGrid<2, double> grid({{0, 0}}, {{1, 1}}, {{9, 9}});
  Cloud<2> cloud(grid);
  set_fill_criterion(cloud.occupancy, 0.5);
  const std::vector<std::string> whole{".........", ".#######.", ".#######.", ".#######.", ".#######.",
                                       ".#######.", ".#######.", ".#######.", "........."};
  auto holed = whole;
  holed[4][4] = '.';
  cloud.fill(cells_of(whole), random);
  cloud.fill(cells_of(holed), random);
  CHECK(cloud.occupancy.boundary_node_count == 48);
}

TEMPLATE_TEST_CASE_SIG("random histories", "", ((int Dim), Dim), 1, 2, 3) {
  Random random(105);
  int false_voids = 0, dropped = 0;
  for (const int nx : {3, 7, 64, 65, 130})
    for (const double change : {0.03, 0.3}) {
      const auto grid = make_grid<Dim, double>({{nx, Dim == 3 ? 5 : 8, 4}});
      const int n = grid.cell_count();
      std::vector<bool> is_filled(static_cast<size_t>(n));
      for (int cell = 0; cell < n; ++cell) is_filled[static_cast<size_t>(cell)] = random(0, 1) < 0.75;
      Cloud<Dim> cloud(grid), again(grid);
      std::set<int> outside;
      std::vector<int> inside;
      for (int cell = 0; cell < n; ++cell)
        if (random(0, 1) < 0.3)
          outside.insert(cell);
        else
          inside.push_back(cell);
      cloud.remove_from_outside(inside);
      again.remove_from_outside(inside);
      for (int step = 0; step < 6; ++step) {
        CAPTURE(nx, change, step);
        is_filled[static_cast<size_t>(random.index(n))] = true;
        std::set<int> filled;
        for (int cell = 0; cell < n; ++cell)
          if (is_filled[static_cast<size_t>(cell)]) filled.insert(cell);
        const std::vector<int> cells(filled.begin(), filled.end());
        outside = outside_after(grid, outside, filled);
        cloud.fill(cells, random);
        const auto expected = boundary_nodes(grid, outside, filled);
        CHECK(cloud.loaded_nodes() == expected);
        CHECK(cloud.occupancy.boundary_node_count == static_cast<int>(expected.size()));

        // The effect: against all voids.
        std::set<int> voids;
        for (int cell = 0; cell < n; ++cell)
          if (filled.count(cell) == 0) voids.insert(cell);
        const auto all = boundary_nodes(grid, voids, filled);
        const auto effect = cloud.effect();
        CHECK(effect.dropped_nodes == static_cast<int>(all.size() - expected.size()));
        dropped += effect.dropped_nodes;
        false_voids += effect.false_voids;

        // Brought up to date twice, or from what a checkpoint keeps, it is the same.
        Cloud<Dim> resumed(grid);
        Kokkos::deep_copy(resumed.occupancy.cells.outside, again.occupancy.cells.outside);
        Kokkos::deep_copy(resumed.block.block, cloud.block.block);
        resumed.update();
        CHECK(resumed.loaded_nodes() == expected);
        mark_anew(cloud.occupancy);
        cloud.update();
        CHECK(cloud.loaded_nodes() == expected);
        Kokkos::deep_copy(again.occupancy.cells.outside, cloud.occupancy.cells.outside);

        for (int cell = 0; cell < n; ++cell)
          if (random(0, 1) < change)
            is_filled[static_cast<size_t>(cell)] = !is_filled[static_cast<size_t>(cell)];
      }
    }
  CHECK(false_voids > 20);
  CHECK(dropped > 10);
}

TEMPLATE_TEST_CASE_SIG("a long detour is found", "", ((int Dim), Dim), 2, 3) {
  // A comb of walls in the first two directions: the outside reaches its end through every corridor in turn.
  Random random(106);
  const auto grid = make_grid<Dim, double>({{71, 9, 3}});
  std::vector<int> walls, far;
  for (int cell = 0; cell < grid.cell_count(); ++cell) {
    const auto at = grid.cell_ijk(cell);
    const int gap = at[0] / 2 % 2 == 0 ? 0 : 8;
    if (at[0] % 2 == 1 && at[1] != gap) walls.push_back(cell);
    if (at[0] > 0) far.push_back(cell);
  }
  Cloud<Dim> cloud(grid);
  cloud.remove_from_outside(far);
  cloud.fill(walls, random);
  CHECK(cloud.effect().false_voids == 0);
}
