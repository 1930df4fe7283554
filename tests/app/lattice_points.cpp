// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Which lattice points are looked at, and how often a body's shape is asked: what follows the grid, or the
/// number of frames, would be seen here as a count.
#include "setup/lattice_points.hpp"

#include "app/shapes.hpp"
#include "engine/simulation.hpp"
#include "scene/units.hpp"
#include "setup/body_surface.hpp"
#include "setup/place_particles.hpp"

using namespace vsb::app;
using vsb::test::add_body;
using vsb::test::containing;
using vsb::test::grid_scene;

namespace {

/// A region that counts how often it is asked.
Region counted(const Region& region, long long& count) {
  return {[region, &count](const Point& x) { return ++count, region(x); },
          [region, &count](const AxisBox& box) { return ++count, region.overlap(box); }, region.bounds()};
}

std::vector<Point> starts_of(const Scene& scene, const PlacedParticles& placed) {
  std::vector<Point> starts;
  for_each_start(scene, placed.starts, [&](const Point& x) { starts.push_back(x); });
  return starts;
}

/// Points of a body of which the estimate of the memory asks, at most.
constexpr long long estimated = 6000;

}  // namespace

TEST_CASE("a small body in a large grid: its bounds are visited, not the grid") {
  auto scene = grid_scene(3, 0, 0.01, 300);  // 2.7e7 cells
  const Region region = ball({1.234, 2.001, 0.777}, 0.05);
  long long asked = 0;
  for (const auto boundary : {BoundaryBoxes::keep, BoundaryBoxes::cut}) {
    scene.bodies.clear();
    add_body(scene, counted(region, asked), 2, boundary);
    const auto placed = place_particles(scene);
    const double volume = 4 * pi / 3 * std::pow(0.05, 3);
    CHECK(std::abs(static_cast<double>(placed.position.size()) / (volume / std::pow(0.005, 3)) - 1) < 0.5);
  }
  asked = 0;
  scene.bodies[0].boundary = BoundaryBoxes::keep;
  place_particles(scene);
  CHECK(asked <= 24 * 24 * 24 + estimated);  // 20 intervals and two more on either side
}

TEST_CASE("on a rectilinear or polar grid, too") {
  auto scene = grid_scene(2, 0, 0, 0);
  for (size_t i = 0; i < 2; ++i) {
    for (int k = 0; k <= 2000; ++k) scene.grid.coordinates[i].push_back(0.01 * k);
    scene.grid.cells[i] = 2000;
  }
  long long asked = 0;
  add_body(scene, counted(box(2, {5, 7, 0}, {5.1, 7.1, 0}), asked), 2, BoundaryBoxes::keep);
  CHECK(place_particles(scene).position.size() == 400);
  CHECK(asked <= 26 * 26 + estimated);

  scene.grid.polar = true;
  scene.faces.fixed = {{{3, 3}, {3, 3}, {}}};
  scene.grid.cells[1] = 36;
  scene.grid.coordinates[0].erase(scene.grid.coordinates[0].begin());  // without r = 0
  scene.grid.cells[0] = 1999;
  scene.grid.coordinates[1].clear();
  for (int k = 0; k <= 36; ++k) scene.grid.coordinates[1].push_back(0.5 * pi * k / 36);
  asked = 0;
  scene.bodies[0].region = counted(difference_of({ball({}, 10.05), ball({}, 9.95)}), asked);
  scene.bodies[0].lattice = CellLattice{{1, 1, 1}};
  CHECK(place_particles(scene).position.size() == 10 * 36);
  // Twice: who looks for particles beyond a face cannot tell a polar grid's from those of its bounding box.
  CHECK(asked <= 2 * 36 * 1010 + estimated);
  scene.bodies[0].region = counted(ball({10, 0, 0}, 0.1), asked = 0);
  CHECK_THROWS_AS(place_particles(scene), SetupError);  // no lattice point in it
  CHECK(asked <= 2 * 37 * 26 + estimated);

  // Many angles: those of the body alone, wherever the grid begins to count them.
  for (const double begin : {-2 * pi, -pi, -0.25, 0.0, 2.0}) {
    scene.grid.cells[1] = 6000;
    scene.grid.coordinates[1].clear();
    for (int k = 0; k <= 6000; ++k) scene.grid.coordinates[1].push_back(begin + 0.999 * 2 * pi * k / 6000);
    for (int k = 0; k < 12; ++k) {
      const double angle = 0.5 + k * pi / 6;  // off the seams
      scene.bodies[0].region = counted(ball({9 * std::cos(angle), 9 * std::sin(angle), 0}, 0.1), asked = 0);
      const double size = 0.01 * 9 * 0.999 * 2 * pi / 6000;
      CHECK_THAT(static_cast<double>(place_particles(scene).position.size()),
                 vsb::test::WithinRel(pi * 0.01 / size, 0.02));
      CHECK(asked <= 2 * 24 * 32 + estimated);
    }
  }
  // Boxes about the centre, and without an end.
  scene.grid.cells[1] = 36;
  scene.grid.coordinates[1].clear();
  for (int k = 0; k <= 36; ++k) scene.grid.coordinates[1].push_back(1.5 * pi * k / 36);
  scene.grid.coordinates[0] = {1, 2, 3};
  scene.grid.cells[0] = 2;
  for (const auto& [region, count] :
       {std::pair(ball({}, 2.6), 72), std::pair(half_space({}, {1, 0, 0}), 48),
        std::pair(half_space({}, {0, 1, 0}), 24), std::pair(half_space({1e-3, 0, 0}, {-1, 0, 0}), 24),
        std::pair(ball({-2.5, 0, 0}, 0.2), 2)}) {
    scene.bodies[0].region = region;
    CHECK(place_particles(scene).position.size() == static_cast<size_t>(count));
  }
}

