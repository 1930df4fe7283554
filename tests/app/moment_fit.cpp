// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Particle volumes fitted to the moments of the body's share of their cell: against integrals by hand, and
/// against any other volumes with the same moments.
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "app/shapes.hpp"
#include "setup/moment_fit.hpp"
#include "setup/place_particles.hpp"

using namespace vsb::app;
using vsb::test::add_body;
using vsb::test::grid_scene;
using vsb::test::WithinAbs;
using vsb::test::WithinRel;

namespace {

struct CellParticles {
  Point lower{};  ///< of the cell
  std::vector<size_t> particles;
};

/// Particles by cells of unit size whose lines are the integers.
std::map<std::array<int, 3>, CellParticles> by_unit_cells(const PlacedParticles& placed, int dimension) {
  std::map<std::array<int, 3>, CellParticles> cells;
  for (size_t p = 0; p < placed.position.size(); ++p) {
    std::array<int, 3> index{};
    for (size_t i = 0; i < static_cast<size_t>(dimension); ++i)
      index[i] = static_cast<int>(std::floor(placed.position[p][i]));
    auto& cell = cells[index];
    for (size_t i = 0; i < 3; ++i) cell.lower[i] = index[i];
    cell.particles.push_back(p);
  }
  return cells;
}

/// Every product of different coordinates, from the cell's lower corner on.
double product(size_t which, const Point& x, const Point& lower) {
  double value = 1;
  for (size_t i = 0; i < 3; ++i)
    if (which >> i & 1) value *= x[i] - lower[i];
  return value;
}

double moment(size_t which, const CellParticles& cell, const PlacedParticles& placed) {
  double sum = 0;
  for (const size_t p : cell.particles)
    sum += placed.volume[p] * product(which, placed.position[p], cell.lower);
  return sum;
}

PlacedParticles place(Scene scene, bool fit) {
  scene.method.moment_fit = fit;
  return place_particles(scene);
}

/// A body in part of a grid of unit cells, its particles jittered.
Scene jittered(int dimension, const Region& region, int particles_per_cell, double amount = 0.4) {
  auto scene = grid_scene(dimension, -2, 1, 5);
  add_body(scene, region, particles_per_cell, BoundaryBoxes::keep).jitter = {amount, 7};
  return scene;
}

Scene rings() {
  auto scene = grid_scene(2, -4, 1, 8);
  auto& body = add_body(scene, ball({}, 3.3), 1, BoundaryBoxes::keep);
  body.lattice = ConcentricLattice{{}, 0, 3.3, 16, 88, 0, 2 * std::acos(-1.0)};
  return scene;
}

}  // namespace

TEST_CASE("in cells that lie in the body as a whole, moments are those of a unit cell") {
  for (const int d : {1, 2, 3}) {
    const auto scene = jittered(d, box(d, {-1, -1, -1}, {2, 2, 2}), 4);
    const auto plain = place(scene, false), fitted = place(scene, true);
    REQUIRE(fitted.position == plain.position);
    const int cells_in_body = static_cast<int>(std::pow(3, d));
    CHECK(fitted.moment_fit.cells[static_cast<size_t>(d) + 1] == cells_in_body);
    const auto cells = by_unit_cells(fitted, d);
    REQUIRE(static_cast<int>(cells.size()) == cells_in_body);
    double off = 0;
    for (const auto& [index, cell] : cells)
      for (size_t k = 0; k < size_t(1) << d; ++k) {
        const double exact = std::pow(0.5, int(k & 1) + int(k >> 1 & 1) + int(k >> 2));
        CHECK_THAT(moment(k, cell, fitted), WithinRel(exact, 1e-12));
        off = std::max(off, std::abs(moment(k, cell, plain) / exact - 1));
      }
    CHECK(off > 1e-3);  // of the plain volumes
  }
}

TEST_CASE("rings: the cells inside a disc are full to all moments, its volume is that of the disc") {
  const auto fitted = place(rings(), true), plain = place(rings(), false);
  int full = 0;
  for (const auto& [index, cell] : by_unit_cells(fitted, 2)) {
    const double far_x = std::max(std::abs(index[0]), std::abs(index[0] + 1));
    const double far_y = std::max(std::abs(index[1]), std::abs(index[1] + 1));
    if (std::hypot(far_x, far_y) >= 3.3) continue;
    ++full;
    for (const size_t k : {0, 1, 2, 3})
      CHECK_THAT(moment(k, cell, fitted), WithinRel(k == 0 ? 1 : k == 3 ? 0.25 : 0.5, 1e-12));
  }
  CHECK(full == 24);  // in a quadrant (0,0) (0,1) (1,0) (1,1) (2,0) (0,2), counted by hand
  CHECK_THAT(fitted.moment_fit.volume_after, WithinRel(std::acos(-1.0) * 3.3 * 3.3, 2e-4));
  CHECK_THAT(fitted.moment_fit.volume_before, WithinRel(std::acos(-1.0) * 3.3 * 3.3, 1e-12));
  CHECK(*std::min_element(fitted.volume.begin(), fitted.volume.end()) > 0);
}

