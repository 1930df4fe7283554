// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Forces of virtual stresses: patch tests and tractions on bodies.
#include <vsb/kernels/boundary/update_occupancy.hpp>
#include <vsb/kernels/particles/particles_to_grid.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

const int count = 2000;  // enough to have particles around every node

/// sbar(x) = S0 + x S1 + y S2 + z S3, with its divergence, for any mask but 0.
template <int Dim, class Real>
struct AffineStress : ActsOnParticles {
  SymmetricTensor<Dim, Real> constant;
  SymmetricTensor<Dim, Real> slope[Dim];

  KOKKOS_FUNCTION VirtualStressValue<Dim, Real> at(const Vector<Dim, Real>& x, TractionMask mask) const {
    auto value = VirtualStressValue<Dim, Real>::zero();
    if (mask == 0) return value;
    value.stress = constant;
    for (int j = 0; j < Dim; ++j) {
      value.stress += x[j] * slope[j];
      for (int i = 0; i < Dim; ++i) value.divergence[i] += slope[j](i, j);
    }
    return value;
  }
};

template <int Dim, class Real>
AffineStress<Dim, Real> random_field(unsigned seed) {
  Random random(seed);
  AffineStress<Dim, Real> field;
  for (int c = 0; c < symmetric_components(Dim); ++c) {
    field.constant[c] = random.draw<Real>(-10, 10);
    for (auto& slope : field.slope) slope[c] = random.draw<Real>(-3, 3);
  }
  return field;
}

/// A body on a grid, its nodal sums and its boundary nodes.
template <int Dim, class Real>
struct Loaded {
  LinearBasis<Dim, Real> basis;
  ParticleBlock<Dim, Real, Device> block;
  Nodes<Dim, Real, Device> nodes;
  Occupancy<Device> occupancy;
  ScatterWorkspace<Real, Device> workspace;

  Loaded(const UniformGrid<Dim, Real>& grid, const ParticleBlock<Dim, Real, Device>& body)
      : basis{grid},
        block(body),
        nodes(allocate_nodes<Dim, Real, Device>(grid.node_count())),
        occupancy(allocate_occupancy<Device>(body.particles.count(), basis)) {}

  /// Declares a traction at the nodes for which at(position) gives a mask, and finds N1.
  template <class At>
  void declare(const At& at) {
    edit(occupancy.tractions, [&](const auto& host) {
      for (int I = 0; I < basis.node_count(); ++I) host(I) = at(basis.grid.node_position(I));
    });
    REQUIRE(update_occupancy(Exec(), block.particles, occupancy, basis) == -1);
  }
  template <class Field>
  auto sums(const Field& field) {
    particles_to_grid(Exec(), block.particles, occupancy.bins, nodes, occupancy.boundary, workspace, basis,
                      field, Vector<Dim, Real>::zero(), Scatter::gathered);
    return read(nodes.sums);
  }
};

template <class Real, class Field, int Dim>
void set_stress(const ParticleBlock<Dim, Real, Device>& block, const Field& field) {
  edit(block, [&](const auto& particles) {
    for (int p = 0; p < particles.count(); ++p) {
      const auto bar = field.at(particles.position_of(p), 1);
      for (int c = 0; c < particles.stress_size; ++c) particles.cauchy_stress(p, c) = bar.stress[c];
    }
  });
}

