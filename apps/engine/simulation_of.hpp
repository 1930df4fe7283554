// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The simulation of a scene in a given dimension and precision, whatever its basis and its engine. It counts
/// steps, sets the loads of the time, removes particles, and puts into the terms of the scene what the engine
/// tells.
///
/// At the start, and where particle kernels make the steps, a ParticleEngine holds the particles. Where cell
/// lanes make them, a LaneEngine takes the particles over with the first step. Particles that leave the grid
/// or are removed need a ParticleEngine again, until the next step.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <random>
#include "engine/balance_report.hpp"
#include "engine/choose_engine.hpp"
#include "engine/departure.hpp"
#include "engine/scene_basis.hpp"
#include "setup/check_tractions.hpp"
#include "setup/grid_lines.hpp"

namespace vsb::app {

template <int Dim, class Real>
class SimulationOf final : public Simulation {
 public:
  SimulationOf(const Scene& scene, PlacedParticles* taken, std::unique_ptr<SceneBasis<Dim, Real>> basis)
      : model_(scene), scene_(model_.scene), basis_(std::move(basis)) {
    const auto placed = taken ? std::move(*taken) : place_particles(scene_);
    if (!scene_.grid.mapped() && scene_.method.basis == BasisKind::linear)
      refuse_on_grid_lines(scene_, placed);
    placed_count_ = static_cast<int>(placed.position.size());
    starts_ = placed.starts;
    volumes_ = vsb::app::body_volumes(scene_, placed);
    cut_ = placed.cut;
    moment_fit_ = placed.moment_fit;
    at_start_ = mass_centre(scene_, placed);
    model_.place(placed);
    model_.let_go = [this](ParticleEngine<Dim, Real>& engine, int lost) { let_go(engine, lost); };
    const TractionMask on_surface = basis_->place_loads(model_, placed);
    resultants_ = exact_resultants(scene_, at_start_.position);
    why_not_lanes_ = reason_for_particle_kernels(scene_);
    model_.for_lanes = why_not_lanes_.empty();
    refuse_unresolved_positions(scene_, model_.for_lanes);
    use(basis_->make_particle_engine(model_));
    particles_->fill(placed);
    particles_->settle();
    advice_ = basis_->check_start(model_, *particles_, on_surface, placed);
  }

  int particle_count() const override { return model_.particle_count(); }
  long long step() const override { return step_; }
  double time() const override { return static_cast<double>(step_) * scene_.time.dt; }
  double load_time() const override { return load_time_at(step_); }
  int boundary_nodes() const override { return engine_->boundary_nodes(); }
  std::string why_not_lanes() const override { return why_not_lanes_; }
  CutVolume cut_volume() const override { return cut_; }
  const std::vector<BodyVolume>& body_volumes() const override { return volumes_; }
  MomentFit moment_fit() const override { return moment_fit_; }
  std::vector<std::string> advice() const override { return advice_; }
  VoidFilterReport void_filter() const override {
    if (!scene_.method.void_filter) return {};
    return engine_->particles()->void_filter();
  }
  size_t state_bytes() const override {
    return model_.declared.span() * sizeof(TractionMask) + engine_->bytes();
  }

  OutflowReport outflow() const override {
    auto report = outflow_;
    report.mass_at_start = at_start_.mass;
    if (report.particles == 0) return report;
    std::vector<bool> gone(static_cast<size_t>(placed_count_), true);
    for (int p = 0; p < particle_count(); ++p)
      if (!all_gone_) gone[static_cast<size_t>(model_.id_of(p))] = false;
    const auto placed = place_particles(scene_);
    for (size_t b = 0; b < scene_.bodies.size(); ++b)
      for (auto id = static_cast<size_t>(placed.bodies[b].first);
           id < static_cast<size_t>(placed.bodies[b].last); ++id)
        if (gone[id]) report.mass_gone += scene_.bodies[b].density * placed.volume[id];
    return report;
  }