TEST_CASE("in a cell cut at 0.6 the moments are those of what lies in the body") {
  const auto fitted = place(jittered(2, half_space({0.6, 0, 0}, {1, 0, 0}), 6), true);
  int cut = 0;
  for (const auto& [index, cell] : by_unit_cells(fitted, 2)) {
    if (index[0] != 0) continue;
    ++cut;
    CHECK_THAT(moment(0, cell, fitted), WithinRel(0.6, 1e-11));
    CHECK_THAT(moment(1, cell, fitted), WithinRel(0.18, 1e-11));
    CHECK_THAT(moment(2, cell, fitted), WithinRel(0.3, 1e-11));
    CHECK_THAT(moment(3, cell, fitted), WithinRel(0.09, 1e-11));
  }
  CHECK(cut == 5);
}

TEST_CASE("no other volumes with the same moments are nearer to the lattice's") {
  const auto scene = rings();
  const auto plain = place(scene, false), fitted = place(scene, true);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  int cells = 0;
  for (const auto& [index, cell] : by_unit_cells(fitted, 2)) {
    if (std::abs(moment(0, cell, fitted) - 1) > 1e-9) continue;  // cut cells may have fewer moments
    ++cells;
    // A random change of the volumes that leaves the moments alone, by Gram and Schmidt.
    const size_t n = cell.particles.size();
    std::vector<std::vector<double>> basis;
    std::vector<double> change(n);
    for (size_t k = 0; k < 5; ++k) {
      std::vector<double> v(n);
      for (size_t p = 0; p < n; ++p)
        v[p] = k < 4 ? product(k, fitted.position[cell.particles[p]], cell.lower) : number(random);
      for (int pass = 0; pass < 2; ++pass)
        for (const auto& b : basis) {
          double dot = 0;
          for (size_t p = 0; p < n; ++p) dot += v[p] * b[p];
          for (size_t p = 0; p < n; ++p) v[p] -= dot * b[p];
        }
      double norm = 0;
      for (const double x : v) norm += x * x;
      for (double& x : v) x /= std::sqrt(norm);
      if (k < 4)
        basis.push_back(v);
      else
        change = v;
    }
    double slope = 0, scale = 0;
    for (size_t p = 0; p < n; ++p) {
      const size_t q = cell.particles[p];
      const double term = (fitted.volume[q] - plain.volume[q]) / plain.volume[q] * change[p];
      slope += term;
      scale += std::abs(term);
    }
    CHECK(scale > 1e-6);
    CHECK_THAT(slope, WithinAbs(0, 1e-11 * std::max(scale, 1.0)));
  }
  CHECK(cells == 24);
}

TEST_CASE("too few particles for all moments: the volume is kept in any case, and none is emptied") {
  for (const int n : {1, 2})
    for (const double amount : {0.1, 0.49}) {
      const auto scene = jittered(2, box(2, {-1, -1, 0}, {2, 2, 0}), n, amount);
      const auto plain = place(scene, false), fitted = place(scene, true);
      const auto& cells = fitted.moment_fit.cells;
      CHECK(cells[0] + cells[1] + cells[2] + cells[3] == 9);
      if (n == 1) CHECK(cells[1] == 9);
      for (const auto& [index, cell] : by_unit_cells(fitted, 2))
        CHECK_THAT(moment(0, cell, fitted), WithinRel(1.0, 1e-12));
      for (size_t p = 0; p < plain.volume.size(); ++p) CHECK(fitted.volume[p] > 0.0999 * plain.volume[p]);
    }
}

TEST_CASE("bodies on lattices of equal boxes keep their volumes beside one that is fitted") {
  auto scene = jittered(2, box(2, {-1.9, -1.9, 0}, {-0.2, 2.9, 0}), 3);
  add_body(scene, box(2, {0.3, -1.9, 0}, {2.9, 2.9, 0}), 4, BoundaryBoxes::keep);
  const auto plain = place(scene, false), fitted = place(scene, true);
  const auto [first, last] = plain.bodies[1];
  CHECK(plain.volume != fitted.volume);
  CHECK(std::equal(plain.volume.begin() + first, plain.volume.begin() + last, fitted.volume.begin() + first));
}