/// The body of the surface tests: a block of cells well inside the grid.
template <int Dim>
bool in_block(const Vector<Dim, int>& cell) {
  for (int i = 0; i < Dim; ++i)
    if (cell[i] < 2 || cell[i] >= 6) return false;
  return true;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("patch test: a stress equal to a uniform virtual stress leaves exactly no force", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (3, float)) {
  const auto grid = make_grid<Dim, Real>();
  Loaded<Dim, Real> body(grid, random_particles(grid, count, 41));
  UniformVirtualStress<Dim, Real> field;
  field.count = 1;
  field.stress[0] = random_field<Dim, Real>(42).constant;
  set_stress(body.block, field);
  REQUIRE(update_occupancy(Exec(), body.block.particles, body.occupancy, body.basis) == -1);
  Kokkos::deep_copy(body.occupancy.boundary, 1u);
  const auto sums = body.sums(field);
  int forces = 0, active = 0;
  for (int I = 0; I < body.nodes.count(); ++I) {
    active += sums(I, 0) > 0;
    for (int i = 0; i < Dim; ++i) forces += sums(I, 1 + Dim + i) != 0;
  }
  CHECK(active == body.nodes.count());
  CHECK(forces == 0);
}

TEMPLATE_TEST_CASE_SIG("patch test: of a virtual stress with divergence its body force remains", "",
                       ((int Dim, typename Real), Dim, Real), (1, double), (2, double), (3, double),
                       (3, float)) {
  const auto grid = make_grid<Dim, Real>();
  const auto field = random_field<Dim, Real>(43);
  Loaded<Dim, Real> body(grid, random_particles(grid, count, 44));
  set_stress(body.block, field);
  edit(body.block, [](const auto& particles) {  // so that the nodal mass is sum_p N V
    for (int p = 0; p < particles.count(); ++p) particles.mass(p) = particles.volume(p);
  });
  REQUIRE(update_occupancy(Exec(), body.block.particles, body.occupancy, body.basis) == -1);
  Kokkos::deep_copy(body.occupancy.boundary, 1u);
  const auto sums = body.sums(field);
  double worst = 0, largest = 0;
  for (int I = 0; I < body.nodes.count(); ++I)
    for (int i = 0; i < Dim; ++i) {
      double divergence = 0;
      for (int j = 0; j < Dim; ++j) divergence += static_cast<double>(field.slope[j](i, j));
      const double expected = static_cast<double>(sums(I, 0)) * divergence;
      largest = std::max(largest, std::abs(expected));
      worst = std::max(worst, std::abs(static_cast<double>(sums(I, 1 + Dim + i)) - expected));
    }
  CHECK(largest > 1);
  // sigma and sbar are evaluated in two places: their round-off, 20 Pa epsilon, acts with V |dN| = 6 of some
  // particles.
  CHECK(worst < count * 20 * 6 * epsilon<Real>);
}

TEMPLATE_TEST_CASE_SIG("unmarked nodes feel no virtual stress", "", ((int Dim), Dim), 1, 2, 3) {
  const auto grid = make_grid<Dim, double>();
  Loaded<Dim, double> body(grid, random_particles(grid, count, 45));
  const auto marked = [](int I) { return I % 3 == 0; };
  REQUIRE(update_occupancy(Exec(), body.block.particles, body.occupancy, body.basis) == -1);
  const auto field = random_field<Dim, double>(46);
  const auto copy = [&](const auto& host) {
    std::vector<double> values;
    for (int I = 0; I < body.nodes.count(); ++I) values.push_back(host(I, 1 + Dim));
    return values;
  };
  const auto without = copy(body.sums(NoVirtualStress{}));
  const auto bare = copy(body.sums(field));
  Kokkos::deep_copy(body.occupancy.boundary, 1u);
  const auto full = copy(body.sums(field));
  edit(body.occupancy.boundary, [&](const auto& host) {
    for (int I = 0; I < body.nodes.count(); ++I) host(I) = marked(I);
  });
  const auto mixed = copy(body.sums(field));
  int different = 0;
  for (int I = 0; I < body.nodes.count(); ++I) {
    const auto n = static_cast<size_t>(I);
    CHECK(mixed[n] == (marked(I) ? full[n] : bare[n]));
    CHECK_THAT(bare[n], WithinAbs(without[n], 1e-10));
    different += full[n] != bare[n];
  }
  CHECK(different == body.nodes.count());
}

TEMPLATE_TEST_CASE_SIG("a pressure on one face of a block gives the surface integral, node by node", "",
                       ((int Dim), Dim), 1, 2, 3) {
  const auto grid = make_grid<Dim, double>({{8, 8, 8}});
  const double p = 3;
  Loaded<Dim, double> body(grid, fill_cells<Dim, double>(grid, 2, 1., in_block<Dim>));
  const double face = grid.lower[0] + 6 * grid.spacing[0];
  body.declare([&](const auto& x) { return x[0] >= face ? 4u : 0u; });
  UniformVirtualStress<Dim, double> field;
  field.count = 3;
  for (auto& s : field.stress) s = pressure_stress<Dim>(1e6);  // tractions 0 and 1 are declared nowhere
  field.stress[2] = pressure_stress<Dim>(p);
  const auto sums = body.sums(field);

  // sum_p V dN_I is the integral of N_I n over the block's surface: h / 2 from each side on which a node
  // lies, in the directions in which it is an edge, h in those in which it is inside.
  Vector<Dim, double> total = Vector<Dim, double>::zero();
  double area = 1;
  for (int i = 1; i < Dim; ++i) area *= 4 * grid.spacing[i];
  int loaded = 0;
  for (int I = 0; I < body.nodes.count(); ++I) {
    const auto ijk = grid.node_ijk(I);
    bool on_face = ijk[0] == 6;
    for (int i = 1; i < Dim; ++i) on_face = on_face && ijk[i] >= 2 && ijk[i] <= 6;
    loaded += on_face;
    for (int i = 0; i < Dim; ++i) {
      double expected = on_face ? (ijk[i] == 6 ? -p : ijk[i] == 2 ? p : 0) : 0;
      for (int j = 0; j < Dim; ++j)
        if (j != i) expected *= grid.spacing[j] * (ijk[j] == 2 || ijk[j] == 6 ? 0.5 : 1);
      CAPTURE(I, i);
      CHECK_THAT(sums(I, 1 + Dim + i), WithinAbs(expected, 1e-14));
      total[i] += sums(I, 1 + Dim + i);
    }
  }
  CHECK(body.occupancy.boundary_node_count == loaded);
  CHECK_THAT(total[0], WithinAbs(-p * area, 1e-13));
  for (int i = 1; i < Dim; ++i) CHECK_THAT(total[i], WithinAbs(0, 1e-13));
}

TEMPLATE_TEST_CASE_SIG("a pressure all around a block pushes each face inwards and has no resultant", "",
                       ((int Dim), Dim), 1, 2, 3) {
  const auto grid = make_grid<Dim, double>({{8, 8, 8}});
  Loaded<Dim, double> body(grid, fill_cells<Dim, double>(grid, 3, 1., in_block<Dim>));
  body.declare([](const auto&) { return 1u; });
  UniformVirtualStress<Dim, double> field;
  field.count = 1;
  field.stress[0] = pressure_stress<Dim>(2.);
  const auto sums = body.sums(field);
  for (int i = 0; i < Dim; ++i) {
    double low = 0, high = 0, area = 1;
    for (int I = 0; I < body.nodes.count(); ++I) {
      const int at = grid.node_ijk(I)[i];
      (at < 4 ? low : high) += sums(I, 1 + Dim + i);
    }
    for (int j = 0; j < Dim; ++j)
      if (j != i) area *= 4 * grid.spacing[j];
    CHECK_THAT(low, WithinAbs(2 * area, 1e-13));
    CHECK_THAT(high, WithinAbs(-2 * area, 1e-13));
  }
}

TEST_CASE("a shear traction acts along the face that carries it") {
  // sbar_xy = t on a face of normal +x: traction t along y.
  const auto grid = make_grid<2, double>({{8, 8, 8}});
  Loaded<2, double> body(grid, fill_cells<2, double>(grid, 2, 1., in_block<2>));
  const double face = grid.lower[0] + 6 * grid.spacing[0], t = 5;
  body.declare([&](const auto& x) { return x[0] >= face ? 1u : 0u; });
  UniformVirtualStress<2, double> field;
  field.count = 1;
  field.stress[0] = {{0, 0, 0, t}};
  const auto sums = body.sums(field);
  double along = 0;
  for (int I = 0; I < body.nodes.count(); ++I) along += sums(I, 4);
  CHECK_THAT(along, WithinAbs(t * 4 * grid.spacing[1], 1e-13));
}
