// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The recovered stress, means over cells, and their error norms.
#include "report/recovered_stress.hpp"

#include "app/shapes.hpp"
#include "engine/simulation.hpp"
#include "report/cell_means.hpp"
#include "report/comparison.hpp"

using namespace vsb::app;
using vsb::test::grid_scene;
using vsb::test::Random;
using vsb::test::WithinAbs;
using vsb::test::WithinRel;

namespace {

using Field = std::array<double, 6> (*)(const Point&);

std::array<double, 6> linear(const Point& x) {
  std::array<double, 6> stress{};
  for (size_t c = 0; c < 6; ++c) {
    const double s = static_cast<double>(c) + 1;
    stress[c] = 1e5 * (s + 0.3 * x[0] - s * 0.2 * x[1] + 0.7 * x[2]);
  }
  return stress;
}

void add_particle(Snapshot& s, const Point& x, double volume, const std::array<double, 6>& stress) {
  s.id.push_back(static_cast<std::int64_t>(s.id.size()));
  s.position.insert(s.position.end(), x.begin(), x.end());
  s.initial_position.insert(s.initial_position.end(), x.begin(), x.end());
  s.volume.push_back(volume);
  s.cauchy_stress.insert(s.cauchy_stress.end(), stress.begin(), stress.end());
}

/// Passes the particles of a snapshot on two at a time.
class TwoByTwo final : public ParticleReader {
 public:
  explicit TwoByTwo(const Snapshot& s) : s_(s) {
    count = s.count();
    recovered_stress = s.recovered_stress;
  }

 private:
  void visit(unsigned fields, const std::function<void(Snapshot&)>& work) const override {
    for (size_t first = 0; first < count; first += 2) {
      const size_t last = std::min(first + 2, count);
      Snapshot part;
      part.first = first;
      part.bodies = s_.bodies;
      part.id.assign(s_.id.begin() + static_cast<std::ptrdiff_t>(first),
                     s_.id.begin() + static_cast<std::ptrdiff_t>(last));
      const auto pass = [&](unsigned field, std::vector<double> Snapshot::*values, size_t columns) {
        if ((fields & field) != 0)
          (part.*values)
              .assign(&(s_.*values)[columns * first],
                      &(s_.*values)[columns * first] + columns * (last - first));
      };
      pass(field::initial_position, &Snapshot::initial_position, 3);
      pass(field::position, &Snapshot::position, 3);
      pass(field::cauchy_stress, &Snapshot::cauchy_stress, 6);
      pass(field::volume, &Snapshot::volume, 1);
      work(part);
    }
  }
  const Snapshot& s_;
};

auto errors_of(const Scene& scene, const Snapshot& s) {
  return compare_with_exact(scene, TwoByTwo(s)).errors;
}

/// n particles anywhere in the grid, every seventh a sliver.
Snapshot irregular(const Scene& scene, int n, const Field& field, unsigned seed, double sliver = 1e-9) {
  Random random(seed);
  Snapshot s;
  for (int p = 0; p < n; ++p) {
    Point x{};
    for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i) {
      const auto [low, high] = extent(scene.grid, i);
      x[i] = random(low + 0.1 * (high - low), high);
    }
    const double volume = random(0.5, 1.5);
    add_particle(s, x, p % 7 == 0 ? sliver * volume : volume, field(x));
  }
  s.bodies = {{0, n}};
  return s;
}

