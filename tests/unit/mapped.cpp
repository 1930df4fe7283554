// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The inverse map of a mapped grid, and the multilinear basis on it.
#include <set>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

const double pi = 3.14159265358979323846;

/// x = sum_a N_a(xi) X_a, by interpolation in one direction after the other.
template <int Dim, class Real>
Vector<Dim, Real> forward(const MappedGrid<Dim, Real>& grid, const Vector<Dim, int>& cell,
                          const Vector<Dim, Real>& xi) {
  std::vector<Vector<Dim, Real>> points;
  for (int a = 0; a < 1 << Dim; ++a) {
    auto ijk = cell;
    for (int i = 0; i < Dim; ++i) ijk[i] += a >> i & 1;
    points.push_back(grid.node_position(grid.node_index(ijk)));
  }
  for (int i = 0; i < Dim; ++i) {
    std::vector<Vector<Dim, Real>> next;
    for (size_t k = 0; k < points.size(); k += 2)
      next.push_back(points[k] + xi[i] * (points[k + 1] - points[k]));
    points = next;
  }
  return points[0];
}

template <int Dim, class Real>
Vector<Dim, Real> random_local(Random& random, double low = 0.001, double high = 0.999) {
  Vector<Dim, Real> xi;
  for (int i = 0; i < Dim; ++i) xi[i] = random.draw<Real>(low, high);
  return xi;
}

template <int Dim>
Vector<Dim, int> random_cell(const CellNumbering<Dim>& grid, Random& random) {
  Vector<Dim, int> cell;
  for (int i = 0; i < Dim; ++i) cell[i] = random.index(grid.cells[i]);
  return cell;
}

/// Three quarters of a ring about the origin, radii 1 to 3: what lies in its hole and between its ends is
/// within the bounding box but outside.
MappedMesh<2, double, Host> ring(int radial, int around) {
  return make_mapped_mesh<double, Host>(Vector<2, int>{{radial, around}}, [&](const Vector<2, int>& ij) {
    const double r = 1 + 2. * ij[0] / radial, angle = 1.5 * pi * ij[1] / around;
    return Vector<2, double>{{r * std::cos(angle), r * std::sin(angle)}};
  });
}

/// A grid that counts the walks that it is asked for, and the cells that are looked at without one.
struct CountingGrid : MappedGrid<2, double> {
  long long& asked;
  Location walk(const Vector<2, double>& x, int start) const {
    ++asked;
    return MappedGrid<2, double>::walk(x, start);
  }
  bool inside(const Vector<2, double>& x, Location& location) const {
    ++asked;
    return MappedGrid<2, double>::inside(x, location);
  }
};

}  // namespace

TEMPLATE_TEST_CASE_SIG("the inverse map undoes the forward map in distorted cells", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (1, float), (2, float), (3, float)) {
  Random random(11);
  for (unsigned seed = 0; seed < 20; ++seed) {
    const auto mesh = make_distorted_mesh<Dim, Real, Host>(0.9 / (2 * Dim), {{5, 4, 3}}, seed);
    for (int trial = 0; trial < 100; ++trial) {
      const auto cell = random_cell(mesh.grid, random);
      const auto xi = random_local<Dim, Real>(random);
      const auto location = mesh.grid.locate(forward(mesh.grid, cell, xi));
      REQUIRE(location.found);
      for (int i = 0; i < Dim; ++i) {
        CHECK(location.cell[i] == cell[i]);
        // Positions up to 4 m are rounded; edges are as short as a tenth of 0.25 m.
        CHECK_THAT(location.xi[i], WithinAbs(static_cast<double>(xi[i]), 1000 * epsilon<Real>));
      }
    }
  }
}

