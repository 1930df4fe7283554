// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The fill criterion: by hand in the plane, and against a sum over particles per cell in every dimension.
#include <algorithm>
#include <vsb/kernels/boundary/update_occupancy.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

/// The occupancy of particles under a traction declared at every node.
template <int Dim, class Real>
Occupancy<Device> declare_everywhere(const ParticleBlock<Dim, Real, Device>& block,
                                     const LinearBasis<Dim, Real>& basis) {
  auto occupancy = allocate_occupancy<Device>(block.particles.count(), basis);
  Kokkos::deep_copy(occupancy.tractions, 1u);
  return occupancy;
}

/// The nodes at which a traction acts, in increasing order.
std::vector<int> loaded_nodes(const Occupancy<Device>& occupancy) {
  const auto boundary = read(occupancy.boundary);
  std::vector<int> nodes;
  for (int node = 0; node < static_cast<int>(boundary.extent(0)); ++node)
    if (boundary(node) != 0) nodes.push_back(node);
  return nodes;
}

}  // namespace

TEST_CASE("in a grid without void cells the nodes of the cell that is not full enough are loaded") {
  // Three by four unit cells with two particles of half a cell each; cell (1, 2) holds 0.9 in its two.
  const LinearBasis<2, double> basis{UniformGrid<2, double>({{0, 0}}, {{1, 1}}, {{3, 4}})};
  const auto block = allocate_particles<2, double, Device>(24);
  const auto fill = [&](double first, double second) {
    edit(block, [&](const auto& particles) {
      for (int p = 0; p < 24; ++p) {
        particles.position(p, 0) = p % 3 + (p < 12 ? 0.25 : 0.75);
        particles.position(p, 1) = p % 12 / 3 + 0.5;
        particles.volume(p) = 0.5;
      }
      particles.volume(7) = first;
      particles.volume(19) = second;
    });
  };
  fill(0.6, 0.3);
  auto occupancy = declare_everywhere(block, basis);
  const auto update = [&] {
    REQUIRE(update_occupancy(Exec(), block.particles, occupancy, basis) == -1);
    return loaded_nodes(occupancy);
  };
  const std::vector<int> none, corners{9, 10, 13, 14};  // nodes are numbered along x, four in a row
  CHECK(update() == none);                              // no criterion

  set_fill_criterion(occupancy, 0.05);
  CHECK(update() == corners);  // the criterion is new, no particle has moved
  CHECK(occupancy.boundary_node_count == 4);
  fill(0.6, 0.36);
  CHECK(update() == none);  // 0.96: the volumes alone have changed
  CHECK(occupancy.boundary_node_count == 0);
  fill(0.59, 0.35);
  CHECK(update() == corners);
  set_fill_criterion(occupancy, 0.07);
  CHECK(update() == none);

  // A node where no traction is declared stays free.
  set_fill_criterion(occupancy, 0.05);
  edit(occupancy.tractions, [](const auto& host) { host(10) = 0; });
  const std::vector<int> declared{9, 13, 14};
  CHECK(update() == declared);

  // A void cell is E1, not an underfilled cell: of cell (1, 2) alone its neighbours remain, whose nodes are
  // all.
  edit(block, [](const auto& particles) {
    for (const int p : {7, 19}) particles.position(p, 1) = 0.5;
  });
  edit(occupancy.tractions, [](const auto& host) { host(10) = 1; });
  const auto around = update();
  CHECK(around.size() == 16);  // rows 1 to 4: the 3 x 3 cells around the void one
  CHECK(around.front() == 4);
}

