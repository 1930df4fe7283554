// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The static state of a scene's particles under its loads.
#pragma once

#include <algorithm>
#include <functional>
#include <vsb/kernels/statics/static_solution.hpp>
#include "setup/check_tractions.hpp"

namespace vsb::app {

/// What was found; with a solution the particles have their stress, and `displacement` is that of the nodes.
template <int Dim, class Real, class Device>
struct StaticState {
  StaticResult result{0, 0, true};
  double largest_strain = 0;
  typename Nodes<Dim, Real, Device>::Fields displacement;
  int lost = -1;  ///< a surface point outside the grid, and then nothing is done
};

/// with_field(work) calls work with the field of the loads; the occupancy must be up to date. Throws
/// SetupError where a load has no support.
template <class Exec, class Basis, int Dim, class Real, class Device, class WithField>
StaticState<Dim, Real, Device> solve_static(const Exec& exec, const Scene& scene,
                                            State<Dim, Real, Device>& state,
                                            const std::vector<Body<Real>>& bodies, const Basis& basis,
                                            const StepOptions<Dim, Real>& options,
                                            const WithField& with_field,
                                            const std::function<bool(int, double)>& go_on) {
  StaticState<Dim, Real, Device> found;
  // What is left of an initial stress that balances the loads is round-off, which nothing need take up.
  particles_to_grid(exec, state.particles, state.occupancy.bins, state.nodes, state.occupancy.boundary,
                    state.sums_workspace.particles, basis, NoVirtualStress{}, options.gravity,
                    options.scatter);
  const double round_off = 1e-13 * sum_of_forces(exec, state.nodes);
  found.lost = with_field([&](const auto& field) {
    return assemble_forces(exec, state.particles, state.occupancy, state.surface, state.nodes,
                           state.sums_workspace, basis, field, options.gravity, options.scatter);
  });
  if (found.lost >= 0) return found;
  auto& u = found.displacement;
  u = typename Nodes<Dim, Real, Device>::Fields("vsb::node_displacement",
                                                static_cast<size_t>(basis.node_count()), Dim);
  Stiffness<Basis, Dim, Real, Device> stiffness(state.particles, bodies, basis, state.occupancy.bins,
                                                options.scatter, options.volumetric);
  if (sum_of_forces(exec, state.nodes) > round_off) {
    const auto& wanted = scene.static_solution;
    refuse_unsupported(scene, find_unsupported_load(exec, state.nodes, state.occupancy.bins, basis,
                                                    std::max(wanted.residual, 1e-11)));
    found.result = solve_displacement(exec, stiffness, state.nodes, u,
                                      StaticOptions{wanted.residual, wanted.max_iterations}, go_on);
  }
  if (found.result.converged)
    found.largest_strain =
        strain_particles(exec, state.particles, bodies, basis, u, stiffness.average(exec, u));
  return found;
}

}  // namespace vsb::app