TEST_CASE("cells that are nearly triangles, sheared and slender are inverted too") {
  // One corner is pulled towards the diagonal of the other three; the last cells are very long.
  Random random(12);
  for (const double pull : {0.3, 0.6, 0.9, 0.98})
    for (const double stretch : {1., 1e3}) {
      const auto mesh = make_mapped_mesh<double, Host>(Vector<2, int>{{1, 1}}, [&](const Vector<2, int>& ij) {
        double x = ij[0], y = ij[1];
        if (ij[0] == 1 && ij[1] == 1) x = y = 1 - 0.5 * pull;
        return Vector<2, double>{{stretch * (x + 0.7 * y), y}};
      });
      for (int trial = 0; trial < 1000; ++trial) {
        const auto xi = random_local<2, double>(random, 0, 1);
        const auto location = mesh.grid.walk(forward(mesh.grid, {{0, 0}}, xi));
        CAPTURE(pull, stretch, xi[0], xi[1]);
        REQUIRE(location.found);
        // At the pulled corner det J is a factor 1 - pull smaller than elsewhere.
        for (int i = 0; i < 2; ++i) CHECK_THAT(location.xi[i], WithinAbs(xi[i], 1e-12));
      }
    }
}

TEST_CASE("a curved grid: points of the ring are found by a walk, those of its hole are not in the grid") {
  Random random(13);
  for (const int around : {4, 9, 60}) {
    const auto mesh = ring(3, around);
    int inside = 0;
    for (int trial = 0; trial < 5000; ++trial) {
      const Vector<2, double> x{{random(-3.2, 3.2), random(-3.2, 3.2)}};
      // In the sector of its angle, a straight edge at radius r is r cos(half a sector) / cos(angle from the
      // middle) away from the centre.
      double angle = std::atan2(x[1], x[0]);
      if (angle < 0) angle += 2 * pi;
      const double sector = 1.5 * pi / around, number = std::floor(angle / sector);
      const double along =
          std::sqrt(dot(x, x)) * std::cos(angle - (number + 0.5) * sector) / std::cos(0.5 * sector);
      const bool expected = number < around && along >= 1 && along <= 3;
      CAPTURE(around, x[0], x[1]);
      CHECK(mesh.grid.contains(x) == expected);
      if (!expected) continue;
      ++inside;
      const auto location = mesh.grid.walk(x);
      REQUIRE(location.found);
      CHECK(location.cell[1] == static_cast<int>(number));
      CHECK(location.cell[0] == static_cast<int>((along - 1) * 1.5));
    }
    CHECK(inside > 1000);
  }
}

TEMPLATE_TEST_CASE_SIG("points outside and points that are none are not contained", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (3, float)) {
  const auto mesh = make_distorted_mesh<Dim, Real, Host>(0.1);
  const MappedLinearBasis<Dim, Real> basis{mesh.grid};
  const auto grid = make_grid<Dim, Real>();
  Vector<Dim, Real> inside;
  for (int i = 0; i < Dim; ++i) inside[i] = grid.lower[i] + Real(0.6) * grid.spacing[i];
  REQUIRE(basis.contains(inside));
  const Real nan = std::numeric_limits<Real>::quiet_NaN(), infinity = std::numeric_limits<Real>::infinity();
  for (int i = 0; i < Dim; ++i) {
    const Real low = grid.lower[i], high = low + static_cast<Real>(grid.cells[i]) * grid.spacing[i];
    for (const Real value : {low - Real(0.11) * grid.spacing[i], high + Real(0.11) * grid.spacing[i], low - 1,
                             high + 1, Real(-1e30), Real(1e30), nan, infinity, -infinity}) {
      auto x = inside;
      x[i] = value;
      CAPTURE(i, value);
      CHECK_FALSE(basis.contains(x));
    }
  }
  // Through a face of the boundary, a little outside and a little inside.
  Random random(14);
  for (int trial = 0; trial < 200; ++trial) {
    auto cell = random_cell(mesh.grid, random);
    const int axis = random.index(Dim), side = random.index(2);
    cell[axis] = side ? mesh.grid.cells[axis] - 1 : 0;
    auto xi = random_local<Dim, Real>(random, 0.1, 0.9);
    xi[axis] = static_cast<Real>(side);
    CHECK(basis.contains(forward(mesh.grid, cell, xi)));
    xi[axis] = side ? Real(1.001) : Real(-0.001);
    CHECK_FALSE(basis.contains(forward(mesh.grid, cell, xi)));
    xi[axis] = side ? Real(0.999) : Real(0.001);
    CHECK(basis.contains(forward(mesh.grid, cell, xi)));
  }
}

