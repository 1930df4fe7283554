// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Every kernel, region and allocation carries a label that starts with "vsb::", so that profilers name them.
#include <algorithm>
#include <set>
#include <vsb/kernels/boundary/flag_boundary_particles.hpp>
#include <vsb/kernels/boundary/self_balance.hpp>
#include <vsb/kernels/particles/remove_particles.hpp>
#include <vsb/kernels/readout/balance.hpp>
#include <vsb/kernels/readout/health.hpp>
#include <vsb/kernels/readout/plastic_strain.hpp>
#include <vsb/kernels/readout/smooth_particles.hpp>
#include <vsb/kernels/statics/static_solution.hpp>
#include <vsb/kernels/statics/unsupported_load.hpp>

#include "wide_bases.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

namespace tools = Kokkos::Tools::Experimental;

/// What Kokkos reported, each as "kind: label".
std::set<std::string> seen;

void note(const char* kind, const std::string& label) {
  seen.insert(std::string(kind) + ": " + label);
}

/// Collects labels for its lifetime.
class Listener {
 public:
  Listener() {
    seen.clear();
    before_ = tools::get_callbacks();
    tools::set_begin_parallel_for_callback([](const char* name, uint32_t, uint64_t*) { note("for", name); });
    tools::set_begin_parallel_reduce_callback(
        [](const char* name, uint32_t, uint64_t*) { note("reduce", name); });
    tools::set_begin_parallel_scan_callback(
        [](const char* name, uint32_t, uint64_t*) { note("scan", name); });
    tools::set_push_region_callback([](const char* name) { note("region", name); });
    tools::set_allocate_data_callback([](Kokkos_Profiling_SpaceHandle, const char* name, const void*,
                                         uint64_t) { note("allocation", name); });
  }
  ~Listener() { tools::set_callbacks(before_); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

 private:
  tools::EventSet before_;
};

/// Whether a report is ours or Kokkos's own; where the latter names a View, "Kokkos::...[label]", that must
/// be ours.
bool in_order(const std::string& report) {
  const std::string label = report.substr(report.find(": ") + 2);
  if (label.rfind("vsb::", 0) == 0) return true;
  if (label.rfind("Kokkos::", 0) != 0) return false;
  const auto bracket = label.find('[');
  return bracket == std::string::npos || label.compare(bracket + 1, 5, "vsb::") == 0;
}

/// `basis`: on `grid`, or with a layer of ghost cells around it.
template <class Basis, int Dim>
void run_everything(const Basis& basis, const UniformGrid<Dim, double>& grid, Scatter strategy) {
  auto block = allocate_particles<Dim, double, Device>(64);
  edit(block, [&](const auto& particles) {
    Random random(81);
    for (int p = 0; p < 64; ++p) {
      const auto x = random_point(grid, random);
      for (int i = 0; i < Dim; ++i) particles.position(p, i) = x[i];
      particles.mass(p) = particles.volume(p) = 1;
    }
  });
  allocate_material_state(block, 32, Dim * Dim);
  auto state = make_state(block.particles, basis);
  Kokkos::deep_copy(state.occupancy.tractions, 1u);
  state.occupancy.at_all_active_nodes = 1;  // so that it acts where particles leave no boundary
  set_fill_criterion(state.occupancy, 0.1);
  set_void_filter(state.occupancy, basis);
  const std::vector<Body<double>> bodies{{0, 32, LinearElastic<double>::from_young(1, 0.3)},
                                         {32, 64, Hencky<double>::from_young(2, 0.3), -32}};
  UniformVirtualStress<Dim, double> pressure;
  pressure.count = 1;
  pressure.stress[0] = pressure_stress<Dim>(1e-3);
  StepOptions<Dim, double> options;
  options.dt = 1e-4;
  options.scatter = strategy;
  for (const VolumeUpdate& update : {VolumeUpdate(DeterminantVolume{}), VolumeUpdate(ExponentialVolume{})}) {
    options.volume_update = update;
    REQUIRE(step(Exec(), state, bodies, basis, pressure, options) == -1);
    REQUIRE(step(Exec(), state, bodies, basis, NoVirtualStress{}, options) == -1);
  }
  // The other ways to impose a traction: a massless boundary particle, and whole cells.
  state.surface = allocate_surface_points<Dim, double, Device>(1, basis.node_count(), basis.bin_count());
  edit(state.surface.position, [&](const auto& x) {
    for (int i = 0; i < Dim; ++i) x(0, i) = grid.lower[i] + 0.5 * grid.spacing[i];
  });
  edit(state.surface.carrier, [](const auto& carrier) { carrier(0) = carried_by_grid; });
  if constexpr (Basis::ghost_layers == 0) {
    using Original = OriginalVirtualStress<decltype(pressure), UniformGrid<Dim, double>, Device>;
    const Original original{pressure, grid, state.occupancy.cells, 1u, 2};
    REQUIRE(step(Exec(), state, bodies, basis, original, options) == -1);
  }
  options.volumetric = Volumetric::averaged;
  REQUIRE(step(Exec(), state, bodies, basis, pressure, options) == -1);
  balance(Exec(), state, bodies, basis, pressure, options);
  balancing_force(Exec(), block.particles, pressure, 1u, grid.lower);
  REQUIRE(find_invalid(Exec(), block.particles).particle == -1);
  find_unsupported_load(Exec(), state.nodes, state.occupancy.bins, basis, 1e-10);
  Stiffness<Basis, Dim, double, Device> stiffness(block.particles, bodies, basis, state.occupancy.bins,
                                                  strategy);
  const auto u = state.nodes.velocity;
  solve_displacement(Exec(), stiffness, state.nodes, u, StaticOptions{1e-10, 2},
                     [](int, double) { return true; });
  strain_particles(Exec(), block.particles, bodies, basis, u);
  edit(block, [](const auto& particles) { particles.volume(0) = -1; });
  REQUIRE(find_invalid(Exec(), block.particles).particle == 0);
  const Kokkos::View<unsigned char*, Device> flag("vsb::flag", 64);
  void_filter_effect(Exec(), block.particles, state.occupancy.cells, basis, state.occupancy.tractions, 0);
  flag_boundary_particles(Exec(), block.particles, state.occupancy.boundary, basis, flag);
  displace_particles(Exec(), block.particles, basis, u);
  const Kokkos::View<double*, Device> strain("vsb::strain", 64);
  auto yielded = allocate_particles<Dim, double, Device>(64);
  allocate_material_state(yielded, 64, 6);
  equivalent_plastic_strain(Exec(), yielded.particles, 0, 64, 0, strain);
  smooth_particles(Exec(), block.particles, state.occupancy.bins, basis, strain, strategy);
  const auto kept = list_kept<Exec, Device>(Exec(), flag);
  keep_particles<Exec, Dim, double, Device>(Exec(), yielded, kept, kept);
}

}  // namespace

