// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The simulation of a scene in a given dimension, precision and basis, on the backend of this build.
///
/// The particles are in one of two places. At first, and where particle kernels make the steps, they are in
/// `memory_`. Where cell lanes do, these take them over with the first step, and memory_ is gone; what needs
/// all fields of all particles again brings it back for a while.
#pragma once

#include <fmt/format.h>

#include <map>
#include <optional>
#include <vsb/kernels/boundary/flag_boundary_particles.hpp>
#include <vsb/kernels/readout/balance.hpp>
#include <vsb/kernels/readout/health.hpp>
#include <vsb/kernels/readout/loaded_cells.hpp>
#include <vsb/kernels/readout/plastic_strain.hpp>
#include <vsb/kernels/readout/smooth_particles.hpp>
#include "engine/block_fields.hpp"
#include "engine/keep_particles.hpp"
#include "engine/lane_engine.hpp"
#include "engine/no_lanes.hpp"
#include "engine/read_nodes.hpp"
#include "engine/saved_block.hpp"
#include "engine/simulation.hpp"
#include "engine/solve_static.hpp"
#include "setup/basis_of.hpp"
#include "setup/check_tractions.hpp"
#include "setup/grid_lines.hpp"
#include "setup/set_up_nodes.hpp"
#include "setup/set_up_particles.hpp"
#include "setup/set_up_surface.hpp"
#include "setup/step_options.hpp"
#include "setup/void_seeds.hpp"

namespace vsb::app {

template <int Dim, class Real, class Basis>
class SimulationOf final : public Simulation {
 public:
  SimulationOf(const Scene& scene, PlacedParticles* taken)
      : scene_(scene),
        origin_(local_origin(scene)),
        owned_basis_(scene, origin_),
        basis_(owned_basis_.basis),
        on_host_(basis_on_host(scene, origin_, owned_basis_)),
        loads_(scene, origin_) {
    const auto placed = taken ? std::move(*taken) : place_particles(scene_);
    if (!scene.grid.mapped() && Basis::reach == 0) refuse_on_grid_lines(scene_, placed);
    placed_count_ = static_cast<int>(placed.position.size());
    starts_ = placed.starts;
    volumes_ = vsb::app::body_volumes(scene_, placed);
    cut_ = placed.cut;
    moment_fit_ = placed.moment_fit;
    near_ = to_local<Vector<Dim, Real>>(placed.position.front(), origin_);
    at_start_ = mass_centre(scene_, placed);
    bodies_ = bodies_of<Dim, Real>(scene_, placed);
    declared_ = declared_tractions<Device>(scene_, basis_, loads_.on_nodes() & ~carried_tractions(scene_));
    carried_ = carried_by_particles(scene_, placed);
    covers_ = placed.covers;
    cover_ = cover_view();
    const auto surface = place_surface_points<Real, Device>(scene_, on_host_.basis, placed);
    surface_ = surface.points;
    resultants_ = exact_resultants(scene_, at_start_.position);
    options_ = step_options<Dim, Real>(scene_);

    particle_kernels_because_ = reason_for_particle_kernels(scene_);
    refuse_unresolved_places(scene_, particle_kernels_because_.empty());
    memory_ = allocate_memory();
    fill_particles(scene_, placed, ids_, bodies_, memory_->block);
    auto& occupancy = memory_->state.occupancy;
    if (scene.method.fill_criterion > 0) set_fill_criterion(occupancy, scene.method.fill_criterion);
    if (scene.method.void_filter) {
      set_void_filter(occupancy, basis_);
      remove_body_cells<Device>(scene_, on_host_.basis.grid, occupancy.cells.outside);
    }
    locate();
    check_tractions(scene_, on_host_.basis, occupancy, loads_, surface.tractions, carried_, placed);
    auto inside = occupied_cells(scene_, on_host_.basis, placed);
    if (scene.method.void_filter) add_voids<Device>(scene_, on_host_.basis, occupancy.cells.outside, inside);
    advice_ = field_advice(scene_, placed, inside);
  }

  int particle_count() const override { return bodies_.back().last; }
  long long step() const override { return step_; }
  double time() const override { return static_cast<double>(step_) * scene_.time.dt; }
  double load_time() const override { return load_time_at(step_); }
  int boundary_nodes() const override {
    return lanes_ ? lanes_->boundary_nodes() : memory_->state.occupancy.boundary_node_count;
  }
  std::string particle_kernels_because() const override { return particle_kernels_because_; }