TEMPLATE_TEST_CASE_SIG("points on nodes, edges and faces are contained, with basis functions of their nodes",
                       "", ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (2, float), (3, float)) {
  const auto mesh = make_distorted_mesh<Dim, Real, Host>(0.14, {{5, 4, 3}}, 21);
  const MappedLinearBasis<Dim, Real> basis{mesh.grid};
  Random random(15);
  for (int trial = 0; trial < 500; ++trial) {
    const auto cell = random_cell(mesh.grid, random);
    auto xi = random_local<Dim, Real>(random);
    for (int i = 0; i < Dim; ++i)
      if (random.index(2)) xi[i] = static_cast<Real>(random.index(2));
    const auto x = forward(mesh.grid, cell, xi);
    REQUIRE(basis.contains(x));
    const auto shape = basis.shape(x);
    CHECK(shape.node[0] == basis.bin(x));
    CHECK(mesh.grid.node_index(mesh.grid.cell_containing(x)) == basis.bin(x));
    std::vector<double> expected(static_cast<size_t>(basis.node_count())), got = expected;
    for (int a = 0; a < basis.support; ++a) {
      auto ijk = cell;
      double N = 1;
      for (int i = 0; i < Dim; ++i) {
        N *= static_cast<double>(a >> i & 1 ? xi[i] : 1 - xi[i]);
        ijk[i] += a >> i & 1;
      }
      expected[static_cast<size_t>(mesh.grid.node_index(ijk))] += N;
      got[static_cast<size_t>(shape.node[a])] += static_cast<double>(shape.N[a]);
    }
    for (size_t I = 0; I < got.size(); ++I) CHECK_THAT(got[I], WithinAbs(expected[I], 1000 * epsilon<Real>));
  }
}

TEMPLATE_TEST_CASE_SIG("the mapped basis reproduces linear fields and their gradients", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (2, float), (3, float)) {
  const auto mesh = make_distorted_mesh<Dim, Real, Host>(0.14);
  const MappedLinearBasis<Dim, Real> basis{mesh.grid};
  Random random(16);
  for (int trial = 0; trial < 500; ++trial) {
    const auto x = forward(mesh.grid, random_cell(mesh.grid, random), random_local<Dim, Real>(random));
    REQUIRE(basis.contains(x));
    const auto shape = basis.shape(x);
    double one = 0, zero[Dim] = {}, position[Dim] = {}, identity[Dim][Dim] = {};
    std::set<int> nodes;
    for (int a = 0; a < basis.support; ++a) {
      const auto xa = mesh.grid.node_position(shape.node[a]);
      CHECK(shape.N[a] >= 0);
      nodes.insert(shape.node[a]);
      one += static_cast<double>(shape.N[a]);
      for (int i = 0; i < Dim; ++i) {
        zero[i] += static_cast<double>(shape.dN[a][i]);
        position[i] += static_cast<double>(shape.N[a] * xa[i]);
        for (int j = 0; j < Dim; ++j)
          identity[j][i] += static_cast<double>(shape.dN[a][i]) * static_cast<double>(xa[j]);
      }
    }
    CHECK(static_cast<int>(nodes.size()) == basis.support);
    CHECK_THAT(one, WithinAbs(1, 8 * epsilon<Real>));
    for (int i = 0; i < Dim; ++i) {
      // Gradients are up to 10 per metre and positions up to 4 m.
      CHECK_THAT(zero[i], WithinAbs(0, 100 * epsilon<Real>));
      CHECK_THAT(position[i], WithinAbs(static_cast<double>(x[i]), 32 * epsilon<Real>));
      for (int j = 0; j < Dim; ++j) CHECK_THAT(identity[i][j], WithinAbs(i == j, 400 * epsilon<Real>));
    }
  }
}