TEST_CASE("every label starts with vsb::") {
  {
    const Listener listener;
    const auto line = make_grid<1, double>({{8, 8, 8}});
    const auto plane = make_grid<2, double>({{8, 8, 8}});
    const auto space = make_grid<3, double>({{8, 8, 8}});
    auto wide = WideBasis<QuadraticBSplineBasis<2, double>>::on(plane);
    wide.walls.fixed[0][0] = 1;
    wide.walls.fixed[1][1] = 3;
    for (const Scatter strategy : {Scatter::atomic, Scatter::duplicated, Scatter::gathered}) {
      if (strategy == Scatter::duplicated && !std::is_same_v<Device::memory_space, Kokkos::HostSpace>)
        continue;
      run_everything(LinearBasis<1, double>{line}, line, strategy);
      run_everything(wide, plane, strategy);
      run_everything(LinearBasis<3, double>{space}, space, strategy);
    }
  }
  for (const auto& report : seen) {
    CAPTURE(report);
    CHECK(in_order(report));
  }
  // The listener did listen.
  for (const char* report : {"region: vsb::step",
                             "for: vsb::particles_to_grid",
                             "for: vsb::particles_to_grid/nodes",
                             "reduce: vsb::locate_particles",
                             "reduce: vsb::mark_boundary_nodes",
                             "reduce: vsb::mark_underfilled_cells",
                             "for: vsb::add_underfilled_cells",
                             "for: vsb::keep_outside_cells",
                             "reduce: vsb::flood_voids",
                             "reduce: vsb::count_false_voids",
                             "allocation: vsb::material_state",
                             "reduce: vsb::find_invalid",
                             "scan: vsb::scan_offsets",
                             "for: vsb::sum_divergence/nodes",
                             "for: vsb::divide_by_volume",
                             "for: vsb::interpolate_divergence",
                             "for: vsb::update_stress",
                             "for: vsb::load_surface_point",
                             "for: vsb::surface_force",
                             "for: vsb::move_surface_points",
                             "for: vsb::subtract_cell_virtual_stress",
                             "for: vsb::fold_ghost_nodes",
                             "for: vsb::mirror_vectors",
                             "for: vsb::mirror_masks",
                             "for: vsb::node_balance",
                             "for: vsb::divergence_moments",
                             "region: vsb::solve_displacement",
                             "for: vsb::stiffness_force",
                             "reduce: vsb::strain_particles",
                             "for: vsb::equivalent_plastic_strain",
                             "for: vsb::interpolate_mean",
                             "scan: vsb::list_kept",
                             "for: vsb::store_rows",
                             "allocation: vsb::particles",
                             "allocation: vsb::bin_sums"}) {
    CAPTURE(report);
    CHECK(seen.count(report) == 1);
  }
}

TEST_CASE("a label of another kind would be found") {
  {
    const Listener listener;
    const Kokkos::View<int*, Device> view("mine", 3);
    Kokkos::parallel_for(Kokkos::RangePolicy<Exec>(0, 1),
                         kernel::SortBin<Device>{allocate_bins<Device>(1, 1)});
  }
  CHECK(std::count_if(seen.begin(), seen.end(), in_order) < static_cast<int>(seen.size()) - 1);
}
