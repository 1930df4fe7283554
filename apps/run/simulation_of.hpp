// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The simulation of a scene in a given dimension, precision and basis, on the backend of this build.
#pragma once

#include <fmt/format.h>

#include <cstring>

#include <vsb/kernels/balance.hpp>
#include <vsb/kernels/flag_boundary_particles.hpp>
#include <vsb/kernels/health.hpp>
#include <vsb/kernels/plastic_strain.hpp>
#include <vsb/kernels/remove_particles.hpp>
#include <vsb/kernels/smooth_particles.hpp>
#include <vsb/kernels/static_solution.hpp>
#include <vsb/kernels/unsupported_load.hpp>
#include "run/basis_of.hpp"
#include "run/field_advice.hpp"
#include "run/grid_lines.hpp"
#include "run/lane_engine.hpp"
#include "run/loads.hpp"
#include "run/material_of.hpp"
#include "run/simulation.hpp"
#include "run/void_seeds.hpp"

namespace vsb::app {

template <int Dim, class Real, class Basis>
class SimulationOf final : public Simulation {
 public:
  explicit SimulationOf(const Scene& scene)
      : scene_(scene),
        placed_(place_particles(scene)),
        owned_basis_(scene),
        basis_(owned_basis_.basis),
        loads_(scene) {
    if (!scene.grid.mapped() && Basis::reach == 0) refuse_on_grid_lines(scene, placed_);
    block_ = allocate_particles<Dim, Real, Device>(static_cast<int>(placed_.position.size()));
    fill_particles();
    placed_count_ = block_.particles.count();
    make_bodies();
    state_ = make_state(block_.particles, basis_);
    if (scene.method.fill_criterion > 0) set_fill_criterion(state_.occupancy, scene.method.fill_criterion);
    if (scene.method.void_filter) {
      set_void_filter(state_.occupancy, basis_);
      remove_body_cells<Device>(scene, basis_.grid, state_.occupancy.cells.outside);
    }
    fix_faces();
    declare_tractions();
    place_surface_points();
    resultants_ = exact_resultants(scene);
    options_.dt = static_cast<Real>(scene.time.dt);
    options_.damping = static_cast<Real>(scene.method.damping);
    for (int i = 0; i < Dim; ++i)
      options_.gravity[i] = static_cast<Real>(scene.gravity[static_cast<size_t>(i)]);
    if (scene.method.volume_update == "exponential") options_.volume_update = ExponentialVolume{};
    options_.scatter = scene.method.scatter == "atomic"       ? Scatter::atomic
                       : scene.method.scatter == "duplicated" ? Scatter::duplicated
                                                              : Scatter::gathered;
    locate();
    check_tractions();
    particle_kernels_because_ = reason_for_particle_kernels(scene);
    if constexpr (has_lanes)
      if (particle_kernels_because_.empty()) pack();
  }

  int particle_count() const override { return state_.particles.count(); }
  long long step() const override { return step_; }
  double load_time() const override { return load_time_at(step_); }
  int boundary_nodes() const override {
    if constexpr (has_lanes)
      if (lanes_) return lanes_->boundary_nodes();
    return state_.occupancy.boundary_node_count;
  }
  std::string particle_kernels_because() const override { return particle_kernels_because_; }

  CutVolume cut_volume() const override { return placed_.cut; }
  MomentFit moment_fit() const override { return placed_.moment_fit; }
  VoidFilterReport void_filter() const override {
    const auto& o = state_.occupancy;
    if (!scene_.method.void_filter) return {};
    const auto effect = void_filter_effect(exec_, state_.particles, o.cells, basis_, o.tractions,
                                           o.boundary_node_count, o.conservative);
    return {effect.false_voids, effect.dropped_nodes};
  }
  std::vector<std::string> advice() const override { return field_advice(scene_, placed_, cells_inside()); }

  size_t state_bytes() const override {
    const auto& o = state_.occupancy;
    const auto& n = state_.nodes;
    const auto bytes = [](const auto&... views) { return (... + (views.span() * sizeof(*views.data()))); };
    return bytes(block_.block, block_.state_block, n.sums, n.acceleration, n.velocity, n.remapped_velocity,
                 n.fixed_components, o.bins.bin, o.bins.order, o.bins.offset, o.bins.cursor, o.bins.slot,
                 o.bins.occupied, o.cells.occupied, o.cells.exterior, o.cells.boundary, o.cells.underfilled,
                 o.cells.outside, o.tractions, o.boundary, state_.sums_workspace.particles.bin_sums,
                 state_.remap_workspace.bin_sums) +
           lane_bytes() + owned_basis_.bytes() + placed_.position.size() * sizeof(placed_.position[0]);
  }