  void advance(long long steps) override {
    for (long long n = 0; n < steps;) {
      use_engine_of_steps();
      set_gravity(load_time_at(step_ + 1));
      const auto [made, lost] = engine_->step([&](int ahead) { set_tractions(load_time_at(step_ + ahead)); });
      if (made) {
        ++step_;
        ++n;
      }
      if (lost >= 0) let_go(*engine_->particles(), lost);
    }
    use_engine_of_steps();
    if (scene_.faces.any_outflow()) engine_->settle();  // whoever looks finds no particle outside
    ExecutionSpace().fence();
  }

  StaticSolution solve_static(double t, const std::function<bool(int, double)>& go_on) override {
    set_loads(t);
    const auto found = particles_->solve_static(go_on);
    if (found.lost >= 0) let_go(*particles_, particle_count() + found.lost);
    StaticSolution solution;
    solution.iterations = found.result.iterations;
    solution.residual = found.result.residual;
    solution.converged = found.result.converged;
    if (!solution.converged) return solution;
    solution.largest_strain = found.largest_strain;
    solution.balance = balance_under_loads_at(t);
    particles_->displace(found.displacement);
    return solution;
  }

  std::string unsupported_load(double t) override {
    set_loads(t);
    constexpr double tolerance = 1e-3;  // what meshes and lattices leave of loads that are in balance
    return text(scene_, engine()->particles()->unsupported_load(tolerance));
  }

  void disturb(double speed) override {
    use(engine_->particles());
    auto host = host_copy(particles_->block());
    std::mt19937_64 random;
    for (int p = 0; p < particle_count(); ++p)
      for (int i = 0; i < Dim; ++i) {
        const double from_0_to_2 = static_cast<double>(random() >> 11) * 0x1p-52;
        host.particles.velocity(p, i) += static_cast<Real>(speed * (from_0_to_2 - 1));
      }
    copy_to_device(host, particles_->block());
    particles_->settle();
  }

  void check_health() override { throw_spoilt(engine_->find_invalid()); }

  BalanceReport balance() override { return balance_under_loads_at(load_time()); }
  BalanceReport balance_under_loads_at(double t) override {
    set_loads(t);
    return report_balance(scene_, engine()->balance(), model_.origin, at_start_.position, resultants_, t);
  }

  std::vector<TractionState> traction_states() override {
    std::vector<TractionState> states;
    std::vector<TractionMask> masks;
    for (size_t k = 0; k < scene_.tractions.size(); ++k) {
      const TractionMask mask = TractionMask(1) << k;
      if ((model_.loads.on_nodes() & ~model_.loads.at_all_active_nodes() & mask) == 0) continue;
      masks.push_back(mask);
      auto& state = states.emplace_back();
      state.traction = k;
      state.load = resultants_[k].load;
      state.exact_force = resultants_[k].force;
    }
    if (states.empty()) return states;
    model_.loads.set_full(scene_);
    engine_->balance_loads();
    const auto actions = engine()->act(masks);
    for (size_t n = 0; n < states.size(); ++n) {
      const auto& [resultant, cells] = actions[n];
      for (int i = 0; i < Dim; ++i) states[n].force[static_cast<size_t>(i)] = resultant.force[i];
      states[n].whole_cells = cells.whole;
      states[n].part_cells = cells.part;
    }
    return states;
  }

  std::unique_ptr<ParticleReader> read_particles() override {
    std::vector<PlacedBody> bodies;
    for (const auto& body : model_.bodies) bodies.push_back({body.first, body.last});
    auto reader =
        std::make_unique<SceneReader>(scene_, starts_, model_.ids, std::move(bodies), engine_->fields());
    reader->outside = outside_;
    reader->step = step_;
    reader->time = time();
    reader->count = static_cast<size_t>(particle_count());
    reader->plastic = any_plastic();
    return reader;
  }