TEST_CASE("particles start where they were placed, and a cut lattice is cut once") {
  long long asked = 0;
  const Region shell = difference_of({ball({0.1, 0, 0.2}, 2.03), ball({}, 0.8)});
  for (const int d : {1, 2, 3})
    for (const auto boundary : {BoundaryBoxes::keep, BoundaryBoxes::cut, BoundaryBoxes::cut2x2}) {
      auto scene = grid_scene(d, -3, 0.5, 12);
      add_body(scene, counted(ball({}, 0.8), asked), 2, BoundaryBoxes::keep);
      add_body(scene, counted(shell, asked), 2, boundary);
      const auto placed = place_particles(scene);
      asked = 0;
      CHECK(starts_of(scene, placed) == placed.position);
      if (boundary == BoundaryBoxes::keep) CHECK(asked > 0);
      const auto of_second = asked;
      scene.bodies[0].boundary = BoundaryBoxes::cut;
      const auto both = place_particles(scene);
      asked = 0;
      CHECK(starts_of(scene, both) == both.position);
      CHECK((boundary == BoundaryBoxes::keep) == (asked > 0));
      CHECK(asked < of_second);
    }
  auto scene = grid_scene(2, -3, 0.5, 12);
  add_body(scene, ball({}, 2), 3, BoundaryBoxes::keep).jitter = {0.4, 7};
  const auto placed = place_particles(scene);
  CHECK(starts_of(scene, placed) == placed.position);
}

TEST_CASE("a simulation takes the particles that were placed to count them, and cuts no lattice again") {
  auto scene = grid_scene(2, -3, 0.5, 12);
  long long asked = 0;
  add_body(scene, counted(ball({0.1, 0}, 2.03), asked), 2, BoundaryBoxes::cut2x2);
  scene.time.dt = 1e-4;
  make_simulation(scene);
  const auto with_placing = asked;
  asked = 0;
  auto placed = place_particles(scene);
  const auto placing = asked;
  CHECK(placing > 1000);
  const auto count = static_cast<int>(placed.position.size());
  asked = 0;
  CHECK(make_simulation(scene, &placed)->particle_count() == count);
  CHECK(asked == with_placing - placing);
  CHECK(placed.position.empty());
}

TEST_CASE("bodies whose bounds are apart are not asked about each other's particles") {
  auto scene = grid_scene(2, 0, 1, 100);
  std::vector<long long> asked(9, 0);
  for (int k = 0; k < 9; ++k) {
    const double x = 10.0 * k;
    add_body(scene, counted(box(2, {x + 1, 1, 0}, {x + 9, 9, 0}), asked[static_cast<size_t>(k)]), 1,
             BoundaryBoxes::keep);
  }
  place_particles(scene);
  const auto together = asked;
  for (size_t k = 0; k < 9; ++k) {
    auto alone = grid_scene(2, 0, 1, 100);
    alone.bodies.push_back(scene.bodies[k]);
    asked[k] = 0;
    place_particles(alone);
    CHECK(together[k] <= asked[k]);
  }
  scene.bodies[8].region = box(2, {1, 1, 0}, {3, 3, 0});
  CHECK_THROWS_WITH(place_particles(scene), containing("body 'body 9' overlaps body 'body 1'"));
}

TEST_CASE("the surface is looked for where it is, not in all of the grid") {
  // Of a disc, in more and more intervals: pieces and questions grow with the number along one direction.
  double per_interval[2];
  for (const int level : {0, 1}) {
    const int n = level == 0 ? 256 : 4096;
    long long asked = 0;
    const auto pieces = surface_pieces(counted(ball({0.1, 0.2, 0}, 1), asked),
                                       {2, {-2, -2, 0}, {4.0 / n, 4.0 / n, 0}, {n, n, 1}});
    double length = 0;
    for (const auto& piece : pieces) length += std::hypot(piece.area[0], piece.area[1]);
    CHECK(std::abs(length / (2 * pi) - 1) < 1e-3);
    per_interval[level] = static_cast<double>(asked) / n;
  }
  CHECK(per_interval[1] < 1.1 * per_interval[0]);
}

TEST_CASE("a face between two sampling points, or through them, is found") {
  for (const double end : {1.0, 1.03}) {
    const auto pieces =
        surface_pieces(box(2, {0, 0, 0}, {end, end, 0}), {2, {-2, -2, 0}, {0.25, 0.25, 0}, {16, 16, 1}});
    double right = 0;
    Point sum{};
    for (const auto& piece : pieces) {
      for (size_t i = 0; i < 2; ++i) sum[i] += piece.area[i];
      if (std::abs(piece.position[0] - end) < 1e-9) right += piece.area[0];
    }
    CHECK(std::abs(right - end) < 0.3);  // a corner is cut off at the size of an interval
    CHECK(std::hypot(sum[0], sum[1]) < 1e-12);
  }
}
