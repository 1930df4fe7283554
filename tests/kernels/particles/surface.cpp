// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Tractions on surface points, and the original virtual stress boundary method.
#include <vsb/kernels/particles/assemble_forces.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

template <int Dim>
UniformVirtualStress<Dim, double> two_stresses() {
  UniformVirtualStress<Dim, double> field;
  field.count = 2;
  field.stress[0] = pressure_stress<Dim>(3.0);
  for (int c = 0; c < symmetric_components(Dim); ++c) field.stress[1][c] = 1 + c;
  return field;
}

/// Points anywhere in a grid, with any area, under traction 0, 1 or both.
template <int Dim>
SurfacePoints<Dim, double, Device> random_points(const LinearBasis<Dim, double>& basis, int n,
                                                 unsigned seed) {
  const auto points = allocate_surface_points<Dim, double, Device>(n, basis.node_count(), basis.bin_count());
  Random random(seed);
  edit(points.position, [&](const auto& x) {
    for (int b = 0; b < n; ++b) {
      const auto at = random_point(basis.grid, random);
      for (int i = 0; i < Dim; ++i) x(b, i) = at[i];
    }
  });
  edit(points.area, [&](const auto& a) {
    for (int b = 0; b < n; ++b)
      for (int i = 0; i < Dim; ++i) a(b, i) = random(-1, 1);
  });
  edit(points.tractions, [&](const auto& mask) {
    for (int b = 0; b < n; ++b) mask(b) = 1u + static_cast<unsigned>(b % 3);
  });
  return points;
}

template <int Dim>
Matrix<Dim, double> random_gradient(unsigned seed) {
  Random random(seed);
  Matrix<Dim, double> G;
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) G(i, j) = random(-1, 1);
  return G;
}

}  // namespace

TEST_CASE("a surface point loads the nodes of its cell") {
  const LinearBasis<2, double> basis{UniformGrid<2, double>({{0, 0}}, {{2, 1}}, {{2, 2}})};
  auto points = allocate_surface_points<2, double, Device>(1, basis.node_count(), basis.bin_count());
  edit(points.position, [](const auto& x) {
    x(0, 0) = 2.5;  // a quarter into the second cell
    x(0, 1) = 0.5;
  });
  edit(points.area, [](const auto& a) { a(0, 1) = 2; });
  edit(points.tractions, [](const auto& mask) { mask(0) = 1; });
  const auto nodes = allocate_nodes<2, double, Device>(basis.node_count());
  ScatterWorkspace<double, Device> workspace;
  REQUIRE(add_surface_tractions(Exec(), points, nodes, workspace, basis, two_stresses<2>(),
                                Scatter::gathered) == -1);
  const auto sums = read(nodes.sums);
  const double expected[9] = {0, -6 * 0.375, -6 * 0.125, 0, -6 * 0.375, -6 * 0.125, 0, 0, 0};
  for (size_t I = 0; I < 9; ++I) {
    CAPTURE(I);
    CHECK(sums(I, 3) == 0);
    CHECK(sums(I, 4) == expected[I]);
  }
}

TEMPLATE_TEST_CASE_SIG("surface tractions keep force and torque", "", ((int Dim), Dim), 1, 2, 3) {
  const LinearBasis<Dim, double> basis{make_grid<Dim, double>()};
  const int n = 200;
  auto points = random_points(basis, n, 5);
  const auto field = two_stresses<Dim>();
  const auto nodes = allocate_nodes<Dim, double, Device>(basis.node_count());
  for (const Scatter strategy : {Scatter::gathered, Scatter::atomic}) {
    Kokkos::deep_copy(nodes.sums, 7.0);  // forces are added to
    ScatterWorkspace<double, Device> workspace;
    REQUIRE(add_surface_tractions(Exec(), points, nodes, workspace, basis, field, strategy) == -1);
    const auto sums = read(nodes.sums);
    const auto x = read(points.position), a = read(points.area);
    // Moments sum_I f_I (x) X of X = 1, x_0, ..., x_Dim-1, exact for a basis that is linearly complete.
    for (int moment = 0; moment <= Dim; ++moment)
      for (int i = 0; i < Dim; ++i) {
        double ours = 0, expected = 0, scale = 0;
        for (int I = 0; I < basis.node_count(); ++I) {
          const double X = moment == 0 ? 1 : basis.grid.node_position(I)[moment - 1];
          ours += X * (sums(static_cast<size_t>(I), static_cast<size_t>(1 + Dim + i)) - 7);
        }
        for (size_t b = 0; b < n; ++b) {
          double force = 0;
          for (int k = 0; k < 2; ++k)
            for (int j = 0; j < Dim; ++j)
              if ((1u + b % 3) >> k & 1) force += field.stress[k](i, j) * a(b, static_cast<size_t>(j));
          const double X = moment == 0 ? 1 : x(b, static_cast<size_t>(moment - 1));
          expected += X * force;
          scale += std::fabs(X * force);
        }
        CHECK_THAT(ours, WithinAbs(expected, 1e-13 * scale));
      }
  }
  CHECK(read(nodes.sums)(0, 0) == 7);  // mass is left alone
}

