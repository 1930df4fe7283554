// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The sweeps over cell lanes, marking and packing alone, and the step on cell lanes.

#include "common_steps.hpp"
#include "lane_checks.hpp"
#include "registry.hpp"

namespace vsb::bench {
namespace {

/// A column whose nodes carry what its particles gave them.
template <int Dim, class Real>
struct Packed {
  Column<Dim, Real> column;
  Lane<Dim, Real> lanes;

  Packed(const Size& size, Load load)
      : column(make_column<Dim, Real>(size, load, 0)), lanes(make_lanes(column)) {
    with_field(column, [&](const auto& field) { prepare_lane_step(Exec(), lanes, field); });
    for (int n = 0; n < 2; ++n) run_step();
  }
  void run_step() {
    with_field(column, [&](const auto& field) { step(column, lanes, field); });
  }
  void run_sum() {
    with_field(column, [&](const auto& field) { detail::sum_lanes(Exec(), lanes, field); });
  }
  void run_accelerate() {
    const auto& m = lanes.memory;
    Kokkos::parallel_for("vsb::accelerate_lanes", detail::over_layers(Exec(), lanes),
                         kernel::AccelerateLanes<Dim, Real, Device>{m.lanes, m.nodes, column.options.pic});
  }
  void run_move() {
    const auto& m = lanes.memory;
    with_field(column, [&](const auto& field) {
      using Field = std::decay_t<decltype(field)>;
      Kokkos::parallel_for(
          "vsb::move_lanes", detail::over_layers(Exec(), lanes),
          kernel::MoveLanes<true, Field, LinearElastic<Real>, DeterminantVolume, Dim, Real, Device>{
              detail::loaded_lanes(lanes),
              {m.lanes,
               m.nodes,
               m.grid,
               column.material,
               {},
               m.migrating,
               0,
               column.options.position_velocity,
               column.options.pic},
              field,
              true});
    });
  }
  Kokkos::RangePolicy<Exec> over_node_groups() const {
    return Kokkos::RangePolicy<Exec>(Exec(), 0, lanes.memory.lanes.node_count / lanes.memory.lanes.width);
  }
  void run_nodes() {
    const auto& m = lanes.memory;
    const auto& o = column.options;
    Kokkos::parallel_for("vsb::update_lane_nodes", over_node_groups(),
                         kernel::UpdateLaneNodes<Dim, Real, Device>{{m.nodes},
                                                                    o.gravity,
                                                                    m.grid.inverse_spacing,
                                                                    o.damping,
                                                                    o.pic,
                                                                    o.dt,
                                                                    false,
                                                                    o.position_velocity});
  }
  void run_remap() {
    const auto& m = lanes.memory;
    Kokkos::parallel_for(
        "vsb::remap_lane_nodes", over_node_groups(),
        kernel::RemapLaneNodes<Dim, Real, Device>{{m.nodes}, column.options.dt * m.grid.inverse_spacing[0]});
  }
  void run_mark() {
    update_occupied(Exec(), lanes.memory.lanes, lanes.boundary);
    mark_lanes(Exec(), lanes.memory.lanes, lanes.memory.grid.cells, lanes.boundary, true);
  }
  std::string check_mark() {
    run_mark();
    const int found = count_loaded_nodes(Exec(), lanes.memory.lanes, lanes.boundary);
    return found == expected_boundary_nodes(column) ? "" : "the number of boundary nodes is wrong";
  }
};

/// The nodes' part of the step: dv of the whole body is its impulse, and so is that of the re-map.
template <int Dim, class Real>
std::string check_nodes(Packed<Dim, Real>& s) {
  s.column.options.damping = 0;
  s.lanes.memory.nodes.fixed =
      decltype(s.lanes.memory.nodes.fixed)("vsb::free", s.lanes.memory.nodes.fixed.extent(0));
  Sum impulse[Dim];
  for (int i = 0; i < Dim; ++i)
    impulse[i] = static_cast<double>(s.column.options.dt) *
                 (lane_node_sum(s.lanes, 1 + Dim + i) +
                  static_cast<double>(s.column.options.gravity[i]) * lane_node_sum(s.lanes, 0));
  s.run_nodes();
  Findings<Real> findings;
  for (int i = 0; i < Dim; ++i) findings.require_equal(lane_impulse(s.lanes, i), impulse[i], "momentum");
  return findings.text();
}

template <int Dim, class Real>
void add_lanes(const Size& size) {
  using S = Packed<Dim, Real>;
  constexpr double word = sizeof(Real), stress = symmetric_components(Dim);
  const auto add_one = [&](const std::string& what, Load load, double bytes, auto check, auto run,
                           auto... before) {
    const bool loads = what == "lane_sum" || what == "lane_move" || what == "lane_step";
    add(what + scene_name<Dim, Real>(size) + (loads ? name(load) : ""), [=](benchmark::State& state) {
      const auto findings = [&] {
        S s(size, load);
        return check(s);
      }();
      S s(size, load);
      time(
          state, findings, particle_count<Dim>(size), bytes, [&] { run(s); }, [&] { before(s); }...);
    });
  };
  const double sum = word * (2 * Dim + 2 + stress), accelerate = word * (3 * Dim + 1),
               move = sum + word * (Dim + 1 + stress);
  for (const Load load : {Load::off, Load::end_face, Load::free_faces}) {
    add_one(
        "lane_sum", load, sum,
        [](S& s) {
          s.lanes = make_lanes(s.column);  // steps change volumes, and by as much the resultant of a load
          return check_lane_sums(s.column, s.lanes, [&] { s.run_sum(); });
        },
        [](S& s) { s.run_sum(); });
    add_one(
        "lane_move", load, move, [](S& s) { return check_lane_motion(s.lanes, [&] { s.run_move(); }); },
        [](S& s) { s.run_move(); });
    add_one(
        "lane_step", load, accelerate + move,
        [](S& s) { return check_lane_step(s.column, s.lanes, [&] { s.run_step(); }); },
        [](S& s) { s.run_step(); });
  }
  add_one(
      "lane_accelerate", Load::off, accelerate,
      [](S& s) {
        s.run_nodes();
        return check_lane_acceleration(s.lanes, [&] { s.run_accelerate(); });
      },
      [](S& s) { s.run_accelerate(); });
  add_one(
      "lane_nodes", Load::off, 0, [](S& s) { return check_nodes(s); },
      [](S& s) {
        s.run_nodes();
        s.run_remap();
      },
      [](S& s) { s.run_sum(); });  // nodes leave sums at zero
  add_one(
      "lane_mark", Load::free_faces, 0, [](S& s) { return s.check_mark(); }, [](S& s) { s.run_mark(); });
  add_one(
      "lane_pack", Load::off, 2 * sum,
      [](S& s) {
        return check_packing(s.column, s.lanes,
                             [&] { pack_lanes(Exec(), s.column.block.particles, s.lanes); });
      },
      [](S& s) { pack_lanes(Exec(), s.column.block.particles, s.lanes); });
  add_one(
      "lane_repack", Load::off, 2 * sum,
      [](S& s) {
        pack_lanes(Exec(), s.column.block.particles, s.lanes);
        return check_packing(s.column, s.lanes, [&] { repack_lanes(Exec(), s.lanes.memory); });
      },
      [](S& s) { repack_lanes(Exec(), s.lanes.memory); });
}

}  // namespace

void register_lanes() {
  for_each_scene([](auto dimension, auto real, const Size& size) {
    add_lanes<decltype(dimension)::value, decltype(real)>(size);
  });
}

}  // namespace vsb::bench
