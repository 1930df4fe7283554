// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The engine of the particle kernels on a basis: the steps, and what else needs basis functions.
#pragma once

#include <type_traits>
#include <vsb/kernels/boundary/flag_boundary_particles.hpp>
#include <vsb/kernels/readout/smooth_particles.hpp>
#include "engine/particle_engine.hpp"
#include "engine/read_nodes.hpp"
#include "setup/basis_of.hpp"
#include "setup/set_up_nodes.hpp"
#include "setup/void_seeds.hpp"

namespace vsb::app {

/// The basis of a scene, where the kernels run and for work on the host.
template <class Basis>
struct BasisCopies {
  BasisCopies(const Scene& scene, const Point& origin)
      : owned(scene, origin), host(basis_on_host(scene, origin, owned)) {}

  OwnedBasis<Basis> owned;
  decltype(basis_on_host(std::declval<const Scene&>(), std::declval<const Point&>(),
                         std::declval<const OwnedBasis<Basis>&>())) host;
};

template <int Dim, class Real, class Basis>
class ParticleEngineOn final : public ParticleEngine<Dim, Real> {
  using Base = ParticleEngine<Dim, Real>;
  using Base::block_, Base::exec_, Base::model_, Base::state_;

 public:
  using typename Base::Device;

  /// The particles of the model, all at zero; the bases must outlive the engine.
  ParticleEngineOn(Model<Dim, Real>& model, const BasisCopies<Basis>& bases)
      : Base(model), basis_(bases.owned.basis), bases_(bases) {
    const auto& scene = model_.scene;
    state_ = make_state(block_.particles, basis_);
    state_.loads_found = true;  // a resumed load may have left its region
    fix_faces(scene, basis_, state_.nodes.fixed_components);
    auto& occupancy = state_.occupancy;
    occupancy.tractions = model_.declared;
    occupancy.at_all_active_nodes = model_.loads.at_all_active_nodes();
    if (model_.carried.particle.size() > 0)
      set_carried_tractions(occupancy, basis_, model_.carried.particle, model_.carried.tractions);
    state_.surface = model_.surface;
    if (state_.surface.count() > 0) Kokkos::deep_copy(state_.surface.bins.bin, -1);  // to be sorted anew
    if (scene.method.fill_criterion > 0) set_fill_criterion(occupancy, scene.method.fill_criterion);
    if (scene.method.void_filter) {
      set_void_filter(occupancy, basis_);
      remove_body_cells<Device>(scene, bases_.host.basis.grid, occupancy.cells.outside);
    }
  }

  StepOutcome step(const std::function<void(int)>& set_loads) override {
    set_loads(1);
    const int lost = with_field([&](const auto& field) {
      return vsb::step(exec_, state_, model_.bodies, basis_, field, model_.options);
    });
    return {lost < 0, lost};
  }

  bool contains(const Vector<Dim, Real>& x) const override { return bases_.host.basis.contains(x); }
  size_t bytes() const override { return bases_.owned.bytes() + Base::bytes(); }

  Balance<Dim> balance() override {
    this->settle();
    return with_field([&](const auto& field) {
      return vsb::balance(exec_, state_, model_.bodies, basis_, field, model_.options, model_.cover);
    });
  }

  std::vector<TractionAction<Dim>> act(const std::vector<TractionMask>& tractions) override {
    this->settle();
    std::vector<TractionAction<Dim>> actions;
    for (const TractionMask mask : tractions)
      actions.push_back({with_field([&](const auto& field) {
                           return vsb::resultant(exec_, state_, basis_, field, mask, model_.cover);
                         }),
                         count_loaded_cells(exec_, state_.occupancy, basis_, mask)});
    return actions;
  }

  void smooth(const Kokkos::View<Real*, Device>& q) override {
    this->settle();
    smooth_particles(exec_, state_.particles, state_.occupancy.bins, basis_, q, model_.options.scatter);
  }

  void for_each_cell(const std::function<void(int, size_t)>& visit) override {
    const auto particles = host_copy(block_).particles;
    const auto& basis = bases_.host.basis;
    for (int p = 0; p < particles.count(); ++p)
      visit(p, scene_cell(model_.scene, basis, basis.grid.cell_containing(particles.position_of(p))));
  }

  StaticState<Dim, Real, Device> solve_static(const std::function<bool(int, double)>& go_on) override {
    this->settle();
    if constexpr (std::is_same_v<Real, double>)
      return vsb::app::solve_static(
          exec_, model_.scene, state_, model_.bodies, basis_, model_.options,
          [&](const auto& work) { return with_field(work); }, go_on);
    else
      throw SetupError("--static: needs precision = \"double\"");
  }

  void displace(const typename Nodes<Dim, Real, Device>::Fields& displacement) override {
    displace_particles(exec_, state_.particles, basis_, displacement);
    exec_.fence();
  }

  UnsupportedLoad<Dim> unsupported_load(double tolerance) override {
    this->settle();
    const int lost = with_field([&](const auto& field) {
      return assemble_forces(exec_, state_.particles, state_.occupancy, state_.surface, state_.nodes,
                             state_.sums_workspace, basis_, field, model_.options.gravity,
                             model_.options.scatter);
    });
    if (lost >= 0) this->let_go(model_.particle_count() + lost);
    return find_unsupported_load(exec_, state_.nodes, state_.occupancy.bins, basis_, tolerance);
  }

  GridSnapshot grid_snapshot() override {
    balance();
    update_nodes(exec_, state_.nodes, basis_, model_.options.damping, model_.options.dt);
    exec_.fence();
    return read_nodes(model_.scene, basis_, state_.nodes, state_.occupancy.boundary);
  }

  VoidFilterReport void_filter() const override {
    const auto& o = state_.occupancy;
    const auto effect = void_filter_effect(exec_, state_.particles, o.cells, basis_, o.tractions,
                                           o.boundary_node_count, o.at_all_active_nodes);
    return {effect.false_voids, effect.dropped_nodes};
  }

  const Occupancy<Device>& occupancy() const { return state_.occupancy; }

 private:
  int locate() override { return update_occupancy(exec_, state_.particles, state_.occupancy, basis_); }
  ParticleBins<Device> make_bins() const override {
    return allocate_bins<Device>(model_.particle_count(), basis_.bin_count());
  }
  void flag_boundary(const Flags& flags) const override {
    flag_boundary_particles(exec_, state_.particles, state_.occupancy.boundary, basis_, flags);
  }

  /// Calls work(field) with the kernels' field for the loads of the model.
  template <class Work>
  auto with_field(const Work& work) const {
    return model_.loads.template with_field<Basis::ghost_layers == 0>(basis_.grid, state_.occupancy.cells,
                                                                      work);
  }

  Basis basis_;
  const BasisCopies<Basis>& bases_;
};

}  // namespace vsb::app