TEMPLATE_TEST_CASE_SIG("gradients are the derivatives of the basis functions", "", ((int Dim), Dim), 1, 2,
                       3) {
  const auto mesh = make_distorted_mesh<Dim, double, Host>(0.14);
  const MappedLinearBasis<Dim, double> basis{mesh.grid};
  Random random(17);
  const double step = 1e-6;
  for (int trial = 0; trial < 100; ++trial) {
    const auto x =
        forward(mesh.grid, random_cell(mesh.grid, random), random_local<Dim, double>(random, 0.01, 0.99));
    const auto shape = basis.shape(x);
    for (int j = 0; j < Dim; ++j) {
      auto ahead = x, behind = x;
      ahead[j] += step;
      behind[j] -= step;
      const auto after = basis.shape(ahead), before = basis.shape(behind);
      for (int a = 0; a < basis.support; ++a) {
        REQUIRE(after.node[a] == before.node[a]);
        CHECK_THAT(shape.dN[a][j], WithinAbs((after.N[a] - before.N[a]) / (2 * step), 1e-7));
      }
    }
  }
}

TEMPLATE_TEST_CASE_SIG("on a uniform mesh the mapped basis is the linear basis, to round-off", "",
                       ((int Dim), Dim), 1, 2, 3) {
  const auto grid = make_grid<Dim, double>();
  const auto mesh = make_distorted_mesh<Dim, double, Host>(0);
  const LinearBasis<Dim, double> uniform{grid};
  const MappedLinearBasis<Dim, double> basis{mesh.grid};
  REQUIRE(basis.node_count() == uniform.node_count());
  REQUIRE(basis.bin_count() == uniform.bin_count());
  Random random(18);
  for (int trial = 0; trial < 300; ++trial) {
    const auto x = random_point(grid, random);
    REQUIRE(basis.contains(x));
    CHECK(basis.bin(x) == uniform.bin(x));
    const auto expected = uniform.shape(x), shape = basis.shape(x);
    for (int a = 0; a < basis.support; ++a) {
      CHECK(shape.node[a] == expected.node[a]);
      CHECK_THAT(shape.N[a], WithinAbs(expected.N[a], 32 * epsilon<double>));
      for (int j = 0; j < Dim; ++j)
        CHECK_THAT(shape.dN[a][j], WithinAbs(expected.dN[a][j], 200 * epsilon<double>));
    }
  }
  for_each_cell(mesh.grid, [&](const Vector<Dim, int>& cell) {
    CHECK_THAT(mesh.grid.cell_volume(cell), WithinRel(grid.cell_volume(cell), 1e-14));
  });
}

TEST_CASE("volumes of cells") {
  // A quadrilateral by its diagonals: |d1 x d2| / 2.
  const auto mesh = make_distorted_mesh<2, double, Host>(0.2);
  for_each_cell(mesh.grid, [&](const Vector<2, int>& cell) {
    const auto at = [&](int i, int j) {
      return mesh.grid.node_position(mesh.grid.node_index({{cell[0] + i, cell[1] + j}}));
    };
    const auto d1 = at(1, 1) - at(0, 0), d2 = at(0, 1) - at(1, 0);
    CHECK_THAT(mesh.grid.cell_volume(cell), WithinRel(0.5 * (d1[0] * d2[1] - d1[1] * d2[0]), 1e-13));
  });
  // In space the cells share warped faces: together they fill what the outer faces, left plane, enclose.
  const auto box = make_grid<3, double>();
  Random random(19);
  const auto filled = make_mapped_mesh<double, Host>(box.cells, [&](const Vector<3, int>& ijk) {
    auto x = box.node_position(box.node_index(ijk));
    for (int i = 0; i < 3; ++i) {
      const double shift = random(-0.15, 0.15);
      if (ijk[i] > 0 && ijk[i] < box.cells[i]) x[i] += shift * box.spacing[i];
    }
    return x;
  });
  double sum = 0, least = 1;
  for_each_cell(filled.grid, [&](const Vector<3, int>& cell) {
    sum += filled.grid.cell_volume(cell);
    least = std::min(least, filled.grid.cell_volume(cell));
  });
  CHECK_THAT(sum, WithinRel(box.cell_volume() * box.cell_count(), 1e-13));
  CHECK(least < 0.95 * box.cell_volume());
  // A frustum of a pyramid, h (A + B + sqrt(A B)) / 3.
  const auto frustum =
      make_mapped_mesh<double, Host>(Vector<3, int>{{1, 1, 1}}, [](const Vector<3, int>& ijk) {
        const double half = ijk[2] ? 0.5 : 1;
        return Vector<3, double>{{ijk[0] ? half : -half, ijk[1] ? half : -half, 3. * ijk[2]}};
      });
  CHECK_THAT(frustum.grid.cell_volume({{0, 0, 0}}), WithinRel(4. + 1 + 2, 1e-14));
}