Scene graded_scene(int dimension) {
  Scene scene = grid_scene(dimension, 0, 1, 4);
  for (size_t i = 0; i < static_cast<size_t>(dimension); ++i) scene.grid.coordinates[i] = {0, 1, 1.5, 2.5, 4};
  return scene;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  double most = 0;
  for (size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

}  // namespace

TEST_CASE("a linear stress comes back from irregular particles as it was, slivers or not") {
  for (const int d : {1, 2, 3})
    for (const bool mapped : {false, true})
      for (const int n : {6, 60, 900}) {  // fewer than nodes, about as many, more
        const Scene scene = mapped ? graded_scene(d) : grid_scene(d, -1, 0.5, 4);
        // Where nodes outnumber particles, that of a sliver alone decides something.
        Snapshot s = irregular(scene, n, linear, static_cast<unsigned>(n), n == 900 ? 1e-9 : 1e-4);
        s.recovered_stress = recovered_stress(scene, s);
        INFO(d << "D, " << n << " particles, mapped " << mapped);
        CHECK(largest_difference(s.recovered_stress, s.cauchy_stress) < 1e-4);  // of 1e5: solver's round-off
      }
}

TEST_CASE("what the recovery leaves of any stress is orthogonal to the basis functions") {
  const Scene scene = grid_scene(2, 0, 1, 3);
  const Field rough = [](const Point& x) {
    std::array<double, 6> stress{};
    for (size_t c = 0; c < 6; ++c) stress[c] = std::sin(40 * x[0] + 70 * x[1] + static_cast<double>(c));
    return stress;
  };
  Snapshot s = irregular(scene, 100, rough, 3);
  s.recovered_stress = recovered_stress(scene, s);
  CHECK(largest_difference(s.recovered_stress, s.cauchy_stress) > 0.1);
  for (int node = 0; node < 16; ++node)
    for (size_t c = 0; c < 6; ++c) {
      double sum = 0;
      for (size_t p = 0; p < s.count(); ++p) {
        // The hat functions of nodes at whole numbers, written out.
        const double N = std::max(0.0, 1 - std::abs(s.position[3 * p] - node % 4)) *
                         std::max(0.0, 1 - std::abs(s.position[3 * p + 1] - node / 4));
        sum += s.volume[p] * N * (s.recovered_stress[6 * p + c] - s.cauchy_stress[6 * p + c]);
      }
      CHECK_THAT(sum, WithinAbs(0, 1e-11));
    }
}

TEST_CASE(
    "two particles in a cell in 1D, by hand: the projection goes through both; three: the weighted line") {
  const Scene scene = grid_scene(1, 0, 1, 1);
  Snapshot s;
  add_particle(s, {0.2, 0, 0}, 1, {3, 0, 0, 0, 0, 0});
  add_particle(s, {0.7, 0, 0}, 5, {-2, 0, 0, 0, 0, 0});
  s.bodies = {{0, 2}};
  s.recovered_stress = recovered_stress(scene, s);
  CHECK_THAT(s.recovered_stress[0], WithinRel(3, 1e-10));
  CHECK_THAT(s.recovered_stress[6], WithinRel(-2, 1e-10));
  // Values 0, 3, 0 at 0.25, 0.5, 0.75 with weights 1, 2, 1: the mean 1.5, without a slope by symmetry.
  Snapshot t;
  for (const double x : {0.25, 0.5, 0.75})
    add_particle(t, {x, 0, 0}, x == 0.5 ? 2 : 1, {x == 0.5 ? 3.0 : 0.0, 0, 0, 0, 0, 0});
  t.bodies = {{0, 3}};
  t.recovered_stress = recovered_stress(scene, t);
  for (size_t p = 0; p < 3; ++p) CHECK_THAT(t.recovered_stress[6 * p], WithinRel(1.5, 1e-10));
}

TEST_CASE("one particle per cell: more nodes than particles, and still the stress at the particles") {
  const Scene scene = grid_scene(2, 0, 1, 3);
  Snapshot s;
  for (int n = 0; n < 9; ++n) {
    const Point x{n % 3 + 0.5, n / 3 + 0.5, 0};
    add_particle(s, x, 1, linear(x));
  }
  s.bodies = {{0, 9}};
  s.recovered_stress = recovered_stress(scene, s);
  CHECK(largest_difference(s.recovered_stress, s.cauchy_stress) < 1e-4);
}

TEST_CASE("a jump between two bodies stays sharp") {
  const Scene scene = grid_scene(2, 0, 1, 2);
  Snapshot s;
  for (int body = 0; body < 2; ++body)
    for (int n = 0; n < 16; ++n)
      add_particle(s, {0.5 * body + 0.5 * (n % 4) / 4 + 0.06, 0.25 * (n / 4) + 0.1, 0}, 1,
                   {body == 0 ? 1e6 : -7.0, 0, 0, 0, 0, 0});
  s.bodies = {{0, 16}, {16, 32}};
  s.recovered_stress = recovered_stress(scene, s);
  CHECK(largest_difference(s.recovered_stress, s.cauchy_stress) < 1e-6);
}

TEST_CASE("a stress that is not finite cannot be recovered") {
  const Scene scene = grid_scene(1, 0, 1, 1);
  Snapshot s;
  add_particle(s, {0.2, 0, 0}, 1, {std::nan(""), 0, 0, 0, 0, 0});
  s.bodies = {{0, 1}};
  CHECK_THROWS_AS(recovered_stress(scene, s), Diverged);
}

TEST_CASE("means over cells, by hand") {
  const Scene scene = grid_scene(2, 0, 1, 2);
  Snapshot s;
  add_particle(s, {1.2, 0.1, 0}, 1, {4, 0, 0, 8, 0, 0});
  add_particle(s, {0.5, 0.5, 0}, 2, {1, 2, 3, 4, 5, 6});
  add_particle(s, {1.6, 0.9, 0}, 3, {8, 4, 0, 0, 0, 0});
  add_particle(s, {1.6, 0.3, 0}, 5, {7, 7, 7, 7, 7, 7});  // of another body in the same cell
  s.bodies = {{0, 3}, {3, 4}};
  const auto means = cell_means(scene, TwoByTwo(s));
  CHECK(means.volume == std::vector<double>{2, 4, 5});
  const std::vector<double> position{0.5, 0.5, 0, 1.5, 0.7, 0, 1.6, 0.3, 0};
  CHECK(largest_difference(means.position, position) < 1e-15);
  const std::vector<double> stress{1, 2, 3, 4, 5, 6, 7, 3, 0, 2, 0, 0, 7, 7, 7, 7, 7, 7};
  CHECK(largest_difference(means.cauchy_stress, stress) < 1e-14);
}

TEST_CASE("norms of the column, by hand: particles count alike, means by volume") {
  Scene scene = grid_scene(1, 0, 1, 2);
  vsb::test::add_body(scene, everywhere(), 1, BoundaryBoxes::keep);
  scene.compare = ColumnComparison{2, 10, true};
  Snapshot s;
  add_particle(s, {0.25, 0, 0}, 1, {-9, 0, 0, 0, 0, 0});   // exact: -10
  add_particle(s, {0.75, 0, 0}, 3, {-13, 0, 0, 0, 0, 0});  // mean of the cell -12
  add_particle(s, {1.5, 0, 0}, 4, {-9, 0, 0, 0, 0, 0});
  s.bodies = {{0, 3}};
  CHECK(errors_of(scene, s).size() == 3);
  scene.more_norms = {true, true};
  s.recovered_stress = s.cauchy_stress;
  s.recovered_stress[0] = -10;
  const auto errors = errors_of(scene, s);
  REQUIRE(errors.size() == 5);
  CHECK(errors[2].first == "e_sigma");
  CHECK_THAT(errors[2].second, WithinRel(std::sqrt((1. + 9 + 1) / 3) / 10, 1e-14));
  CHECK(errors[3].first == "e_sigma_recovered");
  CHECK_THAT(errors[3].second, WithinRel(std::sqrt((0. + 9 + 1) / 3) / 10, 1e-14));
  CHECK(errors[4].first == "e_sigma_cell_mean");
  CHECK_THAT(errors[4].second, WithinRel(std::sqrt((4. * 4 + 4 * 1) / 8) / 10, 1e-14));
}

TEST_CASE("norms of the cylinder at cell means, by hand: the exact stress at the mean position") {
  Scene scene = grid_scene(2, 0, 1, 3);
  vsb::test::add_body(scene, everywhere(), 1, BoundaryBoxes::keep);
  scene.compare = CylinderComparison{1, 2, 3};  // sigma_rr, sigma_tt = 1 -+ 4 / r^2
  scene.more_norms.cell_means = true;
  Snapshot s;
  add_particle(s, {1.25, 0.25, 0}, 2, {-2, 3, 0, 0, 0, 0});
  add_particle(s, {1.75, 0.25, 0}, 2, {0, 2, 0, 0, 0, 0});
  add_particle(s, {1.5, 0.5, 0}, 4, {-1, 2.5, 0, 0.5, 0, 0});
  s.bodies = {{0, 3}};
  const auto errors = errors_of(scene, s);
  REQUIRE(errors.size() == 5);
  // Mean position (1.5, 0.375), mean stress xx -1, yy 2.5, xy 0.25; cos^2 = 16/17, sin^2 = 1/17, sin cos =
  // 4/17.
  const double r2 = 1.5 * 1.5 + 0.375 * 0.375;
  const double rr = (-16 + 2.5 + 2 * 0.25 * 4) / 17, tt = (-1 + 16 * 2.5 - 2 * 0.25 * 4) / 17;
  CHECK(errors[3].first == "e_rr_cell_mean");
  CHECK_THAT(errors[3].second, WithinRel(std::abs(rr - (1 - 4 / r2)) / 3, 1e-12));
  CHECK(errors[4].first == "e_tt_cell_mean");
  CHECK_THAT(errors[4].second, WithinRel(std::abs(tt - (1 + 4 / r2)) / 3, 1e-12));
}