  std::vector<double> equivalent_plastic_strain(bool smoothed) override {
    const Kokkos::View<Real*, Device> strain("vsb::plastic_strain", static_cast<size_t>(particle_count()));
    if (any_plastic()) engine_->equivalent_plastic_strain(strain);
    if (smoothed) engine()->smooth(strain);
    ExecutionSpace().fence();
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
    engine_->for_each_cell([&](int p, size_t cell) {
      surplus[cell] += marked[static_cast<size_t>(p)] != 0 ? 1 : -1;
      contents[cell] = CellContent::particles;
    });
    for (size_t c = 0; c < contents.size(); ++c)
      if (contents[c] != CellContent::nothing && surplus[c] >= 0) contents[c] = CellContent::marked;
    return contents;
  }

  void remove(const std::vector<unsigned char>& removed, const Restart& restart) override {
    const bool anew = !particles_ && restart.reset;  // nothing of the present state will be left
    if (!anew) use(engine_->particles());
    engine_.reset();
    const auto kept = model_.keep(removed, starts_);
    if (!anew) particles_->keep(kept);
    use(anew ? basis_->make_particle_engine(model_) : particles_);
    if (restart.damping) model_.options.damping = static_cast<Real>(*restart.damping);
    if (restart.reset) {
      particles_->fill(place_particles(scene_));
      loads_begin_ = step_;
    }
    particles_->settle();
  }

  GridSnapshot grid_snapshot() override {
    // The nodes of the state as it is, however the steps before it were made.
    set_loads(load_time());
    return engine()->particles()->grid_snapshot();
  }

  SavedState saved_state() const override { return {step_, sizeof(Real), staged_state()}; }

  void save_particles(ByteSink& to) override {
    use_engine_of_steps();
    engine_->save(to);
  }

  void restore(const SavedState& saved, ByteSource& particles) override {
    restore_staged(saved.staged);
    if (model_.for_lanes) {
      engine_.reset();
      particles_.reset();
      engine_ = basis_->make_lane_engine(model_, nullptr);
    }
    const auto restored =
        saved.bytes_per_number == sizeof(Real) ? engine_->restore(particles) : Restored::other_particles;
    if (restored != Restored::yes)
      throw SetupError(fmt::format("the checkpoint belongs to another scene: {}",
                                   restored == Restored::outside_grid
                                       ? "it has particles outside this one's grid"
                                       : "its particles do not fit this one's"));
    step_ = saved.step;
  }

 private:
  using Device = ExecutionSpace::device_type;
  static_assert(max_tractions == UniformVirtualStress<Dim, Real>::capacity,
                "a scene may declare as many tractions as the kernels can take");

  /// By value: while an engine is asked, another may take its place (let_go).
  std::shared_ptr<Engine<Dim, Real>> engine() const { return engine_; }
  void use(const std::shared_ptr<ParticleEngine<Dim, Real>>& engine) {
    particles_ = engine;
    engine_ = engine;
  }
  /// Hands the particles over to cell lanes, where these make the steps.
  void use_engine_of_steps() {
    if (!model_.for_lanes || !particles_) return;
    engine_.reset();
    engine_ = basis_->make_lane_engine(model_, std::move(particles_));
    particles_.reset();
  }