  CutVolume cut_volume() const override { return cut_; }
  const std::vector<BodyVolume>& body_volumes() const override { return volumes_; }
  MomentFit moment_fit() const override { return moment_fit_; }
  VoidFilterReport void_filter() const override {
    if (!scene_.method.void_filter) return {};
    const auto& o = memory_->state.occupancy;
    const auto effect = void_filter_effect(exec_, memory_->state.particles, o.cells, basis_, o.tractions,
                                           o.boundary_node_count, o.conservative);
    return {effect.false_voids, effect.dropped_nodes};
  }
  std::vector<std::string> advice() const override { return advice_; }
  OutflowReport outflow() const override {
    auto report = outflow_;
    report.mass_at_start = at_start_.mass;
    if (report.particles == 0) return report;
    std::vector<bool> gone(static_cast<size_t>(placed_count_), true);
    for (int p = 0; p < particle_count(); ++p)
      if (!all_gone_) gone[static_cast<size_t>(id_of(p))] = false;
    const auto placed = place_particles(scene_);
    for (size_t b = 0; b < scene_.bodies.size(); ++b)
      for (auto id = static_cast<size_t>(placed.bodies[b].first);
           id < static_cast<size_t>(placed.bodies[b].last); ++id)
        if (gone[id]) report.mass_gone += scene_.bodies[b].density * placed.volume[id];
    return report;
  }

  size_t state_bytes() const override {
    const auto bytes = [](const auto&... views) { return (... + (views.span() * sizeof(*views.data()))); };
    size_t sum = owned_basis_.bytes() + bytes(declared_) + (lanes_ ? lanes_->bytes() : 0);
    if (!memory_) return sum;
    const auto& [block, state] = *memory_;
    const auto& o = state.occupancy;
    const auto& n = state.nodes;
    const auto particles = static_cast<size_t>(block.particles.count() * block.columns()) * sizeof(Real);
    return sum + particles +
           bytes(block.state_block, n.sums, n.acceleration, n.velocity, n.remapped_velocity,
                 n.fixed_components, o.bins.bin, o.bins.order, o.bins.offset, o.bins.cursor, o.bins.slot,
                 o.bins.occupied, o.cells.occupied, o.cells.exterior, o.cells.boundary, o.cells.underfilled,
                 o.cells.outside, o.cells.carried.particle, o.cells.carried.cells, o.cells.carried.nodes,
                 o.boundary, state.sums_workspace.particles.bin_sums, state.remap_workspace.bin_sums,
                 state.mean_divergence.of_particle, state.mean_divergence.of_function,
                 state.mean_divergence.sums, state.mean_divergence.workspace.bin_sums);
  }

  void advance(long long steps) override {
    if constexpr (has_lanes)
      if (particle_kernels_because_.empty()) return advance_lanes(steps);
    for (long long n = 0; n < steps;) {
      set_loads(load_time_at(step_ + 1));
      const int lost = with_field([&](const auto& field) {
        return vsb::step(exec_, memory_->state, bodies_, basis_, field, options_);
      });
      if (lost >= 0) {  // the step is not made; those that are left make it
        take_leave(lost);
        continue;
      }
      ++step_;
      ++n;
    }
    if (scene_.faces.any_outflow()) locate();  // whoever looks at the particles finds none outside
    exec_.fence();
  }

  StaticSolution solve_static(double t, const std::function<bool(int, double)>& go_on) override {
    set_loads(t);
    locate();
    auto& state = memory_->state;
    const auto found = vsb::app::solve_static(
        exec_, scene_, state, bodies_, basis_, options_, [&](const auto& work) { return with_field(work); },
        go_on);
    if (found.lost >= 0) take_leave(particle_count() + found.lost);
    StaticSolution solution;
    solution.iterations = found.result.iterations;
    solution.residual = found.result.residual;
    solution.converged = found.result.converged;
    if (!solution.converged) return solution;
    solution.largest_strain = found.largest_strain;
    solution.balance = balance_under_loads_at(t);
    displace_particles(exec_, state.particles, basis_, found.displacement);
    exec_.fence();
    return solution;
  }

  std::string unsupported_load(double t) override {
    set_loads(t);
    const Loan loan(*this);
    locate();
    auto& state = memory_->state;
    const int lost = with_field([&](const auto& field) {
      return assemble_forces(exec_, state.particles, state.occupancy, state.surface, state.nodes,
                             state.sums_workspace, basis_, field, options_.gravity, options_.scatter);
    });
    if (lost >= 0) take_leave(particle_count() + lost);
    constexpr double tolerance = 1e-3;  // what meshes and lattices leave of loads that are in balance
    return text(scene_, find_unsupported_load(exec_, state.nodes, state.occupancy.bins, basis_, tolerance));
  }

