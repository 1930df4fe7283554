// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Bundles of particle data: shapes, layout, and a caller's own arrays.
#include <set>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

TEMPLATE_TEST_CASE_SIG("check names the field that has the wrong shape", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, float), (3, double)) {
  const auto good = allocate_particles<Dim, Real, Device>(5).particles;
  const auto five_by_seven = Kokkos::View<Real**, Kokkos::LayoutLeft, Device>("vsb::five_by_seven", 5, 7);
  const auto four_by = [](int columns) {
    return Kokkos::View<Real**, Kokkos::LayoutLeft, Device>("vsb::four", 4, static_cast<size_t>(columns));
  };
  CHECK_NOTHROW(good.check());
  auto bad = good;
  SECTION("columns of position") {
    bad.position = five_by_seven;
    CHECK_THROWS_WITH(bad.check(), containing("position is 5 x 7, expected 5 x " + std::to_string(Dim)));
  }
  SECTION("rows of position") {  // which are the number of particles
    bad.position = four_by(Dim);
    CHECK_THROWS_WITH(bad.check(), containing("velocity is 5 x " + std::to_string(Dim) + ", expected 4 x"));
  }
  SECTION("columns of velocity") {
    bad.velocity = five_by_seven;
    CHECK_THROWS_WITH(bad.check(), containing("velocity is 5 x 7"));
  }
  SECTION("rows of velocity") {
    bad.velocity = four_by(Dim);
    CHECK_THROWS_AS(bad.check(), std::invalid_argument);
  }
  SECTION("rows of volume") {
    bad.volume = Kokkos::View<Real*, Device>("vsb::six", 6);
    CHECK_THROWS_WITH(bad.check(), containing("volume is 6 x 1, expected 5 x 1"));
  }
  SECTION("columns of stress") {
    bad.cauchy_stress = five_by_seven;
    CHECK_THROWS_WITH(bad.check(), containing("cauchy_stress is 5 x 7, expected 5 x " +
                                              std::to_string(symmetric_components(Dim))));
  }
  SECTION("no stress at all") {
    bad.cauchy_stress = {};
    CHECK_THROWS_WITH(bad.check(), containing("cauchy_stress is 0 x"));
  }
}

TEMPLATE_TEST_CASE("padded columns start at different offsets in a page", "", float, double) {
  const int line = 64 / static_cast<int>(sizeof(TestType));
  for (const int n : {0, 1, 7, 8, 9, 16, 17, 63, 64, 65, 512, 1000, 1023, 1024, 4096, 805392}) {
    const int rows = padded_rows<TestType>(n);
    CAPTURE(n, rows);
    CHECK(rows >= n);
    CHECK(rows < n + 2 * line);
    CHECK(rows % line == 0);
    std::set<size_t> starts;
    for (size_t column = 0; column < 64; ++column)
      starts.insert(column * static_cast<size_t>(rows) * sizeof(TestType) % 4096);
    CHECK(starts.size() == 64);
  }
}

TEMPLATE_TEST_CASE_SIG("the fields of a block are zero, apart, and fill its columns", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, float), (3, double)) {
  const int n = 9;
  const auto block = allocate_particles<Dim, Real, Device>(n);
  REQUIRE_NOTHROW(block.particles.check());
  REQUIRE(block.particles.count() == n);
  const int stresses = symmetric_components(Dim);

  int entry = 0;
  const auto visit = [&](const auto& particles, const auto& with) {
    entry = 0;
    for (int p = 0; p < n; ++p) {
      for (int i = 0; i < Dim; ++i) with(particles.position(p, i), ++entry);
      for (int i = 0; i < Dim; ++i) with(particles.velocity(p, i), ++entry);
      with(particles.mass(p), ++entry);
      with(particles.volume(p), ++entry);
      for (int c = 0; c < stresses; ++c) with(particles.cauchy_stress(p, c), ++entry);
    }
  };
  int zeros = 0, kept = 0;
  edit(block, [&](const auto& particles) {
    visit(particles, [&](Real& value, int) { zeros += value == 0; });
    visit(particles, [](Real& value, int number) { value = static_cast<Real>(number); });
  });
  visit(read(block), [&](const Real& value, int number) { kept += value == static_cast<Real>(number); });
  CHECK(zeros == entry);
  CHECK(kept == entry);
  CHECK(entry == n * static_cast<int>(block.block.extent(1)));

  const auto last = read(block);
  CHECK(last.position_of(1)[Dim - 1] == last.position(1, Dim - 1));
  CHECK(last.velocity_of(1)[0] == last.velocity(1, 0));
  CHECK(last.stress_of(n - 1)[stresses - 1] == static_cast<Real>(entry));
}

TEST_CASE("host_copy copies nothing where the device is the host, and is a block of its own elsewhere") {
  const auto block = allocate_particles<2, double, Device>(3);
  const auto copy = host_copy(block);
  REQUIRE(copy.particles.count() == 3);
  const bool same_memory = std::is_same_v<Device::memory_space, Kokkos::HostSpace>;
  CHECK((static_cast<void*>(copy.block.data()) == static_cast<void*>(block.block.data())) == same_memory);
  CHECK_NOTHROW(copy.particles.check());
}

TEST_CASE("an unmanaged field finds each component of an array of structures") {
  struct Record {
    int id;
    double x[2];
    char tag;
    double sigma[4];
  };
  static_assert(sizeof(Record) % sizeof(double) == 0, "rows are a whole number of doubles apart");
  std::vector<Record> records(4);
  double value = 0;
  for (auto& r : records) {
    for (auto& x : r.x) x = ++value;
    for (auto& s : r.sigma) s = ++value;
  }
  const int row = sizeof(Record) / sizeof(double);
  using Wrapping = Particles<2, double, Host>;
  const auto x = Wrapping::wrap(records[0].x, 4, 2, row);
  const auto sigma = Wrapping::wrap(records[0].sigma, 4, 4, row);
  value = 0;
  for (int p = 0; p < 4; ++p) {
    for (int i = 0; i < 2; ++i) CHECK(x(p, i) == ++value);
    for (int c = 0; c < 4; ++c) CHECK(sigma(p, c) == ++value);
  }
  sigma(2, 3) = -1;
  CHECK(records[2].sigma[3] == -1);

  // And a structure of arrays, component by component.
  std::vector<double> columns{1, 2, 3, 10, 20, 30};
  const auto v = Wrapping::wrap(columns.data(), 3, 2, 1, 3);
  CHECK(v(2, 0) == 3);
  CHECK(v(0, 1) == 10);
  CHECK(v(2, 1) == 30);
}
