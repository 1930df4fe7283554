// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What a step on cell lanes costs, and what the virtual stress adds, or another way of imposing a traction.
#pragma once

#include "cost_cases.hpp"
#include "cost_record.hpp"
#include "flops.hpp"
#include "lane_checks.hpp"
#include "rounds.hpp"
#include "surface_scene.hpp"

#include <cmath>
#include <vsb/kernels/lanes/loads.hpp>
#include <vsb/physics/traction_fields.hpp>

namespace vsb::bench {

/// The fields that are compared, all as small as the column's pressure.
template <class Real>
struct CostFields {
  UniformVirtualStress<3, Real> pressure, tensor;
  AffineVirtualStress<3, Real> affine;
  TractionFields<3, Real> function;

  explicit CostFields(const Column<3, Real>& column) {
    const Real p = static_cast<Real>(column.pressure), length = static_cast<Real>(column.length);
    pressure = tensor = column.virtual_stress;
    for (int c = 0; c < 6; ++c) tensor.stress[0][c] = p * (c < 3 ? Real(-1) : Real(0.25));
    AffineStress<3, Real> hydrostatic{pressure_stress<3>(p), {}};
    for (auto& g : hydrostatic.gradient) g = SymmetricTensor<3, Real>::zero();
    hydrostatic.gradient[column.axis] = pressure_stress<3>(-p / length);
    affine.count = function.count = 1;
    affine.factor[0] = function.factor[0] = 1;
    affine.field[0] = hydrostatic;
    affine.find_axis();
    RadialBlend<3, Real> blend;
    for (int i = 0; i < 3; ++i) {
      blend.center[i] = 0;
      blend.across[i] = i == column.axis ? Real(0) : Real(1);
    }
    blend.inner_radius = length / 100;
    blend.outer_radius = length;
    blend.inner = pressure_stress<3>(p);
    blend.outer = SymmetricTensor<3, Real>::zero();
    function.field[0] = blend;
  }
};

/// Marks anew, one word of N1 having changed: what an occupancy that changes costs beside the sums.
template <class Real>
void mark_anew(Lane<3, Real>& s) {
  auto& b = s.boundary;
  b.marked(b.marked.extent(0) / 2, 0) ^= 1;
  update_occupied(Exec(), s.memory.lanes, b);
  mark_lanes(Exec(), s.memory.lanes, s.memory.grid.cells, b, false);
}

/// The column's loaded material points and its boundary particles.
template <class Real>
struct CostPoints {
  LaneSurfacePoints<3, Real, Device> material, boundary;

