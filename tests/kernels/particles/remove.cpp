// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Particles that are removed leave the others as they were, in their order; the measure by which they are
/// judged, and its smoothing.
#include <algorithm>
#include <vsb/kernels/particles/locate_particles.hpp>
#include <vsb/kernels/particles/remove_particles.hpp>
#include <vsb/kernels/readout/plastic_strain.hpp>
#include <vsb/kernels/readout/smooth_particles.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

using Flags = Kokkos::View<unsigned char*, Device>;
using Ints = Kokkos::View<int*, Device>;

Flags flags_of(const std::vector<unsigned char>& removed) {
  const Flags flags("vsb::flags", removed.size());
  edit(flags, [&](const auto& host) { std::copy(removed.begin(), removed.end(), host.data()); });
  return flags;
}

Ints ints_of(const std::vector<int>& values) {
  const Ints ints("vsb::ints", values.size());
  edit(ints, [&](const auto& host) { std::copy(values.begin(), values.end(), host.data()); });
  return ints;
}

/// A number that tells particle, field and component.
template <class Real>
Real code(int p, int field, int component) {
  return static_cast<Real>(100 * p + 10 * field + component + 1);
}

/// Particles whose numbers are codes, with three columns of state for those from `first_with_state` on.
template <int Dim, class Real>
ParticleBlock<Dim, Real, Device> coded_particles(int count, int first_with_state) {
  auto block = allocate_particles<Dim, Real, Device>(count);
  allocate_material_state(block, count - first_with_state, 3);
  edit(block, [&](const auto& q) {
    for (int p = 0; p < count; ++p) {
      for (int i = 0; i < Dim; ++i) {
        q.position(p, i) = code<Real>(p, 0, i);
        q.velocity(p, i) = code<Real>(p, 1, i);
      }
      q.mass(p) = code<Real>(p, 2, 0);
      q.volume(p) = code<Real>(p, 3, 0);
      for (int c = 0; c < q.stress_size; ++c) q.cauchy_stress(p, c) = code<Real>(p, 4, c);
      for (int c = 0; c < 3 && p >= first_with_state; ++c)
        q.material_state(p - first_with_state, c) = code<Real>(p, 5, c);
    }
  });
  return block;
}

/// Removes the flagged ones of `count` particles, and checks every number of those that stay.
template <int Dim, class Real>
void check_removal(const std::vector<unsigned char>& removed, int first_with_state) {
  const int count = static_cast<int>(removed.size());
  std::vector<int> expected, states;
  for (int p = 0; p < count; ++p) {
    if (removed[static_cast<size_t>(p)] != 0) continue;
    expected.push_back(p);
    if (p >= first_with_state) states.push_back(p - first_with_state);
  }
  const auto kept = list_kept<Exec, Device>(Exec(), flags_of(removed));
  const auto listed = read(kept);
  REQUIRE(std::vector<int>(listed.data(), listed.data() + listed.extent(0)) == expected);

  const auto before = coded_particles<Dim, Real>(count, first_with_state);
  const auto after = keep_particles<Exec, Dim, Real, Device>(Exec(), before, kept, ints_of(states));
  CHECK(after.block.data() == before.block.data());
  const auto q = read(after);
  REQUIRE(q.count() == static_cast<int>(expected.size()));
  REQUIRE(q.material_state.extent(0) == states.size());
  q.check();
  for (size_t k = 0; k < expected.size(); ++k) {
    const int p = expected[k];
    for (int i = 0; i < Dim; ++i) {
      CHECK(q.position(k, i) == code<Real>(p, 0, i));
      CHECK(q.velocity(k, i) == code<Real>(p, 1, i));
    }
    CHECK(q.mass(k) == code<Real>(p, 2, 0));
    CHECK(q.volume(k) == code<Real>(p, 3, 0));
    for (int c = 0; c < q.stress_size; ++c) CHECK(q.cauchy_stress(k, c) == code<Real>(p, 4, c));
  }
  for (size_t r = 0; r < states.size(); ++r)
    for (int c = 0; c < 3; ++c)
      CHECK(q.material_state(r, c) == code<Real>(states[r] + first_with_state, 5, c));
}

}  // namespace

TEST_CASE("particles that stay keep their order and all of their numbers") {
  Random random(4711);
  for (const double share : {0.02, 0.5, 0.97}) {
    std::vector<unsigned char> removed(3000);
    for (auto& flag : removed) flag = random(0, 1) < share;
    check_removal<2, double>(removed, 1000);
    check_removal<3, float>(removed, 0);
  }
}

TEST_CASE("nothing removed, all but the last one, and every particle with a state") {
  check_removal<1, double>(std::vector<unsigned char>(50, 0), 0);
  std::vector<unsigned char> removed(50, 1);
  removed.back() = 0;
  check_removal<1, double>(removed, 20);
  removed.assign(50, 0);
  std::fill(removed.begin() + 20, removed.end(), 1);
  check_removal<3, double>(removed, 20);
}