  void advance(long long steps) override {
    if constexpr (has_lanes)
      if (lanes_) return advance_lanes(steps);
    for (long long n = 0; n < steps; ++n) {
      set_loads(load_time_at(step_ + 1));
      const int lost = with_field(
          [&](const auto& field) { return vsb::step(exec_, state_, bodies_, basis_, field, options_); });
      if (lost >= 0) throw_lost(lost);
      ++step_;
    }
    exec_.fence();
  }

  StaticSolution solve_static(double t, const std::function<bool(int, double)>& go_on) override {
    set_loads(t);
    locate();
    // What is left of an initial stress that balances the loads is round-off, which nothing need take up.
    particles_to_grid(exec_, state_.particles, state_.occupancy.bins, state_.nodes, state_.occupancy.boundary,
                      state_.sums_workspace.particles, basis_, NoVirtualStress{}, options_.gravity,
                      options_.scatter);
    const double round_off = 1e-13 * sum_of_forces(exec_, state_.nodes);
    const int lost = with_field([&](const auto& field) {
      return assemble_forces(exec_, state_.particles, state_.occupancy, state_.surface, state_.nodes,
                             state_.sums_workspace, basis_, field, options_.gravity, options_.scatter);
    });
    if (lost >= 0) throw_lost(particle_count() + lost);
    const typename Nodes<Dim, Real, Device>::Fields u("vsb::node_displacement",
                                                      static_cast<size_t>(basis_.node_count()), Dim);
    StaticResult result{0, 0, true};
    if (sum_of_forces(exec_, state_.nodes) > round_off) {
      const auto& wanted = scene_.static_solution;
      refuse_unsupported(find_unsupported_load(exec_, state_.nodes, state_.occupancy.bins, basis_,
                                               std::max(wanted.residual, 1e-11)));
      Stiffness<Basis, Dim, Real, Device> stiffness(state_.particles, bodies_, basis_, state_.occupancy.bins,
                                                    options_.scatter);
      result = solve_displacement(exec_, stiffness, state_.nodes, u,
                                  StaticOptions{wanted.residual, wanted.max_iterations}, go_on);
    }
    StaticSolution solution;
    solution.iterations = result.iterations;
    solution.residual = result.residual;
    solution.converged = result.converged;
    if (!result.converged) return solution;
    solution.largest_strain = strain_particles(exec_, state_.particles, bodies_, basis_, u);
    solution.balance = balance_under_loads_at(t);
    displace_particles(exec_, state_.particles, basis_, u);
    exec_.fence();
    if constexpr (has_lanes)
      if (lanes_) pack();
    return solution;
  }

  void check_health() const override {
    unpack();
    const auto bad = find_invalid(exec_, state_.particles);
    if (bad.particle < 0) return;
    static const char* names[] = {"position", "velocity", "cauchy_stress", "volume"};
    static const char* faults[] = {"is not finite", "is not finite", "is not finite",
                                   "is not positive (J <= 0)"};
    const auto f = static_cast<size_t>(bad.field);
    throw Diverged(fmt::format("at step {}, time {:.6g} s: {} of particle {} {}", step_, time(), names[f],
                               id_of(bad.particle), faults[f]));
  }

  BalanceReport balance() override { return balance_under_loads_at(load_time()); }
  BalanceReport balance_under_loads_at(double t) override {
    unpack();
    set_loads(t);
    locate();
    const auto b = with_field(
        [&](const auto& field) { return vsb::balance(exec_, state_, bodies_, basis_, field, options_); });
    BalanceReport report;
    report.force_ratio = b.force_ratio();
    report.energy_ratio = b.strain_energy > 0 ? b.kinetic_energy / b.strain_energy : 1.0;
    for (int i = 0; i < Dim; ++i) report.net_force[static_cast<size_t>(i)] = b.net_force[i];
    for (size_t i = 0; i < 3; ++i) {
      report.net_torque[i] = b.net_torque[static_cast<int>(i)];
      for (size_t k = 0; k < scene_.tractions.size(); ++k) {
        const double factor = scene_.tractions[k].time(t);
        report.exact_force[i] += factor * resultants_[k].force[i];
        report.exact_torque[i] += factor * resultants_[k].torque[i];
      }
    }
    return report;
  }