TEST_CASE("underfilled cells are told from the present volumes when a particle leaves the grid, too") {
  const LinearBasis<1, double> basis{UniformGrid<1, double>({{0}}, {{1}}, {{3}})};
  const auto block = fill_cells<1, double>(basis.grid, 1, 1., [](const auto&) { return true; });
  auto occupancy = declare_everywhere(block, basis);
  set_fill_criterion(occupancy, 0.5);
  REQUIRE(update_occupancy(Exec(), block.particles, occupancy, basis) == -1);
  CHECK(occupancy.boundary_node_count == 0);
  edit(block, [](const auto& particles) { particles.position(2, 0) = 7; });
  CHECK(update_occupancy(Exec(), block.particles, occupancy, basis) == 2);
}

TEMPLATE_TEST_CASE_SIG("random fills", "", ((int Dim, typename Real), Dim, Real), (1, double), (2, double),
                       (3, double), (2, float)) {
  Random random(31);
  const int rows = Dim == 3 ? 4 : 6;
  int marked_by_fill = 0;
  for (const int nx : {1, 2, 5, 62, 63, 64, 65, 127, 128, 130})
    for (const double void_share : {0.0, 0.02, 0.3}) {
      CAPTURE(nx, void_share);
      const auto grid = make_grid<Dim, Real>({{nx, rows, rows - 1}});
      const LinearBasis<Dim, Real> basis{grid};
      struct Cell {
        Vector<Dim, int> at;
        double fill;
      };
      std::vector<Cell> cells;
      std::vector<std::pair<Vector<Dim, Real>, Real>> particles;
      for_each_cell(grid, [&](const Vector<Dim, int>& at) {
        if (random(0, 1) < void_share) return;
        // Three particles; the fills keep clear of the criterion, 0.8, by more than round-off.
        const double fill = random(0, 1) < 0.1 ? random(0.1, 0.79) : random(0.81, 1.2);
        for (const double share : {0.5, 0.3, 0.2}) {
          Vector<Dim, Real> x;
          for (int i = 0; i < Dim; ++i)
            x[i] =
                grid.lower[i] + grid.spacing[i] * (static_cast<Real>(at[i]) + random.draw<Real>(0.01, 0.99));
          particles.emplace_back(x, static_cast<Real>(share * fill) * grid.cell_volume());
        }
        cells.push_back({at, fill});
      });
      random.shuffle(particles);
      const auto block = allocate_particles<Dim, Real, Device>(static_cast<int>(particles.size()));
      edit(block, [&](const auto& host) {
        for (size_t p = 0; p < particles.size(); ++p) {
          for (int i = 0; i < Dim; ++i) host.position(p, i) = particles[p].first[i];
          host.volume(p) = particles[p].second;
        }
      });

      auto plain = declare_everywhere(block, basis), filled = declare_everywhere(block, basis);
      set_fill_criterion(filled, 0.2);
      Kokkos::deep_copy(filled.cells.underfilled, ~std::uint64_t(0));  // what is left must not matter
      REQUIRE(update_occupancy(Exec(), block.particles, plain, basis) == -1);
      REQUIRE(update_occupancy(Exec(), block.particles, filled, basis) == -1);

      std::vector<char> expected(static_cast<size_t>(grid.node_count()), 0);
      for (const int node : loaded_nodes(plain)) expected[static_cast<size_t>(node)] = 1;
      for (const auto& cell : cells)
        for (int corner = 0; corner < 1 << Dim; ++corner) {
          int node = 0;
          for (int i = Dim - 1; i >= 0; --i)
            node = node * (grid.cells[i] + 1) + cell.at[i] + (corner >> i & 1);
          char& mark = expected[static_cast<size_t>(node)];
          if (cell.fill < 0.8 && mark == 0) {
            mark = 1;
            ++marked_by_fill;
          }
        }
      const auto loaded = loaded_nodes(filled);
      int wrong =
          static_cast<int>(std::count(expected.begin(), expected.end(), 1)) - static_cast<int>(loaded.size());
      for (const int node : loaded) wrong += expected[static_cast<size_t>(node)] == 0;
      CHECK(wrong == 0);
      CHECK(filled.boundary_node_count == static_cast<int>(loaded.size()));
    }
  CHECK(marked_by_fill > 100);
}
