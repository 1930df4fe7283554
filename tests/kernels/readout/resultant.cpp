// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The net force and torque of a uniform pressure on 200 random closed bodies, at the boundary nodes and at
/// all of them. Some bodies have none at the boundary nodes either: there the cells on either side of the
/// inner nodes happen to hold equally many columns of particles. `vsb study resultant` is the same by the
/// program, drawn.
///
/// And of water against a face that ends at a support, and at a wall that mirrors.
#include <algorithm>
#include <cstdio>
#include <vsb/kernels/lanes/resultant.hpp>
#include <vsb/physics/traction_fields.hpp>

#include "random_body.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

/// Shares of pressure times area, and of that times the half width of the body's box.
struct Share {
  double force, torque;
};

template <int Dim>
Share share(RandomBody<Dim>& body, bool at_all_active_nodes) {
  UniformVirtualStress<Dim, double> pressure;
  pressure.count = 1;
  pressure.stress[0] = pressure_stress<Dim>(1e5);
  const auto b = body.resultant(pressure, at_all_active_nodes);
  const double scale = 1e5 * body.area;
  // About the middle of the body, not about the origin.
  auto torque = b.net_torque;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const auto at = [](const Vector<Dim, double>& v, int c) { return c < Dim ? v[c] : 0.0; };
    torque[i] -= at(body.center, j) * at(b.net_force, k) - at(body.center, k) * at(b.net_force, j);
  }
  return {length(b.net_force) / scale, length(torque) / (scale * body.half_width)};
}

template <int Dim>
void measure() {
  std::vector<double> boundary, all;
  for (unsigned seed = 1000; seed < 1100; ++seed) {
    RandomBody<Dim> body(seed);
    const auto mod = share(body, false), at_all_active_nodes = share(body, true);
    boundary.push_back(mod.force);
    all.push_back(std::max(at_all_active_nodes.force, at_all_active_nodes.torque));
  }
  std::sort(boundary.begin(), boundary.end());
  std::printf(
      "%dD: |net force| / (pressure area) at the boundary nodes: median %.1e, largest %.1e; at all nodes: "
      "largest %.1e\n",
      Dim, boundary[50], boundary.back(), *std::max_element(all.begin(), all.end()));
  CHECK(*std::max_element(all.begin(), all.end()) < 1e-12);
  CHECK(boundary[50] > 1e-3);  // the bodies tell the two apart
}

/// Water 8 m deep against a face 1 : 2 of a body that stands on the lower face of the grid. Its particles are
/// squares of a quarter metre, and the surface that they have is a staircase whose steps the face halves.
struct Dam {
  const UniformGrid<2, double> grid{{{0, 0}}, {{0.5, 0.5}}, {{40, 24}}};
  TractionFields<2, double> field;
  ParticleBlock<2, double, Device> block;

  Dam() {
    field.count = 1;
    field.field[0] = HydrostaticStress<2, double>{9810, 8, 0, {{0, 1}}};
    field.factor[0] = 1;
    std::vector<Vector<2, double>> positions;
    for (double y = 0.125; y < 10; y += 0.25)
      for (double x = 0.125; x < 14; x += 0.25)
        if (x > 2 + 0.5 * y) positions.push_back({{x, y}});
    block = allocate_particles<2, double, Device>(static_cast<int>(positions.size()));
    edit(block, [&](const auto& p) {
      for (int k = 0; k < p.count(); ++k) {
        for (int i = 0; i < 2; ++i) p.position(k, i) = positions[static_cast<size_t>(k)][i];
        p.volume(k) = p.mass(k) = 0.0625;
      }
    });
  }
  /// Nodes of the wet half of a grid.
  template <class Grid>
  BoundaryNodes<Device> declared(const Grid& on) const {
    const BoundaryNodes<Device> nodes("vsb::declared", static_cast<size_t>(on.node_count()));
    edit(nodes, [&](const auto& host) {
      for (int I = 0; I < on.node_count(); ++I) host(I) = on.node_position(I)[0] <= 8 ? 1 : 0;
    });
    return nodes;
  }
  /// By the particle kernels; `fixed` at the lower face.
  template <class Basis>
  TractionResultant<2> of_particles(const Basis& basis, ComponentMask fixed,
                                    const FaceCover<Device>& cover = {}) const {
    auto state = make_state(block.particles, basis);
    state.occupancy.tractions = declared(basis.grid);
    edit(state.nodes.fixed_components, [&](const auto& host) {
      for (int I = 0; I < basis.node_count(); ++I)
        if (basis.grid.node_position(I)[1] == 0) host(I) = fixed;
    });
    REQUIRE(update_occupancy(Exec(), block.particles, state.occupancy, basis) == -1);
    return resultant(Exec(), state, basis, field, ~TractionMask(0), cover);
  }
  template <class Lanes>
  TractionResultant<2> of_lanes(Lanes lanes, ComponentMask fixed, const FaceCover<Device>& cover = {}) const {
    lanes.memory.walls.fixed[1][0] = fixed;
    REQUIRE(pack_lanes(Exec(), block.particles, lanes) == -1);
    return resultant(Exec(), lanes, field, ~TractionMask(0), cover);
  }
};