TEST_CASE("degenerate, inverted and mirrored cells are refused by name") {
  const auto refused = [](const Vector<2, int>& node, const Vector<2, double>& to) {
    make_mapped_mesh<double, Host>(Vector<2, int>{{3, 2}}, [&](const Vector<2, int>& ij) {
      if (ij[0] == node[0] && ij[1] == node[1]) return to;
      return Vector<2, double>{{1. * ij[0], 1. * ij[1]}};
    });
  };
  CHECK_NOTHROW(refused({{2, 1}}, {{2.4, 1.4}}));
  CHECK_THROWS_WITH(refused({{2, 1}}, {{0.9, 1.}}), containing("cell (1, 0)"));   // crossed over
  CHECK_THROWS_WITH(refused({{3, 2}}, {{2.5, 1.5}}), containing("cell (2, 1)"));  // on the diagonal
  CHECK_THROWS_WITH(refused({{3, 2}}, {{2., 2.}}), containing("cell (2, 1)"));    // an edge of no length
  CHECK_THROWS_WITH(refused({{0, 0}}, {{std::nan(""), 0.}}), containing("cell (0, 0)"));
  CHECK_THROWS_WITH(refused({{0, 0}}, {{-std::numeric_limits<double>::infinity(), 0.}}),
                    containing("cell (0, 0)"));
  const auto line = [](double second) {
    make_mapped_mesh<double, Host>(Vector<1, int>{{2}}, [&](const Vector<1, int>& i) {
      return Vector<1, double>{{i[0] == 1 ? second : 1. * i[0]}};
    });
  };
  CHECK_NOTHROW(line(1.5));
  CHECK_THROWS_WITH(line(2), containing("cell (1)"));
  CHECK_THROWS_WITH(line(-1), containing("cell (0)"));
  CHECK_THROWS_AS((make_mapped_mesh<double, Host>(
                      Vector<3, int>{{2, 2, 2}},
                      [](const Vector<3, int>& ijk) {
                        return Vector<3, double>{{1. * ijk[1], 1. * ijk[0], 1. * ijk[2]}};  // left-handed
                      })),
                  std::invalid_argument);
  CHECK_THROWS_AS((make_mapped_mesh<double, Host>(
                      Vector<1, int>{{0}}, [](const Vector<1, int>&) { return Vector<1, double>{{0.}}; })),
                  std::invalid_argument);
}

TEST_CASE("a strongly graded grid: every cell's centre is found in it") {
  // Cell sizes from 1 to 1e-4, so that one raster cell holds many cells.
  const auto mesh = make_mapped_mesh<double, Host>(Vector<2, int>{{40, 40}}, [](const Vector<2, int>& ij) {
    return Vector<2, double>{{1 - std::pow(0.8, ij[0]), 1 - std::pow(0.8, ij[1]) + 0.3 * ij[0]}};
  });
  for_each_cell(mesh.grid, [&](const Vector<2, int>& cell) {
    const auto location = mesh.grid.locate(forward(mesh.grid, cell, {{0.5, 0.5}}));
    REQUIRE(location.found);
    CHECK((location.cell[0] == cell[0] && location.cell[1] == cell[1]));
  });
}