  void check_health() override {
    throw_spoilt(lanes_ ? lanes_->find_invalid() : find_invalid(exec_, memory_->state.particles));
  }

  BalanceReport balance() override { return balance_under_loads_at(load_time()); }
  BalanceReport balance_under_loads_at(double t) override {
    set_loads(t);
    const auto b = lanes_ && Engine::on_cells && lanes_->loaded_by_sweeps() ? lanes_->balance(loads_)
                                                                            : balance_of_memory();
    BalanceReport report;
    report.force_ratio = b.force_ratio();
    report.energy_ratio = b.strain_energy > 0 ? b.kinetic_energy / b.strain_energy : 1.0;
    for (int i = 0; i < Dim; ++i) report.net_force[static_cast<size_t>(i)] = b.net_force[i];
    report.torque_about = at_start_.position;
    Point arm;  // to there from the local origin, about which the kernels' torque is
    for (size_t i = 0; i < 3; ++i) arm[i] = at_start_.position[i] - origin_[i];
    for (size_t i = 0; i < 3; ++i) {
      const size_t j = (i + 1) % 3, l = (i + 2) % 3;
      report.net_torque[i] =
          b.net_torque[static_cast<int>(i)] - (arm[j] * report.net_force[l] - arm[l] * report.net_force[j]);
      for (size_t k = 0; k < scene_.tractions.size(); ++k) {
        const double factor = scene_.tractions[k].time(t);
        report.exact_force[i] += factor * resultants_[k].force[i];
        report.exact_torque[i] += factor * resultants_[k].torque[i];
      }
    }
    return report;
  }

  std::vector<TractionState> traction_states() override {
    std::vector<TractionState> states;
    for (size_t k = 0; k < scene_.tractions.size(); ++k)
      if ((loads_.on_nodes() & ~loads_.conservative()) >> k & 1u) {
        states.emplace_back();
        states.back().traction = k;
        states.back().load = resultants_[k].load;
        states.back().exact_force = resultants_[k].force;
      }
    if (states.empty()) return states;
    loads_.set_full(scene_);
    const bool in_lanes = lanes_ && lanes_->loaded_by_sweeps();
    std::optional<Loan> loan;
    if (!in_lanes) {
      loan.emplace(*this);
      loads_.balance(exec_, memory_->state.particles, near_);
      locate();
    }
    for (auto& state : states) {
      const TractionMask mask = TractionMask(1) << state.traction;
      TractionResultant<Dim> r;
      LoadedCells cells;
      if (in_lanes) {
        r = lanes_->resultant(loads_, mask);
        cells = lanes_->loaded_cells(mask);
      } else {
        const auto& s = memory_->state;
        r = with_field(
            [&](const auto& field) { return vsb::resultant(exec_, s, basis_, field, mask, cover_); });
        cells = count_loaded_cells(exec_, s.occupancy, basis_, mask);
      }
      for (int i = 0; i < Dim; ++i) state.force[static_cast<size_t>(i)] = r.force[i];
      state.whole_cells = cells.whole;
      state.part_cells = cells.part;
    }
    return states;
  }

  std::unique_ptr<ParticleReader> read_particles() override {
    std::unique_ptr<FieldSource> fields;
    if (lanes_ && Engine::on_cells)
      fields = lanes_->fields();
    else
      fields = std::make_unique<LentFields>(*this);
    std::vector<PlacedBody> bodies;
    for (const auto& body : bodies_) bodies.push_back({body.first, body.last});
    auto reader = std::make_unique<SceneReader>(scene_, starts_, ids_, std::move(bodies), std::move(fields));
    reader->outside = outside_;
    reader->step = step_;
    reader->time = time();
    reader->count = static_cast<size_t>(particle_count());
    for (const auto& body : bodies_) reader->plastic = reader->plastic || is_plastic(body.material);
    return reader;
  }