TEST_CASE("rows of a caller's strided array move up within it") {
  std::vector<double> mine(5 * 4, -1);
  for (int p = 0; p < 5; ++p)
    for (int c = 0; c < 2; ++c) mine[static_cast<size_t>(4 * p + 2 * c)] = 10 * p + c;
  using Host = Kokkos::HostSpace::device_type;
  const auto field = Particles<2, double, Host>::wrap(mine.data(), 5, 2, 4, 2);
  const Kokkos::View<int*, Host> kept("vsb::kept", 2);
  kept(0) = 1;
  kept(1) = 4;
  keep_rows<Kokkos::DefaultHostExecutionSpace, double, Host>(Kokkos::DefaultHostExecutionSpace(), field, kept,
                                                             Kokkos::View<double*, Host>("vsb::scratch", 2));
  Kokkos::fence();
  CHECK(mine ==
        std::vector<double>{10, -1, 11, -1, 40, -1, 41, -1, 20, -1, 21, -1, 30, -1, 31, -1, 40, -1, 41, -1});
}

TEST_CASE("the equivalent plastic strain is read from the state of a body's particles alone") {
  const auto block = coded_particles<2, double>(4, 0);
  auto with_states = block;
  allocate_material_state(with_states, 3, 5);  // particles 1, 2 and 3
  edit(with_states, [](const auto& q) {
    // Isochoric stretch e; shear gamma / 2; a change of volume alone.
    const double rows[3][5] = {{2e-3, -1e-3, -1e-3, 0, 7}, {0, 0, 0, 1.5e-3, 7}, {4e-3, 4e-3, 4e-3, 0, 7}};
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 5; ++c) q.material_state(r, c) = rows[r][c];
  });
  const Kokkos::View<double*, Device> strain("vsb::strain", 4);
  Kokkos::deep_copy(strain, -1.0);
  equivalent_plastic_strain(Exec(), with_states.particles, 1, 4, -1, strain);
  const auto found = read(strain);
  CHECK(found(0) == -1);
  CHECK(found(1) == Approx(2e-3).epsilon(1e-14));
  CHECK(found(2) == Approx(3e-3 / std::sqrt(3.0)).epsilon(1e-14));
  CHECK(std::abs(found(3)) < 1e-17);
}

TEST_CASE("smoothing is what the hat functions say, keeps a constant, and the sum over the masses") {
  const UniformGrid<2, double> grid({{0, 0}}, {{0.5, 0.25}}, {{4, 4}});
  const LinearBasis<2, double> basis{grid};
  const int count = 60;
  const auto block = allocate_particles<2, double, Device>(count);
  Random random(99);
  std::vector<double> q(count);
  edit(block, [&](const auto& particles) {
    for (int p = 0; p < count; ++p) {
      particles.position(p, 0) = random(0.0, 2.0);
      particles.position(p, 1) = random(0.0, 1.0);
      particles.mass(p) = random(0.5, 2.0);
      particles.volume(p) = 1;
      q[static_cast<size_t>(p)] = random(0.0, 1.0);
    }
  });
  auto bins = allocate_bins<Device>(count, basis.bin_count());
  REQUIRE(locate_particles(Exec(), block.particles, bins, basis).lost == -1);
  sort_by_bin(Exec(), bins);
  const auto smoothed = [&](const std::vector<double>& values, Scatter strategy) {
    const Kokkos::View<double*, Device> view("vsb::q", values.size());
    edit(view, [&](const auto& host) { std::copy(values.begin(), values.end(), host.data()); });
    smooth_particles(Exec(), block.particles, bins, basis, view, strategy);
    return read(view);
  };
  const auto host = read(block);
  const auto hat = [&](int p, int i, int j) {
    const double a = 1 - std::abs(host.position(p, 0) / 0.5 - i),
                 b = 1 - std::abs(host.position(p, 1) / 0.25 - j);
    return std::max(a, 0.0) * std::max(b, 0.0);
  };
  const auto found = smoothed(q, Scatter::gathered), other = smoothed(q, Scatter::atomic);
  std::vector<double> expected(count, 0.0);
  for (int i = 0; i <= 4; ++i)
    for (int j = 0; j <= 4; ++j) {
      double m = 0, mq = 0;
      for (int p = 0; p < count; ++p) {
        m += hat(p, i, j) * host.mass(p);
        mq += hat(p, i, j) * host.mass(p) * q[static_cast<size_t>(p)];
      }
      for (int p = 0; p < count && m > 0; ++p) expected[static_cast<size_t>(p)] += hat(p, i, j) * mq / m;
    }
  double before = 0, after = 0;
  for (int p = 0; p < count; ++p) {
    const auto k = static_cast<size_t>(p);
    CHECK(found(k) == Approx(expected[k]).epsilon(1e-12));
    CHECK(other(k) == Approx(expected[k]).epsilon(1e-12));
    before += host.mass(p) * q[k];
    after += host.mass(p) * found(k);
  }
  CHECK(after == Approx(before).epsilon(1e-13));
  const auto constant = smoothed(std::vector<double>(count, 0.7), Scatter::gathered);
  for (size_t p = 0; p < count; ++p) CHECK(constant(p) == Approx(0.7).epsilon(1e-14));
}