void check_same(const TractionResultant<2>& a, const TractionResultant<2>& b) {
  for (int i = 0; i < 2; ++i) CHECK_THAT(a.force[i], WithinRel(b.force[i], 1e-11));
  CHECK_THAT(a.torque[2], WithinRel(b.torque[2], 1e-11));
}

}  // namespace

TEST_CASE(
    "a uniform pressure on closed bodies has no resultant at all nodes, and one at the boundary nodes") {
  measure<2>();
  measure<3>();
}

TEST_CASE("a face that ends at a support has its whole resultant, whatever is fixed there") {
  const Dam dam;
  const double x = 9810 * 64 / 2., y = -9810 * 64 / 4., torque = -9810 * 416 / 3.;
  const LinearBasis<2, double> basis{dam.grid};
  LaneState<2, double, Device> lanes;
  lanes.memory.grid = dam.grid;
  lanes.boundary.declared = dam.declared(dam.grid);
  for (const auto fixed : {ComponentMask{2}, ComponentMask{3}}) {  // a roller, a clamp
    const auto linear = dam.of_particles(basis, fixed);
    CHECK_THAT(linear.force[0], WithinRel(x, 1e-12));
    CHECK_THAT(linear.force[1], WithinRel(y, 1e-12));
    CHECK_THAT(linear.torque[2], WithinRel(torque, 2e-3));
    check_same(dam.of_lanes(lanes, fixed), linear);

    QuadraticBSplineBasis<2, double> splines;
    splines.grid = with_ghost_layer(dam.grid);
    splines.walls.fixed[1][0] = fixed;
    SplineLaneState<2, double, Device> spline_lanes;
    spline_lanes.grid = dam.grid;
    spline_lanes.boundary.declared = dam.declared(splines.grid);
    const auto wide = dam.of_particles(splines, fixed);
    CHECK_THAT(wide.force[0], WithinRel(x, 5e-3));
    CHECK_THAT(wide.force[1], WithinRel(y, 5e-3));
    check_same(dam.of_lanes(spline_lanes, fixed), wide);
  }
  // A caller who knows better: particles that cover half as much, or nothing, leave half of what the support
  // takes up, or all of it, in the sum.
  const Kokkos::View<float**, Device> half("vsb::cover", static_cast<size_t>(dam.block.particles.count()), 2);
  const double whole = y + 9810 * 8 * 0.75;
  for (const float share : {0.5f, 0.0f}) {
    Kokkos::deep_copy(half, share);
    for (int p = 0; p < dam.block.particles.count(); ++p)
      if (dam.block.particles.position(p, 1) > 0.25) half(p, 1) = 0;
    const auto less = dam.of_particles(basis, 3, half);
    CHECK_THAT(less.force[1], WithinRel(share * y + (1 - share) * whole, 1e-12));
    check_same(dam.of_lanes(lanes, 3, half), less);
  }
  // Where nothing is fixed, the foot is loaded too: by 78,480 Pa where chi is 1, over the half metre of the
  // cell that touches void cells, and by half of it where chi falls to 0, over the next.
  const auto open = dam.of_particles(basis, 0);
  CHECK_THAT(open.force[0], WithinRel(x, 1e-12));
  CHECK_THAT(open.force[1], WithinRel(y + 9810 * 8 * 0.75, 1e-12));
}
