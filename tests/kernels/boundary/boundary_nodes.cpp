// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Algorithm 1 against its three steps written out over cells and their nodes.
#include <vsb/kernels/boundary/flag_boundary_particles.hpp>
#include <vsb/kernels/boundary/mark_boundary_nodes.hpp>

#include "algorithm_1.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

/// Compares mark_boundary_nodes with algorithm_1; returns the size of N1.
template <int Dim, class Real>
int compare(const UniformGrid<Dim, Real>& grid, const std::vector<bool>& void_cell, Random& random) {
  const auto list = list_nodes(grid);
  REQUIRE(list.node_count == grid.node_count());
  REQUIRE(list.nodes_of_cell.size() == void_cell.size());
  const auto n1 = algorithm_1(list, void_cell);

  const auto n = static_cast<size_t>(grid.node_count());
  const BoundaryNodes<Device> tractions("vsb::tractions", n), boundary("vsb::boundary", n);
  std::vector<TractionMask> declared(n);
  for (auto& mask : declared) mask = static_cast<TractionMask>(random.index(4));  // a quarter without any
  edit(tractions, [&](const auto& host) { std::copy(declared.begin(), declared.end(), host.data()); });
  Kokkos::deep_copy(boundary, 77u);
  const auto block = populate(grid, void_cell, random);
  const auto bits = allocate_cell_bits<Device>(grid);
  Kokkos::deep_copy(bits.occupied, ~std::uint64_t(0));  // what a call leaves must not matter to the next
  Kokkos::deep_copy(bits.exterior, ~std::uint64_t(0));
  Kokkos::deep_copy(bits.boundary, ~std::uint64_t(0));
  const int count =
      mark_boundary_nodes(Exec(), block.particles, bits, LinearBasis<Dim, Real>{grid}, tractions, boundary);

  const auto got = read(boundary);
  int loaded = 0, wrong = 0;
  for (size_t node = 0; node < n; ++node) {
    const TractionMask expected = n1.count(static_cast<int>(node)) ? declared[node] : 0;
    loaded += expected != 0;
    wrong += got(node) != expected;
  }
  CHECK(wrong == 0);
  CHECK(count == loaded);
  return static_cast<int>(n1.size());
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("random bodies", "", ((int Dim, typename Real), Dim, Real), (1, double), (2, double),
                       (3, double), (2, float)) {
  Random random(21);
  const int rows = Dim == 3 ? 4 : 6;
  for (const int nx : {1, 2, 5, 62, 63, 64, 65, 127, 128, 130, 200})
    for (const double fill : {0.02, 0.2, 0.5, 0.9, 0.99}) {
      const auto grid = make_grid<Dim, Real>({{nx, rows, rows - 1}});
      std::vector<bool> void_cell(static_cast<size_t>(grid.cell_count()));
      for (size_t c = 0; c < void_cell.size(); ++c) void_cell[c] = random(0, 1) > fill;
      CAPTURE(nx, fill);
      compare(grid, void_cell, random);
    }
}

TEMPLATE_TEST_CASE_SIG("bodies with smooth boundaries", "", ((int Dim), Dim), 1, 2, 3) {
  // A ball with a hole, across the words of a row and cut by the grid's faces.
  Random random(22);
  const auto grid = make_grid<Dim, double>({{150, 24, 9}});
  for (const double centre : {0., 63.3, 64., 149.}) {
    std::vector<bool> void_cell;
    for_each_cell(grid, [&](const Vector<Dim, int>& cell) {
      double r2 = 0;
      const double middle[] = {centre, 8, 3};
      for (int i = 0; i < Dim; ++i) r2 += (cell[i] - middle[i]) * (cell[i] - middle[i]);
      void_cell.push_back(r2 > 100 || r2 < 10);
    });
    CAPTURE(centre);
    CHECK(compare(grid, void_cell, random) > 0);
  }
}

TEMPLATE_TEST_CASE_SIG(
    "a grid without void cells has no boundary, one with a single void cell has its neighbours", "",
    ((int Dim), Dim), 1, 2, 3) {
  Random random(23);
  for (const int nx : {6, 63, 64, 65, 130}) {
    const auto grid = make_grid<Dim, double>({{nx, 6, 6}});
    std::vector<bool> void_cell(static_cast<size_t>(grid.cell_count()), false);
    CHECK(compare(grid, void_cell, random) == 0);
    for (const int x : {2, nx - 3}) {  // two cells away from every face
      int cell = x, nodes = 4;
      for (int i = 1, stride = nx; i < Dim; ++i, stride *= 6, nodes *= 4) cell += 3 * stride;
      void_cell[static_cast<size_t>(cell)] = true;
      CHECK(compare(grid, void_cell, random) == nodes);  // those of 3 x 3 x 3 cells
      void_cell[static_cast<size_t>(cell)] = false;
    }
  }
}

TEMPLATE_TEST_CASE_SIG("a single particle loads the nodes of its cell", "", ((int Dim), Dim), 1, 2, 3) {
  Random random(24);
  for (const int nx : {3, 63, 64, 65, 200})
    for (const int x : {0, 1, nx - 1}) {
      const auto grid = make_grid<Dim, double>({{nx, 3, 2}});
      std::vector<bool> void_cell(static_cast<size_t>(grid.cell_count()), true);
      void_cell[static_cast<size_t>(x)] = false;
      CAPTURE(nx, x);
      CHECK(compare(grid, void_cell, random) == 1 << Dim);
    }
}

TEST_CASE("faces of the grid make no boundary") {
  // Two of five cells filled, at the grid's left face: only the right end is free, and E2 is its last cell.
  const UniformGrid<1, double> grid({{0}}, {{1}}, {{5}});
  const auto block = fill_cells<1, double>(grid, 2, 1., [](const auto& cell) { return cell[0] < 2; });
  const BoundaryNodes<Device> tractions("vsb::tractions", 6), boundary("vsb::boundary", 6);
  Kokkos::deep_copy(tractions, 1u);
  const auto bits = allocate_cell_bits<Device>(grid);
  CHECK(mark_boundary_nodes(Exec(), block.particles, bits, LinearBasis<1, double>{grid}, tractions,
                            boundary) == 2);
  const auto host = read(boundary);
  const TractionMask expected[] = {0, 1, 1, 0, 0, 0};
  for (int node = 0; node < 6; ++node) CHECK(host(node) == expected[node]);
}

TEST_CASE("without particles no node is loaded") {
  const auto grid = make_grid<2, double>();
  const auto n = static_cast<size_t>(grid.node_count());
  const BoundaryNodes<Device> tractions("vsb::tractions", n), boundary("vsb::boundary", n);
  Kokkos::deep_copy(tractions, 1u);
  const auto block = allocate_particles<2, double, Device>(0);
  CHECK(mark_boundary_nodes(Exec(), block.particles, allocate_cell_bits<Device>(grid),
                            LinearBasis<2, double>{grid}, tractions, boundary) == 0);
}

TEMPLATE_TEST_CASE_SIG("a particle is flagged if a corner of its cell is loaded", "", ((int Dim), Dim), 1, 2,
                       3) {
  const auto grid = make_grid<Dim, double>({{12, 7, 5}});
  const int n = 500;
  const auto block = random_particles(grid, n, 25);
  const BoundaryNodes<Device> boundary("vsb::boundary", static_cast<size_t>(grid.node_count()));
  Random random(26);
  edit(boundary, [&](const auto& host) {
    for (int I = 0; I < grid.node_count(); ++I) host(I) = random(0, 1) < 0.2 ? 1u << random.index(32) : 0;
  });
  const Kokkos::View<unsigned char*, Device> flag("vsb::flag", n);
  Kokkos::deep_copy(flag, static_cast<unsigned char>(9));
  flag_boundary_particles(Exec(), block.particles, boundary, LinearBasis<Dim, double>{grid}, flag);
  const auto loaded = read(boundary);
  const auto flags = read(flag);
  const auto particles = read(block);
  const auto list = list_nodes(grid);
  int wrong = 0, flagged = 0;
  for (int p = 0; p < n; ++p) {
    int cell = 0;
    for (int i = Dim - 1; i >= 0; --i)
      cell = cell * grid.cells[i] +
             static_cast<int>((particles.position(p, i) - grid.lower[i]) / grid.spacing[i]);
    bool expected = false;
    for (const int node : list.nodes_of_cell[static_cast<size_t>(cell)])
      expected = expected || loaded(node) != 0;
    wrong += flags(p) != expected;
    flagged += expected;
  }
  CHECK(wrong == 0);
  CHECK((flagged > 0 && flagged < n));
}
