// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Finding the particles' bins, and sorting by them.
#include <algorithm>
#include <numeric>
#include <vsb/kernels/particles/locate_particles.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

TEMPLATE_TEST_CASE_SIG("locate_particles tells changes and losses", "", ((int Dim, typename Real), Dim, Real),
                       (1, double), (2, float), (3, double)) {
  const auto grid = make_grid<Dim, Real>();
  const LinearBasis<Dim, Real> basis{grid};
  const int n = 3000;
  const auto block = random_particles(grid, n, 11);
  const auto bins = allocate_bins<Device>(n, basis.bin_count());
  const auto move = [&](int p, int axis, Real x) {
    edit(block, [&](const auto& particles) { particles.position(p, axis) = x; });
  };
  const auto locate = [&] { return locate_particles(Exec(), block.particles, bins, basis); };

  auto where = locate();
  CHECK(where.changed);
  CHECK(where.lost == -1);
  const auto bin = read(bins.bin);
  const auto particles = read(block);
  int right = 0;
  for (int p = 0; p < n; ++p) right += bin(p) == basis.shape(particles.position_of(p)).node[0];
  CHECK(right == n);

  where = locate();
  CHECK_FALSE(where.changed);
  CHECK(where.lost == -1);

  const Real first_cell = grid.lower[0] + Real(0.5) * grid.spacing[0];
  const Real last_cell = first_cell + static_cast<Real>(grid.cells[0] - 1) * grid.spacing[0];
  move(n - 1, 0, read(block).position(n - 1, 0) < first_cell + grid.spacing[0] ? last_cell : first_cell);
  where = locate();
  CHECK(where.changed);
  CHECK(where.lost == -1);
  CHECK_FALSE(locate().changed);

  move(2000, Dim - 1, Real(1e6));
  CHECK(locate().lost == 2000);
  move(2999, 0, Real(-1e6));
  CHECK(locate().lost == 2000);
  move(1999, Dim - 1, std::numeric_limits<Real>::quiet_NaN());
  CHECK(locate().lost == 1999);
  move(0, 0, -std::numeric_limits<Real>::infinity());
  CHECK(locate().lost == 0);
}

TEST_CASE("a body without particles neither changes nor loses any") {
  const LinearBasis<2, double> basis{make_grid<2, double>()};
  const auto block = allocate_particles<2, double, Device>(0);
  auto bins = allocate_bins<Device>(0, basis.bin_count());
  const auto where = locate_particles(Exec(), block.particles, bins, basis);
  CHECK_FALSE(where.changed);
  CHECK(where.lost == -1);
  sort_by_bin(Exec(), bins);
  CHECK(bins.occupied_count() == 0);
}

TEST_CASE("sort_by_bin agrees with a stable sort, with empty bins and crowded ones") {
  struct Case {
    int particles, bins;
  };
  for (const auto& c : {Case{2000, 300}, Case{2000, 20000}, Case{1, 1}, Case{1, 50}, Case{700, 1}}) {
    auto bins = allocate_bins<Device>(c.particles, c.bins);
    std::vector<int> bin(static_cast<size_t>(c.particles)), order(bin.size());
    Random random(12);
    for (auto& b : bin) b = random.index(c.bins);
    for (size_t i = 0; i < 500 && i < bin.size(); ++i)
      bin[i * 7 % bin.size()] = c.bins / 2;  // 500 in one bin
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int p, int q) { return bin[static_cast<size_t>(p)] < bin[static_cast<size_t>(q)]; });

    edit(bins.bin, [&](const auto& host) { std::copy(bin.begin(), bin.end(), host.data()); });
    for (const bool again : {false, true}) {  // also over the remains of a sort
      sort_by_bin(Exec(), bins);
      const auto got = read(bins.order), offset = read(bins.offset), slot = read(bins.slot),
                 occupied = read(bins.occupied);
      CAPTURE(c.particles, c.bins, again);
      CHECK(std::equal(order.begin(), order.end(), got.data()));
      int filled = 0, before = 0, wrong = 0;
      for (int b = 0; b < c.bins; ++b) {
        const int count = static_cast<int>(std::count(bin.begin(), bin.end(), b));
        wrong += offset(b) != before;
        wrong += slot(b) != (count > 0 ? filled : -1);
        if (count > 0) wrong += occupied(filled++) != b;
        before += count;
      }
      CHECK(wrong == 0);
      CHECK(offset(c.bins) == c.particles);
      CHECK(bins.occupied_count() == filled);
    }
  }
}