  Snapshot snapshot() override {
    unpack();
    const auto host_block = host_copy(block_);
    const auto& p = host_block.particles;
    const auto n = static_cast<size_t>(p.count());
    const Kokkos::View<unsigned char*, Device> flag("vsb::boundary_particles", n);
    locate();
    flag_boundary_particles(exec_, state_.particles, state_.occupancy.boundary, basis_, flag);
    exec_.fence();
    const auto host_flag =
        Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), flag, "vsb::flags on host");
    Snapshot s;
    s.step = step_;
    s.time = time();
    s.bodies = placed_.bodies;
    s.id.resize(n);
    s.in_boundary.assign(host_flag.data(), host_flag.data() + n);
    for (auto* field : {&s.position, &s.initial_position, &s.velocity}) field->assign(3 * n, 0.0);
    s.cauchy_stress.assign(6 * n, 0.0);
    s.volume.resize(n);
    s.mass.resize(n);
    for (size_t i = 0; i < n; ++i) {
      s.id[i] = id_of(static_cast<int>(i));
      for (size_t d = 0; d < Dim; ++d) {
        s.position[3 * i + d] = p.position(i, d);
        s.initial_position[3 * i + d] = static_cast<Real>(placed_.position[i][d]);
        s.velocity[3 * i + d] = p.velocity(i, d);
      }
      for (size_t c = 0; c < SymmetricTensor<Dim, Real>::size; ++c)
        s.cauchy_stress[6 * i + c] = p.cauchy_stress(i, c);
      s.volume[i] = p.volume(i);
      s.mass[i] = p.mass(i);
    }
    s.plastic_strain = plastic_strain(p);
    return s;
  }

  std::vector<double> equivalent_plastic_strain(bool smoothed) override {
    unpack();
    const Kokkos::View<Real*, Device> strain("vsb::plastic_strain", static_cast<size_t>(particle_count()));
    for (const auto& body : bodies_)
      if (is_plastic(body.material))
        vsb::equivalent_plastic_strain(exec_, state_.particles, body.first, body.last, body.state_offset,
                                       strain);
    if (smoothed) {
      locate();
      smooth_particles(exec_, state_.particles, state_.occupancy.bins, basis_, strain, options_.scatter);
    }
    exec_.fence();
    const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), strain);
    return std::vector<double>(host.data(), host.data() + host.extent(0));
  }

  double yielded_volume() override {
    const auto strain = equivalent_plastic_strain(false);
    const auto host = host_copy(block_);
    double sum = 0;
    for (size_t p = 0; p < strain.size(); ++p)
      if (strain[p] > 0) sum += static_cast<double>(host.particles.volume(p));
    return sum;
  }

  std::vector<CellContent> cell_contents(const std::vector<unsigned char>& marked) override {
    unpack();
    const auto host = host_copy(block_);
    size_t cells = 1;
    for (size_t i = 0; i < Dim; ++i) cells *= static_cast<size_t>(scene_.grid.cells[i]);
    std::vector<int> surplus(cells, 0);  // of marked particles
    std::vector<CellContent> contents(cells, CellContent::nothing);
    for (int p = 0; p < particle_count(); ++p) {
      const auto cell = basis_.grid.cell_containing(host.particles.position_of(p));
      int index = 0;
      for (int i = Dim - 1; i >= 0; --i)
        index = index * scene_.grid.cells[static_cast<size_t>(i)] + (cell[i] - Basis::reach);
      const auto c = static_cast<size_t>(index);
      surplus[c] += marked[static_cast<size_t>(p)] != 0 ? 1 : -1;
      contents[c] = surplus[c] >= 0 ? CellContent::marked : CellContent::particles;
    }
    return contents;
  }

  void remove(const std::vector<unsigned char>& removed, const Restart& restart) override {
    unpack();
    keep(removed);
    if (restart.damping) options_.damping = static_cast<Real>(*restart.damping);
    if (restart.reset) {
      fill_particles();
      if (block_.state_block.size() > 0) Kokkos::deep_copy(block_.state_block, Real(0));
      loads_begin_ = step_;
    }
    locate();
    if constexpr (has_lanes)
      if (lanes_) pack();
  }

  GridSnapshot grid_snapshot() override {
    // The nodes of the state as it is, however the steps before it were made.
    balance();
    update_nodes(exec_, state_.nodes, basis_, options_.damping, options_.dt);
    exec_.fence();
    const auto sums =
        Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), state_.nodes.sums, "vsb::sums on host");
    const auto velocity = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), state_.nodes.velocity,
                                                              "vsb::velocity on host");
    const auto boundary = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), state_.occupancy.boundary,
                                                              "vsb::boundary on host");
    const auto nodes = scene_nodes();
    const auto n = nodes.size();
    GridSnapshot g;
    g.mass.resize(n);
    g.boundary.resize(n);
    g.velocity.assign(3 * n, 0.0);
    g.force.assign(3 * n, 0.0);
    for (size_t i = 0; i < n; ++i) {
      const size_t I = nodes[i];
      g.mass[i] = sums(I, 0);
      g.boundary[i] = boundary(I) != 0;
      for (size_t d = 0; d < Dim; ++d) {
        g.velocity[3 * i + d] = velocity(I, d);
        g.force[3 * i + d] = sums(I, 1 + Dim + d);
      }
    }
    return g;
  }

  SavedState save() const override {
    if constexpr (has_lanes)
      if (lanes_) return {step_, sizeof(Real), lanes_->save(), staged_state()};
    const auto host = host_copy(block_);
    SavedState saved{step_, sizeof(Real), std::vector<unsigned char>(saved_bytes()), staged_state()};
    unsigned char* to = saved.particles.data();
    for_each_column(host, [&](const Real* column, size_t bytes) {
      std::memcpy(to, column, bytes);
      to += bytes;
    });
    for (const auto& field : {state_.surface.position, state_.surface.area}) {
      const auto on_host =
          Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), field, "vsb::surface on host");
      if (field.span() == 0) continue;
      std::memcpy(to, on_host.data(), field.span() * sizeof(Real));
      to += field.span() * sizeof(Real);
    }
    const auto outside = Kokkos::create_mirror_view_and_copy(
        Kokkos::HostSpace(), state_.occupancy.cells.outside, "vsb::outside on host");
    if (outside.span() > 0) std::memcpy(to, outside.data(), outside.span() * sizeof(std::uint64_t));
    return saved;
  }

  void restore(const SavedState& saved) override {
    restore_staged(saved.staged);
    if constexpr (has_lanes)
      if (lanes_) return restore_lanes(saved);
    if (saved.bytes_per_number != sizeof(Real) || saved.particles.size() != saved_bytes())
      throw SetupError("the checkpoint belongs to another scene: its particles do not fit this one's");
    const auto host = host_copy(block_);
    const unsigned char* from = saved.particles.data();
    for_each_column(host, [&](Real* column, size_t bytes) {
      std::memcpy(column, from, bytes);
      from += bytes;
    });
    copy_to_device(host, block_);
    for (const auto& field : {state_.surface.position, state_.surface.area}) {
      if (field.span() == 0) continue;
      const auto on_host = Kokkos::create_mirror_view(field);
      std::memcpy(on_host.data(), from, field.span() * sizeof(Real));
      from += field.span() * sizeof(Real);
      Kokkos::deep_copy(field, on_host);
    }
    if (const auto& outside = state_.occupancy.cells.outside; outside.span() > 0) {
      const auto on_host = Kokkos::create_mirror_view(outside);
      std::memcpy(on_host.data(), from, outside.span() * sizeof(std::uint64_t));
      Kokkos::deep_copy(outside, on_host);
      mark_anew(state_.occupancy);
    }
    step_ = saved.step;
    if (update_occupancy(exec_, state_.particles, state_.occupancy, basis_) >= 0)
      throw SetupError("the checkpoint belongs to another scene: it has particles outside this one's grid");
  }

 private:
  /// Visits the columns of the particles and of their material states: first value, bytes without padding.
  template <class Visit>
  static void for_each_column(const ParticleBlock<Dim, Real, Kokkos::HostSpace>& host, const Visit& visit) {
    const auto columns = [&](const auto& block, size_t rows) {
      for (size_t c = 0; c < block.extent(1); ++c) visit(&block(0, c), rows * sizeof(Real));
    };
    columns(host.block, host.particles.mass.extent(0));
    columns(host.state_block, host.particles.material_state.extent(0));
  }

  /// Bytes of a saved state: the columns of the particles and of their material states, positions and areas
  /// of the surface points, and the outside of the void filter.
  size_t saved_bytes() const {
    const auto& state = block_.particles.material_state;
    return (block_.block.extent(1) * placed_.position.size() + state.extent(0) * state.extent(1) +
            state_.surface.position.span() + state_.surface.area.span()) *
               sizeof(Real) +
           state_.occupancy.cells.outside.span() * sizeof(std::uint64_t);
  }

  /// Takes particles out of everything that counts them.
  void keep(const std::vector<unsigned char>& removed) {
    const Kokkos::View<unsigned char*, Device> flags("vsb::removed_particles", removed.size());
    const auto on_host = Kokkos::create_mirror_view(flags);
    std::copy(removed.begin(), removed.end(), on_host.data());
    Kokkos::deep_copy(flags, on_host);
    const auto kept = list_kept<ExecutionSpace, Device>(exec_, flags);
    const auto host_kept = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), kept);
    std::vector<int> ids, states;
    for (size_t k = 0; k < host_kept.extent(0); ++k) {
      const auto p = static_cast<size_t>(host_kept(k));
      ids.push_back(id_of(host_kept(k)));
      placed_.position[k] = placed_.position[p];
      placed_.volume[k] = placed_.volume[p];
    }
    placed_.position.resize(ids.size());
    placed_.volume.resize(ids.size());
    ids_ = std::move(ids);
    for (size_t b = 0, first = 0; b < bodies_.size(); ++b) {
      auto& body = bodies_[b];
      const bool has_state = state_size<Dim>(body.material) > 0;
      const int rows_before = static_cast<int>(states.size());
      const auto begin = static_cast<int>(first);
      for (; first < host_kept.extent(0) && host_kept(first) < body.last; ++first)
        if (has_state) states.push_back(host_kept(first) + body.state_offset);
      placed_.bodies[b] = {begin, static_cast<int>(first)};
      body.first = begin;
      body.last = static_cast<int>(first);
      body.state_offset = has_state ? rows_before - begin : 0;
    }
    const Kokkos::View<int*, Device> kept_states("vsb::kept_states", states.size());
    const auto host_states = Kokkos::create_mirror_view(kept_states);
    std::copy(states.begin(), states.end(), host_states.data());
    Kokkos::deep_copy(kept_states, host_states);
    block_ = keep_particles<ExecutionSpace, Dim, Real, Device>(exec_, block_, kept, kept_states);
    state_.particles = block_.particles;
    state_.occupancy.bins = allocate_bins<Device>(particle_count(), basis_.bin_count());
  }

  /// The particles that are left, of all there were at the start.
  StagedState staged_state() const {
    if (!scene_.removal) return {};
    StagedState staged;
    staged.loads_begin = loads_begin_;
    staged.present.assign(static_cast<size_t>(placed_count_), ids_.empty() ? 1 : 0);
    for (const int id : ids_) staged.present[static_cast<size_t>(id)] = 1;
    return staged;
  }
  void restore_staged(const StagedState& staged) {
    if (!scene_.removal) return;
    if (staged.present.size() != static_cast<size_t>(placed_count_) || !ids_.empty())
      throw SetupError("the checkpoint belongs to another scene: it has other particles");
    std::vector<unsigned char> removed(staged.present);
    for (auto& flag : removed) flag = flag == 0;
    Restart restart;
    if (!scene_.removal->reset) restart.damping = scene_.removal->damping;
    if (std::find(removed.begin(), removed.end(), 1) != removed.end()) remove(removed, restart);
    loads_begin_ = staged.loads_begin;
  }

  static constexpr bool has_splines = std::is_same_v<Basis, QuadraticBSplineBasis<Dim, Real>>;
  static constexpr bool has_lanes = has_splines || std::is_same_v<Basis, LinearBasis<Dim, Real>>;
  using Engine =
      LaneEngine<Dim, Real,
                 std::conditional_t<has_splines, SplineLaneState<Dim, Real, ExecutionSpace::device_type>,
                                    LaneState<Dim, Real, ExecutionSpace::device_type>>>;

  /// Packs the particles into cell lanes.
  void pack() {
    typename Engine::Setup setup;
    setup.grid = uniform_grid<Dim, Real>(scene_.grid);
    for (int i = 0; i < Dim; ++i)
      for (int side = 0; side < 2; ++side)
        setup.walls.fixed[i][side] = scene_.faces.fixed[static_cast<size_t>(i)][static_cast<size_t>(side)];
    setup.tractions = state_.occupancy.tractions;
    setup.conservative = state_.occupancy.conservative;
    setup.original = loads_.original();
    setup.gauss_points = loads_.gauss_points();
    setup.material = bodies_.front().material;
    setup.state_size = state_size<Dim>(setup.material);
    setup.options = options_;
    packed_ = false;
    lanes_.reset();  // its memory first
    lanes_ = std::make_unique<Engine>(setup, state_.particles, state_.surface);
  }
  /// Brings the particles back from the lanes, where they moved there.
  void unpack() const {
    if constexpr (has_lanes) {
      if (lanes_ && packed_) lanes_->unpack(state_.particles, state_.surface);
      packed_ = false;
    }
  }
  void advance_lanes(long long steps) {
    if (!lanes_->prepared()) {
      set_loads(load_time_at(step_ + 1));
      const int lost = lanes_->prepare(loads_);
      if (lost >= 0) throw_lost(lost);
    }
    for (long long n = 0; n < steps; ++n) {
      set_loads(load_time_at(step_ + 2));
      packed_ = true;
      const int lost = lanes_->step(loads_);
      ++step_;
      if (lost >= 0) throw_lost(lost);
    }
    exec_.fence();
  }
  void restore_lanes(const SavedState& saved) {
    if (saved.bytes_per_number != sizeof(Real) || !lanes_->restore(saved.particles))
      throw SetupError("the checkpoint belongs to another scene: its particles do not fit this one's");
    step_ = saved.step;
    packed_ = true;
    unpack();
    locate();
  }
  size_t lane_bytes() const {
    if constexpr (has_lanes)
      if (lanes_) return lanes_->bytes();
    return 0;
  }

  using Device = ExecutionSpace::device_type;
  static_assert(max_tractions == UniformVirtualStress<Dim, Real>::capacity,
                "a scene may declare as many tractions as the kernels can take");

  /// A node's numbers along the axes in the scene's grid, which has no ghost layer.
  std::array<int, 3> ijk_in_scene(int node) const {
    const auto ijk = basis_.grid.node_ijk(node);
    std::array<int, 3> in_scene{};
    for (int i = 0; i < Dim; ++i) in_scene[static_cast<size_t>(i)] = ijk[i] - Basis::reach;
    return in_scene;
  }

  /// The nodes of the scene's grid.
  std::vector<size_t> scene_nodes() const {
    std::vector<size_t> nodes;
    for (int node = 0; node < basis_.node_count(); ++node) {
      const auto ijk = ijk_in_scene(node);
      bool ghost = false;
      for (size_t i = 0; i < Dim; ++i) ghost = ghost || ijk[i] < 0 || ijk[i] > scene_.grid.cells[i];
      if (!ghost) nodes.push_back(static_cast<size_t>(node));
    }
    return nodes;
  }

  double time() const { return static_cast<double>(step_) * scene_.time.dt; }
  double load_time_at(long long step) const {
    return static_cast<double>(step - loads_begin_) * scene_.time.dt;
  }
  int id_of(int p) const { return ids_.empty() ? p : ids_[static_cast<size_t>(p)]; }

  void set_loads(double t) {
    loads_.set_time(scene_, t);
    loads_.balance(exec_, state_.particles, to_vector(placed_.position.front()));
  }

  template <class Work>
  auto with_field(const Work& work) const {
    return loads_.template with_field<Basis::reach == 0>(basis_.grid, state_.occupancy.cells, work);
  }

  void fill_particles() {
    const auto host = host_copy(block_);
    const auto& p = host.particles;
    for (size_t b = 0; b < scene_.bodies.size(); ++b) {
      const auto& body = scene_.bodies[b];
      const auto range = placed_.bodies[b];
      for (int n = range.first; n < range.last; ++n) {
        const auto i = static_cast<size_t>(n);
        const Point& x = placed_.position[i];
        const auto stress = body.stress.at(x);
        const auto velocity = body.velocity.at(x);
        for (size_t d = 0; d < Dim; ++d) {
          p.position(i, d) = static_cast<Real>(x[d]);
          p.velocity(i, d) = static_cast<Real>(velocity[d]);
        }
        for (size_t c = 0; c < SymmetricTensor<Dim, Real>::size; ++c)
          p.cauchy_stress(i, c) = static_cast<Real>(stress[c]);
        p.volume(i) = static_cast<Real>(placed_.volume[i]);
        p.mass(i) = static_cast<Real>(body.density * placed_.volume[i]);
      }
    }
    Kokkos::deep_copy(block_.block, host.block);
  }

  void make_bodies() {
    for (size_t b = 0; b < scene_.bodies.size(); ++b)
      bodies_.push_back(
          {placed_.bodies[b].first, placed_.bodies[b].last, material_of<Real>(scene_.bodies[b].material)});
    allocate_states();
  }

  /// Rows of material state for the particles of the bodies that need them, body after body.
  void allocate_states() {
    int rows = 0, columns = 0;
    for (auto& body : bodies_) {
      const int needed = state_size<Dim>(body.material);
      if (needed == 0) continue;
      body.state_offset = rows - body.first;
      rows += body.last - body.first;
      columns = std::max(columns, needed);
    }
    if (rows > 0) allocate_material_state(block_, rows, columns);
  }

  /// [6 per particle], zero where a body does not yield; empty where none does.
  std::vector<double> plastic_strain(const Particles<Dim, Real, Kokkos::HostSpace>& p) const {
    std::vector<double> strain;
    for (const auto& body : bodies_) {
      if (!is_plastic(body.material)) continue;
      strain.resize(6 * static_cast<size_t>(p.count()));
      for (int n = body.first; n < body.last; ++n)
        for (size_t c = 0; c < SymmetricTensor<Dim, Real>::size; ++c)
          strain[6 * static_cast<size_t>(n) + c] =
              p.material_state(static_cast<size_t>(n + body.state_offset), c);
    }
    return strain;
  }

  void fix_faces() {
    const auto mask = Kokkos::create_mirror_view(state_.nodes.fixed_components);
    for (int node = 0; node < basis_.node_count(); ++node) {
      const auto ijk = ijk_in_scene(node);
      ComponentMask fixed = 0;
      for (size_t i = 0; i < Dim; ++i) {
        const auto& faces = scene_.faces.fixed[i];
        if (ijk[i] == 0) fixed = static_cast<ComponentMask>(fixed | faces[0]);
        if (ijk[i] == scene_.grid.cells[i]) fixed = static_cast<ComponentMask>(fixed | faces[1]);
      }
      mask(node) = fixed;
    }
    Kokkos::deep_copy(state_.nodes.fixed_components, mask);
  }

  void declare_tractions() {
    const auto mask = Kokkos::create_mirror_view(state_.occupancy.tractions);
    for (int node = 0; node < basis_.node_count(); ++node) {
      mask(node) =
          tractions_at(scene_, loads_.on_nodes(), node_position(scene_.grid, Dim, ijk_in_scene(node)));
    }
    Kokkos::deep_copy(state_.occupancy.tractions, mask);
    state_.occupancy.conservative = loads_.conservative();
  }

  /// The cells of the scene's grid that hold particles.
  OccupiedCells occupied_cells() const {
    OccupiedCells cells;
    cells.cells = {1, 1, 1};
    size_t count = 1;
    for (size_t i = 0; i < Dim; ++i) {
      cells.cells[i] = scene_.grid.cells[i];
      count *= static_cast<size_t>(scene_.grid.cells[i]);
    }
    cells.occupied.resize(count);
    for (const Point& x : placed_.position) {
      const auto cell = basis_.grid.cell_containing(to_vector(x));
      int index = 0;
      for (int i = Dim - 1; i >= 0; --i)
        index = index * cells.cells[static_cast<size_t>(i)] + (cell[i] - Basis::reach);
      cells.occupied[static_cast<size_t>(index)] = true;
    }
    return cells;
  }

  /// The cells that hold particles, and the voids that the filter tells from the outside.
  OccupiedCells cells_inside() const {
    auto cells = occupied_cells();
    if (!scene_.method.void_filter) return cells;
    const auto outside = Kokkos::create_mirror_view_and_copy(
        Kokkos::HostSpace(), state_.occupancy.cells.outside, "vsb::outside on host");
    const auto& grid = basis_.grid;
    for (int n = 0; n < grid.cell_count(); ++n) {
      const auto ijk = grid.cell_ijk(n);
      int index = 0;
      bool in_scene = true;
      for (int i = Dim - 1; i >= 0; --i) {
        const int along = ijk[i] - Basis::reach, count = cells.cells[static_cast<size_t>(i)];
        in_scene = in_scene && along >= 0 && along < count;
        index = index * count + along;
      }
      const auto word = outside(static_cast<size_t>(n / grid.cells[0]), static_cast<size_t>(ijk[0] / 64));
      if (in_scene && (word >> (ijk[0] % 64) & 1u) == 0) cells.occupied[static_cast<size_t>(index)] = true;
    }
    return cells;
  }

  /// The points of the tractions that are not imposed through boundary nodes.
  void place_surface_points() {
    auto points = loaded_points(scene_, placed_);
    const auto conforming = conforming_points<Dim>(scene_, basis_.grid, occupied_cells().occupied);
    points.insert(points.end(), conforming.begin(), conforming.end());
    if (points.empty()) return;
    auto& s = state_.surface;
    s = allocate_surface_points<Dim, Real, Device>(static_cast<int>(points.size()), basis_.node_count(),
                                                   basis_.bin_count());
    const auto position = Kokkos::create_mirror_view(s.position), area = Kokkos::create_mirror_view(s.area);
    const auto tractions = Kokkos::create_mirror_view(s.tractions);
    const auto carrier = Kokkos::create_mirror_view(s.carrier);
    for (size_t b = 0; b < points.size(); ++b) {
      for (size_t i = 0; i < Dim; ++i) {
        position(b, i) = static_cast<Real>(points[b].position[i]);
        area(b, i) = static_cast<Real>(points[b].area[i]);
      }
      tractions(b) = points[b].tractions;
      carrier(b) = points[b].carrier;
      surface_tractions_ |= points[b].tractions;
    }
    Kokkos::deep_copy(s.position, position);
    Kokkos::deep_copy(s.area, area);
    Kokkos::deep_copy(s.tractions, tractions);
    Kokkos::deep_copy(s.carrier, carrier);
  }

  static Vector<Dim, Real> to_vector(const Point& x) {
    Vector<Dim, Real> v;
    for (int i = 0; i < Dim; ++i) v[i] = static_cast<Real>(x[static_cast<size_t>(i)]);
    return v;
  }

  /// Every traction must have boundary nodes or surface points, and the body must not touch an open face of
  /// the grid where one is declared: there are no void cells beyond a face, so part of the load would be
  /// missing without a word.
  void check_tractions() const {
    if (scene_.tractions.empty()) return;
    const auto boundary = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), state_.occupancy.boundary,
                                                              "vsb::boundary on host");
    const auto declared = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), state_.occupancy.tractions,
                                                              "vsb::declared on host");
    TractionMask acting = surface_tractions_;
    for (size_t node = 0; node < boundary.extent(0); ++node) acting |= boundary(node);
    for (size_t k = 0; k < scene_.tractions.size(); ++k) {
      if (acting >> k & 1u) continue;
      if (!(loads_.on_nodes() >> k & 1u))
        throw SetupError(fmt::format(
            "traction '{}' finds no surface of a body{}, so it would load nothing: check its 'surface'",
            scene_.tractions[k].name,
            scene_.tractions[k].imposition == Imposition::nodal ? " that follows faces of cells" : ""));
      throw SetupError(fmt::format(
          "traction '{}' finds no boundary node, so it would load nothing. A boundary node "
          "belongs to a cell without "
          "particles or to one that touches such a cell; leave at least one empty cell beyond "
          "the loaded boundary "
          "(a smaller grid spacing, or a larger grid), or set method.fill_criterion, and check the "
          "traction's 'surface'",
          scene_.tractions[k].name));
    }
    for (size_t p = 0; p < placed_.position.size(); ++p) {
      const auto shape = basis_.shape(to_vector(placed_.position[p]));
      for (int a = 0; a < Basis::support; ++a) {
        const auto ijk = basis_.grid.node_ijk(shape.node[a]);
        if ((declared(static_cast<size_t>(shape.node[a])) & ~loads_.conservative()) == 0) continue;
        for (int i = 0; i < Dim; ++i) {
          const auto& faces = scene_.faces.fixed[static_cast<size_t>(i)];
          const bool lower = ijk[i] == 0 && faces[0] == 0,
                     upper = ijk[i] == basis_.grid.cells[i] && faces[1] == 0;
          if (lower || upper)
            throw SetupError(fmt::format(
                "a body reaches the open face {}_{} of the grid, where a traction is declared: leave at "
                "least one empty "
                "cell between them, or give the face a condition, or the traction another 'surface'",
                scene_.grid.axis_name(static_cast<size_t>(i)), lower ? "min" : "max"));
        }
      }
    }
  }

  static void refuse_unsupported(const UnsupportedLoad<Dim>& load) {
    if (!load.found) return;
    const auto list = [](const auto& vector) {
      std::string text;
      for (int i = 0; i < vector.size; ++i) text += fmt::format("{}{:.4g}", i == 0 ? "" : ", ", vector[i]);
      return text;
    };
    throw SetupError(fmt::format(
        "--static: no support takes up a force of ({}) N{} on the body around ({}) m, {:.2g} of its nodal "
        "forces, so there is no static state: hold the body at a face of the grid ('faces'), or balance its "
        "loads",
        list(load.force), Dim > 1 ? fmt::format(" and a torque of ({}) N m", list(load.torque)) : "",
        list(load.middle), load.share));
  }

  void locate() {
    const int lost = update_occupancy(exec_, state_.particles, state_.occupancy, basis_);
    if (lost >= 0) throw_lost(lost);
  }

  [[noreturn]] void throw_lost(int particle) const {
    check_health();
    if (particle >= particle_count())
      throw Diverged(
          fmt::format("at step {}, time {:.6g} s: position of surface point {} is outside the grid", step_,
                      time(), particle - particle_count()));
    const auto host = host_copy(block_);
    std::string where;
    for (int i = 0; i < Dim; ++i)
      where += fmt::format("{}{:.6g}", i == 0 ? "" : ", ",
                           host.particles.position(static_cast<size_t>(particle), static_cast<size_t>(i)));
    throw Diverged(
        fmt::format("at step {}, time {:.6g} s: position of particle {}, ({}) m, is outside the grid", step_,
                    time(), id_of(particle), where));
  }

  Scene scene_;
  PlacedParticles placed_;
  ExecutionSpace exec_;
  OwnedBasis<Basis> owned_basis_;
  Basis basis_;
  Loads<Dim, Real> loads_;
  std::vector<Resultant> resultants_;  ///< of each traction at full load
  TractionMask surface_tractions_ = 0;
  int placed_count_ = 0;  ///< particles at the start
  ParticleBlock<Dim, Real, Device> block_;
  State<Dim, Real, Device> state_;
  std::vector<Body<Real>> bodies_;
  StepOptions<Dim, Real> options_{};
  long long step_ = 0, loads_begin_ = 0;
  std::vector<int> ids_;  ///< of the particles that are left; empty before a removal
  std::string particle_kernels_because_;
  std::unique_ptr<Engine> lanes_;
  mutable bool packed_ = false;  ///< whether the particles moved on in lanes_ alone
};

}  // namespace vsb::app