  /// The particles that are left, of all there were at the start.
  StagedState staged_state() const {
    if (!may_lose_particles(scene_)) return {};
    StagedState staged;
    staged.outflow = outflow_.numbers();
    staged.loads_begin = loads_begin_;
    staged.present.assign(static_cast<size_t>(placed_count_), model_.ids.empty() ? 1 : 0);
    for (const int id : model_.ids) staged.present[static_cast<size_t>(id)] = 1;
    return staged;
  }
  void restore_staged(const StagedState& staged) {
    if (!may_lose_particles(scene_)) return;
    if (staged.present.size() != static_cast<size_t>(placed_count_) || !model_.ids.empty())
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
  void set_loads(double t) {
    set_gravity(t);
    set_tractions(t);
  }
  /// Both engines take gravity in the step itself; cell lanes take tractions ahead of theirs.
  void set_gravity(double t) { model_.options.gravity = gravity_at<Dim, Real>(scene_, t); }
  void set_tractions(double t) {
    model_.loads.set_time(scene_, t);
    engine_->balance_loads();
  }
  bool any_plastic() const {
    return std::any_of(model_.bodies.begin(), model_.bodies.end(),
                       [](const auto& body) { return is_plastic(body.material); });
  }

  /// Where messages about the present state begin.
  std::string when() const { return fmt::format("at step {}, time {:.6g} s", step_, time()); }

  void throw_spoilt(const Invalid& bad) const {
    if (bad.particle < 0) return;
    static const char* names[] = {"position", "velocity", "cauchy_stress", "volume"};
    static const char* faults[] = {"is not finite", "is not finite", "is not finite",
                                   "is not positive (J <= 0)"};
    const auto f = static_cast<size_t>(bad.field);
    throw Diverged(
        fmt::format("{}: {} of particle {} {}", when(), names[f], model_.id_of(bad.particle), faults[f]));
  }

  /// Model::let_go. The engine with the particles becomes that of the simulation. Where the faces let the
  /// particles outside go, they are removed; else throws.
  void let_go(ParticleEngine<Dim, Real>& with, int lost) {
    const bool from_lanes = particles_.get() != &with;  // round-off at a face may put `lost` inside
    use(with.particles());
    throw_spoilt(with.find_invalid());
    const auto host = host_copy(with.block());
    refuse_unstable(model_, host.particles, when());
    std::vector<unsigned char> leaves(static_cast<size_t>(particle_count()), 0);
    OutsidePlaces outside;
    const bool is_particle = lost < particle_count();
    bool open = is_particle;
    OutflowReport gone = outflow_;
    for (int p = 0; p < particle_count(); ++p) {
      const auto x = host.particles.position_of(p);
      if (with.contains(x) && (p != lost || from_lanes)) continue;
      outside[p] = to_scene(x, model_.origin);
      leaves[static_cast<size_t>(p)] = 1;
      const auto face = outflow_face(scene_, outside[p]);
      open = open && face;
      if (face) gone.add(step_, *face);
    }
    const bool all = open && static_cast<int>(outside.size()) == particle_count();
    if (open) outflow_ = gone;
    if (open && !all) return with.keep(model_.keep(leaves, starts_));
    const auto what = all           ? std::string("the last particles left the grid")
                      : is_particle ? leave_text(model_, host.particles, outside)
                                    : fmt::format("surface point {}, which carries a traction, left the grid",
                                                  lost - particle_count());
    stand_in_grid(model_, with, host, outside);
    outside_ = outside;
    for (auto& [p, x] : outside_)
      for (size_t i = 0; i < 3; ++i) x[i] -= model_.origin[i];
    all_gone_ = all;
    throw LeftGrid(fmt::format("{}: {}", when(), what), all);
  }

  Model<Dim, Real> model_;
  const Scene& scene_;
  std::unique_ptr<SceneBasis<Dim, Real>> basis_;
  std::vector<Resultant> resultants_;  ///< of each traction at full load
  int placed_count_ = 0;               ///< particles at the start
  std::vector<CutStarts> starts_;
  std::vector<BodyVolume> volumes_;
  CutVolume cut_;
  MomentFit moment_fit_;
  std::vector<std::string> advice_;
  MassCentre at_start_;    ///< of all particles
  OutflowReport outflow_;  ///< its masses aside
  OutsidePlaces outside_;  ///< of particles that stand in the grid for reading, from the local origin
  bool all_gone_ = false;  ///< these were the last, and let go
  long long step_ = 0, loads_begin_ = 0;
  std::string why_not_lanes_;
  std::shared_ptr<Engine<Dim, Real>> engine_;             ///< with the particles
  std::shared_ptr<ParticleEngine<Dim, Real>> particles_;  ///< the same one, where it is of this kind
};

}  // namespace vsb::app
