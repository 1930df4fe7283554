// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The scene with quadratic B-splines: on cell lanes (kernels/lane_step.hpp), and for the particle
/// kernels.
#pragma once

#include "scene.hpp"

#include <vsb/kernels/lane_step.hpp>
#include <vsb/physics/quadratic_bspline_basis.hpp>

namespace vsb::bench {

/// The column of all benchmarks, in a grid that leaves it the cells that wider functions want beyond its
/// faces, fixed at its lower end.
template <int Dim, class Real>
struct SplineColumn {
  Column<Dim, Real> column;
  QuadraticBSplineBasis<Dim, Real> basis;
  State<Dim, Real, Device> state;
  SplineLaneState<Dim, Real, Device> lanes;

  SplineColumn(Size size, Load load) {
    size.void_across = size.void_along = 2;
    column = make_column<Dim, Real>(size, load, 0);  // along x, as lanes lie
    const auto& grid = column.basis.grid;
    basis.grid = with_ghost_layer(grid);
    basis.walls.fixed[column.axis][0] = static_cast<ComponentMask>((1 << Dim) - 1);
    set_grid(lanes, grid);
    lanes.memory.walls = basis.walls;
    lanes.boundary.everywhere = load == Load::off ? 0 : 1;
  }
  void pack() {
    if (pack_lanes(Exec(), column.block.particles, lanes) >= 0)
      throw std::runtime_error("a particle of the column is outside its grid");
    with_field(column, [&](const auto& field) { prepare_lane_step(Exec(), lanes, field); });
  }
  void step_lanes() {
    with_field(column, [&](const auto& field) {
      lane_step(Exec(), lanes, column.material, DeterminantVolume{}, field, column.options);
    });
  }
  void make_particle_state() {
    state = make_state(column.block.particles, basis);
    const auto fixed = Kokkos::create_mirror_view(state.nodes.fixed_components);
    for (int node = 0; node < basis.node_count(); ++node)
      fixed(static_cast<size_t>(node)) =
          basis.grid.node_ijk(node)[column.axis] == 1 ? ComponentMask((1 << Dim) - 1) : ComponentMask(0);
    Kokkos::deep_copy(state.nodes.fixed_components, fixed);
  }
  /// Without load.
  void step_particles() {
    const std::vector<Body<Real>> bodies{{0, column.block.particles.count(), column.material}};
    step(Exec(), state, bodies, basis, NoVirtualStress{}, column.options);
  }
};

}  // namespace vsb::bench