TEST_CASE("thousands of graded nodes along an axis: few cells are looked at for a point") {
  // Cell sizes over seven decades. Walks end after some dozens of cells, or are not found.
  for (const double shear : {0.0, 0.3}) {
    const auto mesh =
        make_mapped_mesh<double, Host>(Vector<2, int>{{1600, 4}}, [&](const Vector<2, int>& ij) {
          const double x = std::pow(1.01, ij[0] - 1600);
          return Vector<2, double>{{x, 1. * ij[1] + shear * x}};
        });
    CHECK(mesh.grid.rectilinear == (shear == 0));
    for_each_cell(mesh.grid, [&](const Vector<2, int>& cell) {
      const auto x = forward(mesh.grid, cell, {{0.25, 0.75}});
      const auto location = mesh.grid.rectilinear ? mesh.grid.locate(x) : mesh.grid.walk(x);
      REQUIRE(location.found);
      CHECK((location.cell[0] == cell[0] && location.cell[1] == cell[1]));
      CHECK_THAT(location.xi[0], WithinAbs(0.25, 1e-7));
    });
  }
}

TEST_CASE("a rectilinear grid: points on faces, at its ends and outside") {
  const double x[] = {-1, 0.25, 0.5, 3, 7};
  const auto mesh = make_mapped_mesh<double, Host>(Vector<2, int>{{4, 2}}, [&](const Vector<2, int>& ij) {
    return Vector<2, double>{{x[ij[0]], 2. * ij[1] * ij[1]}};
  });
  const auto& grid = mesh.grid;
  CHECK(grid.raster.cell_count() == 1);
  for (int i = 0; i <= 4; ++i) {
    const auto location = grid.locate({{x[i], 1}});
    REQUIRE(location.found);
    CHECK(location.cell[0] == std::min(i, 3));
    CHECK(location.xi[0] == (i == 4 ? 1 : 0));
  }
  CHECK(grid.contains({{-1 - 1e-15, 8}}));
  CHECK_FALSE(grid.contains({{-1.01, 8}}));
  CHECK_FALSE(grid.contains({{0, 8.01}}));
  CHECK_FALSE(grid.contains({{std::nan(""), 1}}));
  CHECK_FALSE(make_distorted_mesh<2, double, Host>(0.2).grid.rectilinear);
}

TEST_CASE("slender sectors: the start cells are found by a few walks for each of the raster's cells") {
  for (const auto& [radial, around] : {std::pair(2000, 4), std::pair(4, 2000), std::pair(90, 90)}) {
    const auto mesh = ring(radial, around);
    long long asked = 0;
    const auto& raster = mesh.grid.raster;
    const auto start = mapped::start_cells(CountingGrid{mesh.grid, asked});
    CHECK(asked <= 5 * raster.cell_count());
    int found = 0;
    for (int r = 0; r < raster.cell_count(); ++r) {
      CHECK(start[static_cast<size_t>(r)] == mesh.grid.start_cell[r]);
      const auto ij = raster.cell_ijk(r);
      const Vector<2, double> centre{{raster.lower[0] + (ij[0] + 0.5) * raster.spacing[0],
                                      raster.lower[1] + (ij[1] + 0.5) * raster.spacing[1]}};
      const double r2 = dot(centre, centre);
      if (r2 > 8.99 || r2 < 1.01 || (centre[0] > -0.01 && centre[1] < 0.01)) continue;
      const auto location = mesh.grid.walk(centre);
      if (around > 4) REQUIRE(location.found);
      if (!location.found) continue;  // beyond a chord of the outer circle
      CHECK(mesh.grid.cell_index(location.cell) == start[static_cast<size_t>(r)]);
      ++found;
    }
    CHECK(found > raster.cell_count() / 3);
  }
}