TEMPLATE_TEST_CASE_SIG("areas turn and stretch with the material", "", ((int Dim), Dim), 2, 3) {
  const LinearBasis<Dim, double> basis{make_grid<Dim, double>()};
  const auto nodes = allocate_nodes<Dim, double, Device>(basis.node_count());
  const auto G = random_gradient<Dim>(3);
  const typename Nodes<Dim, double, Device>::Fields velocities[] = {nodes.remapped_velocity, nodes.velocity};
  for (const auto& field : velocities)
    edit(field, [&](const auto& v) {
      for (int I = 0; I < basis.node_count(); ++I) {
        const auto velocity = G * basis.grid.node_position(I);
        for (int i = 0; i < Dim; ++i) v(I, i) = velocity[i];
      }
    });
  auto points = random_points(basis, 3, 6);
  edit(points.carrier, [](const auto& carrier) {
    carrier(0) = carried_by_grid;
    carrier(1) = 1;
    carrier(2) = carried_by_none;
  });
  const auto block = random_particles(basis.grid, 2, 8);
  const auto row = [](const auto& field, size_t b) {
    Vector<Dim, double> v;
    for (size_t i = 0; i < Dim; ++i) v[static_cast<int>(i)] = read(field)(b, i);
    return v;
  };
  const auto x = row(points.position, 0), a = row(points.area, 0);
  const auto x_fixed = row(points.position, 2), a_fixed = row(points.area, 2);
  // The material lines t1 (and in 3D t2) of the surface turn to F t1 and F t2, which span the new area.
  const double dt = 0.1;
  const auto F = [&](const Vector<Dim, double>& t) { return t + dt * (G * t); };
  Vector<Dim, double> expected;
  if constexpr (Dim == 2) {
    const auto t = F({{-a[1], a[0]}});  // a turned by a quarter
    expected = {{t[1], -t[0]}};
  } else {
    const Vector<3, double> u{{1, 0, 0}};
    const auto cross = [](const Vector<3, double>& p, const Vector<3, double>& q) {
      return Vector<3, double>{
          {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]}};
    };
    const auto t1 = cross(a, u), t2 = cross(a, t1);  // t1 x t2 = |t1|^2 a
    expected = (1 / dot(t1, t1)) * cross(F(t1), F(t2));
  }
  move_surface_points(Exec(), points, block.particles, nodes, basis, PositionVelocity::strain, dt);
  const auto p = read(block);
  for (int i = 0; i < Dim; ++i) {
    CHECK_THAT(row(points.area, 0)[i], WithinAbs(expected[i], 1e-14));
    CHECK_THAT(row(points.position, 0)[i], WithinAbs(F(x)[i], 1e-14));
    CHECK(row(points.position, 1)[i] == p.position(1, static_cast<size_t>(i)));
    CHECK(row(points.position, 2)[i] == x_fixed[i]);
    CHECK(row(points.area, 2)[i] == a_fixed[i]);
  }
}

TEST_CASE("the original method: whole cells against particles") {
  // Cells 0 and 1 of 4 are full, of particles that have shrunk to 0.99 of their volume. E1 is cell 2, E2 is
  // cell 1, N1 are nodes 1 and 2 (3 is not active). Node 1: particles of cell 1 give 0.99 p, the cell takes
  // p; node 2: particles of cell 1 give -0.99 p, cells 1 and 2 cancel.
  const LinearBasis<1, double> basis{UniformGrid<1, double>({{0}}, {{1}}, {{4}})};
  const auto block = allocate_particles<1, double, Device>(4);
  edit(block, [](const auto& p) {
    for (int k = 0; k < 4; ++k) {
      p.position(k, 0) = 0.25 + 0.5 * k;
      p.mass(k) = 0.5;
      p.volume(k) = 0.495;
    }
  });
  const auto nodes = allocate_nodes<1, double, Device>(5);
  auto occupancy = allocate_occupancy<Device>(4, basis);
  Kokkos::deep_copy(occupancy.tractions, 1u);
  REQUIRE(update_occupancy(Exec(), block.particles, occupancy, basis) == -1);
  UniformVirtualStress<1, double> pressure;
  pressure.count = 1;
  pressure.stress[0] = pressure_stress<1>(8.0);
  SurfacePoints<1, double, Device> none;
  ForceWorkspace<double, Device> workspace;
  for (int gauss_points = 1; gauss_points <= 4; ++gauss_points) {
    const OriginalVirtualStress<UniformVirtualStress<1, double>, UniformGrid<1, double>, Device> original{
        pressure, basis.grid, occupancy.cells, 1u, gauss_points};
    REQUIRE(assemble_forces(Exec(), block.particles, occupancy, none, nodes, workspace, basis, original,
                            Vector<1, double>::zero(), Scatter::gathered) == -1);
    const auto sums = read(nodes.sums);
    const double expected[] = {0, -0.08, -7.92, 0, 0};
    for (size_t I = 0; I < 5; ++I) CHECK_THAT(sums(I, 2), WithinAbs(expected[I], 1e-13));
  }
  // With the bit of the traction not among the original ones, it is the modified method: particles of both
  // cells count at node 1, where they cancel.
  const OriginalVirtualStress<UniformVirtualStress<1, double>, UniformGrid<1, double>, Device> modified{
      pressure, basis.grid, occupancy.cells, 2u, 2};
  assemble_forces(Exec(), block.particles, occupancy, none, nodes, workspace, basis, modified,
                  Vector<1, double>::zero(), Scatter::gathered);
  CHECK_THAT(read(nodes.sums)(1, 2), WithinAbs(0, 1e-13));
  CHECK_THAT(read(nodes.sums)(2, 2), WithinAbs(-7.92, 1e-13));
}

TEST_CASE("Gauss points integrate polynomials of degree 2 n - 1, and no more") {
  for (int n = 1; n <= 4; ++n) {
    const GaussPoints<double> gauss(n);
    for (int degree = 0; degree <= 2 * n; ++degree) {
      double sum = 0;
      for (int k = 0; k < n; ++k) sum += gauss.weight[k] * std::pow(gauss.point[k], degree);
      CAPTURE(n, degree);
      if (degree < 2 * n)
        CHECK_THAT(sum, WithinAbs(1. / (degree + 1), 1e-15));
      else
        CHECK(std::fabs(sum - 1. / (degree + 1)) > 1e-5);
    }
  }
}