  std::vector<double> equivalent_plastic_strain(bool smoothed) override {
    const Kokkos::View<Real*, Device> strain("vsb::plastic_strain", static_cast<size_t>(particle_count()));
    for (const auto& body : bodies_) {
      if (!is_plastic(body.material)) continue;
      if (lanes_) {
        lanes_->equivalent_plastic_strain(strain);  // of all bodies: they have one material
        break;
      }
      vsb::equivalent_plastic_strain(exec_, memory_->state.particles, body.first, body.last,
                                     body.state_offset, strain);
    }
    if (smoothed) smooth(strain);
    exec_.fence();
    const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), strain);
    return std::vector<double>(host.data(), host.data() + host.extent(0));
  }

  double yielded_volume() override {
    const auto strain = equivalent_plastic_strain(false);
    double sum = 0;
    read_particles()->for_each_range(field::volume, [&](const Snapshot& s) {
      for (size_t p = 0; p < s.count(); ++p)
        if (strain[s.first + p] > 0) sum += s.volume[p];
    });
    return sum;
  }

  std::vector<CellContent> cell_contents(const std::vector<unsigned char>& marked) override {
    std::vector<int> surplus(scene_cell_count(scene_), 0);  // of marked particles
    std::vector<CellContent> contents(surplus.size(), CellContent::nothing);
    const auto count = [&](int p, const Vector<Dim, int>& cell) {
      const size_t c = scene_cell(scene_, on_host_.basis, cell);
      surplus[c] += marked[static_cast<size_t>(p)] != 0 ? 1 : -1;
      contents[c] = CellContent::particles;
    };
    if (lanes_ && Engine::on_cells) {
      lanes_->for_each_cell(count);
    } else {
      const Loan loan(*this);
      const auto host = host_copy(memory_->block);
      for (int p = 0; p < particle_count(); ++p)
        count(p, on_host_.basis.grid.cell_containing(host.particles.position_of(p)));
    }
    for (size_t c = 0; c < contents.size(); ++c)
      if (contents[c] != CellContent::nothing && surplus[c] >= 0) contents[c] = CellContent::marked;
    return contents;
  }

  void remove(const std::vector<unsigned char>& removed, const Restart& restart) override {
    const bool anew = lanes_ && restart.reset;  // nothing of the present state will be left
    if (!anew) to_memory();
    lanes_.reset();
    keep(removed, anew);
    if (restart.damping) options_.damping = static_cast<Real>(*restart.damping);
    if (restart.reset) {
      if (anew) memory_ = allocate_memory();
      const auto placed = place_particles(scene_);
      fill_particles(scene_, placed, ids_, bodies_, memory_->block);
      if (memory_->block.state_block.size() > 0) Kokkos::deep_copy(memory_->block.state_block, Real(0));
      loads_begin_ = step_;
    }
    locate();
  }

  GridSnapshot grid_snapshot() override {
    // The nodes of the state as it is, however the steps before it were made.
    const Loan loan(*this);
    set_loads(load_time());
    balance_of_memory();
    const auto& state = memory_->state;
    update_nodes(exec_, state.nodes, basis_, options_.damping, options_.dt);
    exec_.fence();
    return read_nodes(scene_, basis_, state.nodes, state.occupancy.boundary);
  }

  SavedState saved_state() const override { return {step_, sizeof(Real), staged_state()}; }

  void save_particles(ByteSink& to) override {
    if constexpr (has_lanes)
      if (particle_kernels_because_.empty()) {
        pack();
        return lanes_->save(to);
      }
    save_block(memory_->block, memory_->state, to);
  }

  void restore(const SavedState& saved, ByteSource& particles) override {
    restore_staged(saved.staged);
    bool fits = saved.bytes_per_number == sizeof(Real);
    if (has_lanes && particle_kernels_because_.empty()) {
      if constexpr (has_lanes) {
        memory_.reset();
        lanes_ = make_lanes();
        fits = fits && lanes_->restore(particles);
      }
    } else {
      fits = fits && restore_block(particles, memory_->block, memory_->state);
    }
    if (!fits)
      throw SetupError("the checkpoint belongs to another scene: its particles do not fit this one's");
    step_ = saved.step;
    if (!lanes_ && update_occupancy(exec_, memory_->state.particles, memory_->state.occupancy, basis_) >= 0)
      throw SetupError("the checkpoint belongs to another scene: it has particles outside this one's grid");
  }

 private:
  using Device = ExecutionSpace::device_type;
  static_assert(max_tractions == UniformVirtualStress<Dim, Real>::capacity,
                "a scene may declare as many tractions as the kernels can take");
  static constexpr bool has_splines = std::is_same_v<Basis, QuadraticBSplineBasis<Dim, Real>>,
                        has_lanes =
                            runs_on_host && (has_splines || std::is_same_v<Basis, LinearBasis<Dim, Real>>);
  using Engine =
      std::conditional_t<!has_lanes, NoLanes<Dim, Real>,
                         LaneEngine<Dim, Real,
                                    std::conditional_t<has_splines, SplineLaneState<Dim, Real, Device>,
                                                       LaneState<Dim, Real, Device>>>>;

  /// The particles as the particle kernels take them, and what these work on.
  struct Memory {
    ParticleBlock<Dim, Real, Device> block;
    State<Dim, Real, Device> state;
  };
  /// Where lanes hold the particles, what is brought back of them goes when the loan ends.
  struct Loan {
    explicit Loan(SimulationOf& of) : simulation(of), brought_back(!of.memory_) { of.bring_back(); }
    ~Loan() {
      if (brought_back) simulation.memory_.reset();
    }
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;
    SimulationOf& simulation;
    bool brought_back;
  };

  /// The fields of particles that are lent for as long.
  struct LentFields final : FieldSource {
    explicit LentFields(SimulationOf& of)
        : loan(of),
          fields(of.exec_, of.memory_->state.particles, of.bodies_, [&of] { return of.boundary_flags(); }) {}
    void read(unsigned field, size_t first, std::vector<double>& to) override {
      fields.read(field, first, to);
    }
    void read_flags(size_t first, std::vector<unsigned char>& to) override { fields.read_flags(first, to); }
    Loan loan;
    BlockFields<Dim, Real> fields;
  };

  /// Of the particles there are, all at zero.
  std::unique_ptr<Memory> allocate_memory() const {
    auto memory = std::make_unique<Memory>();
    memory->block =
        allocate_bodies<Dim, Real, Device>(bodies_, has_lanes && particle_kernels_because_.empty());
    auto& state = memory->state;
    state = make_state(memory->block.particles, basis_);
    state.loads_found = true;  // a resumed load may have left its region
    fix_faces(scene_, basis_, state.nodes.fixed_components);
    state.occupancy.tractions = declared_;
    state.occupancy.conservative = loads_.conservative();
    if (!carried_.empty())
      set_carried_tractions(state.occupancy, basis_, carried_view(), carried_tractions(scene_));
    state.surface = surface_;
    if (surface_.count() > 0) Kokkos::deep_copy(surface_.bins.bin, -1);  // to be sorted anew
    return memory;
  }
  /// What the particles there are carry.
  Kokkos::View<TractionMask*, Device> carried_view() const {
    const auto count = carried_.empty() ? 0 : static_cast<size_t>(particle_count());
    const Kokkos::View<TractionMask*, Device> view("vsb::carried_tractions", count);
    const auto host = Kokkos::create_mirror_view(view);
    for (size_t p = 0; p < count; ++p) host(p) = carried_[static_cast<size_t>(id_of(static_cast<int>(p)))];
    Kokkos::deep_copy(view, host);
    return view;
  }
  /// What the particles there cover of the faces of the grid.
  FaceCover<Device> cover_view() const {
    if (covers_.empty()) return {};
    const Kokkos::View<float**, Device> view("vsb::face_cover", static_cast<size_t>(particle_count()), Dim);
    const auto host = Kokkos::create_mirror_view(view);
    Kokkos::deep_copy(host, -1.0f);
    auto next = covers_.begin();  // in order of the particles, as ids are
    for (int p = 0; p < particle_count(); ++p) {
      while (next != covers_.end() && next->particle < id_of(p)) ++next;
      for (; next != covers_.end() && next->particle == id_of(p); ++next)
        host(static_cast<size_t>(p), next->axis) = static_cast<float>(next->cover);
    }
    Kokkos::deep_copy(view, host);
    return view;
  }
  void bring_back() {
    if (memory_) return;
    memory_ = allocate_memory();
    lanes_->unpack(memory_->block.particles, surface_);
  }

  void to_memory() {
    bring_back();
    lanes_.reset();
  }

  std::unique_ptr<Engine> make_lanes() const {
    typename Engine::Setup setup;
    setup.grid = uniform_grid<Dim, Real>(scene_.grid, origin_);
    setup.walls = walls<Dim>(scene_.faces);
    setup.tractions = declared_;
    setup.carried.particle = carried_view();
    setup.carried.tractions = carried_tractions(scene_);
    setup.cover = cover_;
    setup.conservative = loads_.conservative();
    setup.original = loads_.original();
    setup.gauss_points = loads_.gauss_points();
    setup.material = bodies_.front().material;
    setup.state_size = state_size<Dim>(setup.material);
    setup.particles = particle_count();
    setup.options = options_;
    return std::make_unique<Engine>(setup, surface_);
  }
  /// Hands the particles over to cell lanes.
  void pack() {
    if (lanes_) return;
    auto lanes = make_lanes();
    auto block = std::move(memory_->block);
    memory_.reset();
    lanes->pack(std::move(block));
    lanes_ = std::move(lanes);
  }
  void advance_lanes(long long steps) {
    for (long long n = 0; n < steps; ++n) {
      prepare_lanes();
      set_loads(load_time_at(step_ + 2));
      const int lost = lanes_->step(loads_);
      ++step_;
      if (lost >= 0) take_leave(lost);
    }
    pack();
    exec_.fence();
  }
  void prepare_lanes() {
    pack();
    if (lanes_->prepared()) return;
    set_loads(load_time_at(step_ + 1));
    const int lost = lanes_->prepare(loads_);
    if (lost >= 0) take_leave(lost);
  }

  /// Takes particles out of everything that counts them; `all_anew`: but for memory_, which goes.
  void keep(const std::vector<unsigned char>& removed, bool all_anew) {
    const auto kept = keep_in_bodies<Dim>(bodies_, removed);
    std::vector<int> ids;
    for (const int p : kept.particles) ids.push_back(id_of(p));
    const bool first_goes = ids.front() != id_of(0);
    ids_ = std::move(ids);
    cover_ = cover_view();
    int id = 0;
    if (first_goes)
      for_each_start(scene_, starts_, [&](const Point& x) {
        if (id++ == ids_.front()) near_ = to_local<Vector<Dim, Real>>(x, origin_);
      });
    if (all_anew) {
      memory_.reset();
      return;
    }
    auto& [block, state] = *memory_;
    block = keep_in_block(exec_, block, kept);
    state.particles = block.particles;
    state.occupancy.bins = allocate_bins<Device>(particle_count(), basis_.bin_count());
    state.occupancy.cells.carried.particle = carried_view();
  }

  /// The particles that are left, of all there were at the start.
  StagedState staged_state() const {
    if (!may_lose_particles(scene_)) return {};
    StagedState staged;
    staged.outflow = outflow_.numbers();
    staged.loads_begin = loads_begin_;
    staged.present.assign(static_cast<size_t>(placed_count_), ids_.empty() ? 1 : 0);
    for (const int id : ids_) staged.present[static_cast<size_t>(id)] = 1;
    return staged;
  }
  void restore_staged(const StagedState& staged) {
    if (!may_lose_particles(scene_)) return;
    if (staged.present.size() != static_cast<size_t>(placed_count_) || !ids_.empty())
      throw SetupError("the checkpoint belongs to another scene: it has other particles");
    std::vector<unsigned char> removed(staged.present);
    for (auto& flag : removed) flag = flag == 0;
    Restart restart;
    if (scene_.removal && !scene_.removal->reset) restart.damping = scene_.removal->damping;
    if (std::find(removed.begin(), removed.end(), 1) != removed.end()) remove(removed, restart);
    loads_begin_ = staged.loads_begin;
    outflow_ = OutflowReport::from_numbers(staged.outflow);
  }

  double load_time_at(long long step) const {
    return static_cast<double>(step - loads_begin_) * scene_.time.dt;
  }
  int id_of(int p) const { return ids_.empty() ? p : ids_[static_cast<size_t>(p)]; }

  void set_loads(double t) {
    loads_.set_time(scene_, t);
    if (!lanes_) loads_.balance(exec_, memory_->state.particles, near_);
  }

  template <class Work>
  auto with_field(const Work& work) const {
    return loads_.template with_field<Basis::reach == 0>(basis_.grid, memory_->state.occupancy.cells, work);
  }

  /// Under the loads of loads_, with the particle kernels.
  Balance<Dim> balance_of_memory() {
    const Loan loan(*this);
    locate();
    return with_field([&](const auto& field) {
      return vsb::balance(exec_, memory_->state, bodies_, basis_, field, options_, cover_);
    });
  }

  /// Smooths a number of the particles over the nodes.
  void smooth(const Kokkos::View<Real*, Device>& q) {
    const auto over_nodes = [&](const auto& particles, const auto& bins) {
      smooth_particles(exec_, particles, bins, basis_, q, options_.scatter);
    };
    if (!lanes_) {
      locate();
      return over_nodes(memory_->state.particles, memory_->state.occupancy.bins);
    }
    const auto points = lanes_->mass_points();
    auto bins = allocate_bins<Device>(particle_count(), basis_.bin_count());
    const auto where = locate_particles(exec_, points, bins, basis_);
    if (where.lost >= 0) take_leave(where.lost);
    sort_by_bin(exec_, bins);
    over_nodes(points, bins);
  }

  /// Which particles are near a node with a traction.
  Flags boundary_flags() {
    locate();
    const auto& state = memory_->state;
    const Flags flags("vsb::boundary_particles", static_cast<size_t>(particle_count()));
    flag_boundary_particles(exec_, state.particles, state.occupancy.boundary, basis_, flags);
    exec_.fence();
    return flags;
  }

  void locate() {
    for (int lost = 0; lost >= 0;) {
      lost = update_occupancy(exec_, memory_->state.particles, memory_->state.occupancy, basis_);
      if (lost >= 0) take_leave(lost);
    }
  }

  void throw_spoilt(const Invalid& bad) const {
    if (bad.particle < 0) return;
    static const char* names[] = {"position", "velocity", "cauchy_stress", "volume"};
    static const char* faults[] = {"is not finite", "is not finite", "is not finite",
                                   "is not positive (J <= 0)"};
    const auto f = static_cast<size_t>(bad.field);
    throw Diverged(fmt::format("at step {}, time {:.6g} s: {} of particle {} {}", step_, time(), names[f],
                               id_of(bad.particle), faults[f]));
  }

  /// Particles are outside the grid, `lost` among them, or a surface point is (lost >= particle_count()).
  /// Where the faces let them go, they are removed; else throws.
  void take_leave(int lost) {
    const bool from_lanes = lanes_ != nullptr;  // to which round-off at a face may be outside, or not
    to_memory();                                // those that found no place in the lanes are among them
    auto& state = memory_->state;
    throw_spoilt(find_invalid(exec_, state.particles));
    const auto host = host_copy(memory_->block);
    refuse_unstable(host.particles);
    std::vector<unsigned char> leaves(static_cast<size_t>(particle_count()), 0);
    std::map<int, Point> outside;
    bool let_go = lost < particle_count();
    OutflowReport gone = outflow_;
    for (int p = 0; p < particle_count(); ++p) {
      const auto x = host.particles.position_of(p);
      if (on_host_.basis.contains(x) && (p != lost || from_lanes)) continue;
      outside[p] = to_scene(x, origin_);
      leaves[static_cast<size_t>(p)] = 1;
      const auto open = outflow_face(outside[p]);
      let_go = let_go && open;
      if (open) gone.add(step_, *open);
    }
    const bool all = let_go && static_cast<int>(outside.size()) == particle_count();
    if (let_go) outflow_ = gone;
    if (let_go && !all) return keep(leaves, false);
    const auto what =
        all ? fmt::format("at step {}, time {:.6g} s: the last particles left the grid", step_, time())
            : leave_text(lost, outside, host.particles);
    stand_in_grid(outside, host);
    all_gone_ = all;
    throw LeftGrid(what, all);
  }

  /// The face that lets a particle at x outside the grid go.
  std::optional<GridFace> outflow_face(const Point& x) const {
    for (const auto& face : faces_passed(scene_, x))
      if (scene_.faces.outflow[face.axis][face.side]) return face;
    return {};
  }

  /// Throws Diverged where a particle has what only an unstable step gives.
  template <class HostParticles>
  void refuse_unstable(const HostParticles& particles) const {
    for (size_t b = 0; b < bodies_.size(); ++b) {
      const double modulus =
          std::visit([](const auto& m) { return double(m.constrained_modulus()); }, bodies_[b].material);
      const double wave_speed = std::sqrt(modulus / scene_.bodies[b].density);
      for (int p = bodies_[b].first; p < bodies_[b].last; ++p) {
        const double speed = speed_of(particles, p);
        double stress = 0;
        const auto sigma = particles.stress_of(p);
        for (int c = 0; c < sigma.size; ++c)
          stress = std::max(stress, std::abs(static_cast<double>(sigma[c])));
        if (looks_unstable(speed, wave_speed, stress, modulus))
          throw Diverged(
              fmt::format("at step {}, time {:.6g} s: particles leave the grid, and particle {} moves at "
                          "{:.3g} of the wave "
                          "speed under {:.3g} of its modulus",
                          step_, time(), id_of(p), speed / wave_speed, stress / modulus));
      }
    }
  }
  template <class HostParticles>
  static double speed_of(const HostParticles& particles, int p) {
    const auto v = particles.velocity_of(p);
    double square = 0;
    for (int i = 0; i < Dim; ++i) square += static_cast<double>(v[i]) * static_cast<double>(v[i]);
    return std::sqrt(square);
  }

  template <class HostParticles>
  std::string leave_text(int lost, const std::map<int, Point>& outside,
                         const HostParticles& particles) const {
    const auto when = fmt::format("at step {}, time {:.6g} s: ", step_, time());
    if (lost >= particle_count())
      return when + fmt::format("surface point {}, which carries a traction, left the grid",
                                lost - particle_count());
    const auto held = [&](const GridFace& face) { return scene_.faces.fixed[face.axis][face.side] != 0; };
    int p = outside.begin()->first;  // the first that nothing lets go
    for (const auto& [other, x] : outside)
      if (!outflow_face(x)) {
        p = other;
        break;
      }
    const Point& x = outside.at(p);
    const auto face = faces_passed(scene_, x).front();
    const auto name = face_name(scene_, face);
    return when +
           fmt::format(
               "particle {} left the grid at the {} face {}, at {}, moving at {:.3g} m/s{}; {}", id_of(p),
               held(face) ? "held" : "open", name, place_text(scene_, x), speed_of(particles, p),
               outside.size() > 1 ? fmt::format(", and {} others in this step", outside.size() - 1) : "",
               held(face) ? "a shorter time step may keep it inside"
                          : fmt::format("make the grid larger, or let such particles go: faces.{} = "
                                        "\"outflow\"",
                                        name));
  }

  /// For reading: particles and surface points outside go to a place in the grid.
  template <class HostBlock>
  void stand_in_grid(const std::map<int, Point>& outside, const HostBlock& host) {
    const auto place = [&](const auto& position, int n, const Point& x) {
      const auto inside = to_local<Vector<Dim, Real>>(place_inside(scene_, x), origin_);
      for (int i = 0; i < Dim; ++i) position(static_cast<size_t>(n), static_cast<size_t>(i)) = inside[i];
    };
    for (const auto& [p, x] : outside) place(host.particles.position, p, x);
    copy_to_device(host, memory_->block);
    outside_ = outside;
    for (auto& [p, x] : outside_)
      for (size_t i = 0; i < 3; ++i) x[i] -= origin_[i];
    const auto& points = memory_->state.surface;
    if (points.count() == 0) return;
    const auto on_host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), points.position);
    for (int b = 0; b < points.count(); ++b) {
      Vector<Dim, Real> x;
      for (int i = 0; i < Dim; ++i) x[i] = on_host(static_cast<size_t>(b), static_cast<size_t>(i));
      if (!on_host_.basis.contains(x)) place(on_host, b, to_scene(x, origin_));
    }
    Kokkos::deep_copy(points.position, on_host);
  }

  Scene scene_;
  Point origin_;  ///< from where places are counted
  ExecutionSpace exec_;
  OwnedBasis<Basis> owned_basis_;
  Basis basis_;
  decltype(basis_on_host(std::declval<const Scene&>(), std::declval<const Point&>(),
                         std::declval<const OwnedBasis<Basis>&>())) on_host_;
  Loads<Dim, Real> loads_;
  std::vector<Resultant> resultants_;  ///< of each traction at full load
  int placed_count_ = 0;               ///< particles at the start
  std::vector<CutStarts> starts_;
  std::vector<BodyVolume> volumes_;
  CutVolume cut_;
  MomentFit moment_fit_;
  std::vector<std::string> advice_;
  Vector<Dim, Real> near_;  ///< where the first particle began
  MassCentre at_start_;     ///< of all particles
  std::vector<Body<Real>> bodies_;
  std::vector<int> ids_;  ///< of the particles that are left; empty before a removal
  BoundaryNodes<Device> declared_;
  std::vector<TractionMask> carried_;  ///< [particle at the start]: tractions that move with it; may be empty
  std::vector<PlacedCover> covers_;    ///< of the particles at the start
  FaceCover<Device> cover_;            ///< of those that are left
  SurfacePoints<Dim, Real, Device> surface_;  ///< none, unless a traction is imposed on points
  StepOptions<Dim, Real> options_{};
  OutflowReport outflow_;         ///< its masses aside
  std::map<int, Point> outside_;  ///< after LeftGrid: where particles are that stand in the grid for reading
  bool all_gone_ = false;         ///< these were the last, and let go
  long long step_ = 0, loads_begin_ = 0;
  std::string particle_kernels_because_;
  std::unique_ptr<Memory> memory_;
  std::unique_ptr<Engine> lanes_;  ///< where there are some, they hold the particles
};

}  // namespace vsb::app