  /// The particles of `column` may be gone: they are made anew.
  explicit CostPoints(const Column<3, Real>& column) {
    const auto whole = make_column<3, Real>(column.size, column.load, column.axis);
    const auto pack = [&](Points kind) {
      return pack_surface_points(Exec(), make_surface(whole, kind), column.basis.grid);
    };
    material = pack(Points::material);
    boundary = pack(Points::boundary);
  }
};

/// One step with the column's pressure on surface points, or by the original method (`original` = 1).
template <class Real>
void step_with_loads(const Column<3, Real>& column, Lane<3, Real>& s,
                     LaneSurfacePoints<3, Real, Device>& points, TractionMask original) {
  std::swap(s.surface, points);
  s.original = original;
  step(column, s, NoVirtualStress{});
  if (add_lane_loads(Exec(), s, column.virtual_stress) >= 0)
    throw std::runtime_error("a surface point of the column is outside its grid");
  s.original = 0;
  std::swap(s.surface, points);
}

/// Base and the fields against it, with the traction where the column has it; and the other ways of imposing
/// the pressure.
template <class Real>
Rounds measure_fields(const Column<3, Real>& column, Lane<3, Real>& s, int rounds) {
  const CostFields<Real> fields(column);
  CostPoints<Real> points(column);
  std::vector<Variant> variants;
  const auto add = [&](const std::string& name, const auto& field) {
    variants.push_back({name, [&] { step(column, s, field); }});
    variants.push_back({name + ", marked", [&] {
                          step(column, s, field);
                          mark_anew(s);
                        }});
  };
  add("pressure", fields.pressure);
  variants.push_back({"pressure, marked, summed anew", [&] {
                        step(column, s, fields.pressure);
                        mark_anew(s);
                        detail::sum_lanes(Exec(), s, fields.pressure);
                      }});
  add("tensor", fields.tensor);
  add("affine", fields.affine);
  add("function", fields.function);
  LaneSurfacePoints<3, Real, Device> none;
  variants.push_back({"MP", [&] { step_with_loads(column, s, points.material, 0); }});
  variants.push_back({"BP", [&] { step_with_loads(column, s, points.boundary, 0); }});
  variants.push_back({"ORIG", [&] { step_with_loads(column, s, none, 1); }});
  return measure_in_turns({"base", [&] { step(column, s, NoVirtualStress{}); }}, variants, rounds);
}

/// Adds the extras to the record, in percent and in ns per particle.
inline void add_extras(Record& record, const std::string& where, const Rounds& found, int particles) {
  for (const auto& extra : found.extras) {
    record.set(where + ": " + extra.name + " %", extra.percent);
    record.set(where + ": " + extra.name + " ns", 1e9 * extra.seconds / particles);
  }
}

/// The column on lanes, checked, and in the record what memory it took per particle.
template <class Real>
Lane<3, Real> make_measured_lanes(Column<3, Real>& column, const CostCase& what, int axis, Record& record) {
  const double start = resident_bytes();
  reset_peak();
  column = make_column<3, Real>(what.size, Load::free_faces, axis);
  const int particles = particle_count<3>(what.size);
  auto s = make_lanes_of(column);
  prepare_lane_step(Exec(), s, column.virtual_stress);
  step(column, s, column.virtual_stress);
  record.set("peak bytes", (peak_bytes() - start) / particles);
  reset_peak();
  for (int n = 0; n < 3; ++n) step(column, s, column.virtual_stress);
  record.set("stepping bytes", (peak_bytes() - start) / particles);
  record.set("state bytes", state_bytes(s) / particles);
  const auto findings = check_lane_step(column, s, [&] { step(column, s, column.virtual_stress); });
  if (!findings.empty()) throw std::runtime_error(what.name + ": " + findings);
  return s;
}

/// Steps that re-map by the mass matrix against steps with a second sweep, in turns.
template <class Real>
void measure_remap(const Column<3, Real>& column, Lane<3, Real>& s, int rounds, Record& record) {
  const bool chosen = s.memory.lanes.remaps_by_mass_matrix();
  const auto seconds = [&](bool one) {
    set_remap_method(s.memory.lanes, one);
    prepare_lane_step(Exec(), s, NoVirtualStress{});
    return seconds_in_a_row({"", [&] { step(column, s, NoVirtualStress{}); }});
  };
  std::vector<double> ratio;
  for (int round = 0; round < rounds; ++round) ratio.push_back(seconds(true) / seconds(false));
  record.set("mass matrix / second sweep", median(ratio));
  record.set("by mass matrix", chosen ? 1 : 0);
  set_remap_method(s.memory.lanes, chosen);
  prepare_lane_step(Exec(), s, NoVirtualStress{});
}

/// The row of a case in the table.
template <class Real>
void measure_engine(const CostCase& what, int axis, int repeats, Record& record) {
  Column<3, Real> column;
  auto s = make_measured_lanes(column, what, axis, record);
  const int particles = particle_count<3>(what.size);
  std::vector<double> base;
  for (const Load load : {Load::end_face, Load::free_faces}) {
    column.load = load;
    apply_load(column, s);
    const auto found = measure_fields(column, s, rounds_for(what.size, repeats));
    add_extras(record, load == Load::end_face ? "end face" : "all faces", found, particles);
    base.insert(base.end(), found.base.begin(), found.base.end());
  }
  measure_remap(column, s, rounds_for(what.size, repeats), record);
  record.set("base ns", 1e9 * median(base) / particles);
  record.set("base 10 % ns", 1e9 * quantile(base, 0.1) / particles);
  // Per particle, the work per cell shared out over its particles.
  const auto count = count_step_flops<3>();
  record.set("flops", count.per_particle + count.per_cell / std::pow(what.size.per_direction, 3));
  record.set("least bytes", step_words<3>() * static_cast<int>(sizeof(Real)));
}

/// The base alone, for the speed-up by threads: wall time.
template <class Real>
void measure_base(const CostCase& what, int axis, int repeats, Record& record) {
  Column<3, Real> column;
  auto s = make_measured_lanes(column, what, axis, record);
  std::vector<double> wall;
  const auto seconds = [] {
    timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  };
  for (int round = 0; round < 8 * rounds_for(what.size, repeats); ++round) {
    const double start = seconds();
    step(column, s, NoVirtualStress{});
    Kokkos::fence();
    wall.push_back(seconds() - start);
  }
  record.set("wall ns", 1e9 * median(wall) / particle_count<3>(what.size));
  record.set("wall 10 % ns", 1e9 * quantile(wall, 0.1) / particle_count<3>(what.size));
}

}  // namespace vsb::bench
