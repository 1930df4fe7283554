// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What must hold before a sweep over cell lanes is timed; see checks.hpp.
#pragma once

#include "checks.hpp"
#include "lane_scene.hpp"

#include <vector>

namespace vsb::bench {

/// The sum of term(p, e) over the particles of the lanes; p(column) is the number in column `column`, e the
/// particle's entry.
template <int Dim, class Real, class Term>
Sum lane_sum(const Lane<Dim, Real>& s, const Term& term) {
  const auto& lanes = s.memory.lanes;
  const auto data = snapshot(lanes.data);
  const auto id = snapshot(lanes.id);
  const auto groups = snapshot(lanes.groups);
  Sum sum;
  for (int g = 0; g < lanes.group_count; ++g) {
    const auto& group = groups(static_cast<size_t>(g));
    for (int e = group.first * lanes.width; e < (group.first + group.slots) * lanes.width; ++e) {
      if (id(static_cast<size_t>(e)) < 0) continue;
      const auto number = [&](int c) {
        return static_cast<double>(data(static_cast<size_t>(e), static_cast<size_t>(c)));
      };
      sum.add(term(number, lanes.cell(group, e % lanes.width)));
    }
  }
  return sum;
}

template <int Dim, class Real>
Sum lane_momentum(const Lane<Dim, Real>& s, int i) {
  const auto& lanes = s.memory.lanes;
  return lane_sum(
      s, [&](const auto& p, const auto&) { return p(lanes.mass_column) * p(lanes.velocity_column + i); });
}

/// The sum over all nodes of column c of the lower and upper sums.
template <int Dim, class Real>
Sum lane_node_sum(const Lane<Dim, Real>& s, int c) {
  const auto& nodes = s.memory.nodes;
  const auto data = snapshot(nodes.data);
  Sum sum;
  for (size_t I = 0; I < static_cast<size_t>(s.memory.lanes.node_count); ++I) {
    sum.add(static_cast<double>(data(I, static_cast<size_t>(nodes.lower_sums + c))));
    if (Dim > 1) sum.add(static_cast<double>(data(I, static_cast<size_t>(nodes.upper_sums + c))));
  }
  return sum;
}

/// Mass and momentum of the particles are those of the nodes; the resultant of the stresses is zero, and that
/// of a load on the end face is pressure times area.
template <int Dim, class Real, class Run>
std::string check_lane_sums(const Column<Dim, Real>& column, const Lane<Dim, Real>& s, const Run& run) {
  Findings<Real> findings;
  run();
  const auto& lanes = s.memory.lanes;
  const auto column_of = [](int c) { return [c](const auto& p, const auto&) { return p(c); }; };
  findings.require_equal(lane_node_sum(s, 0), lane_sum(s, column_of(lanes.mass_column)), "mass");
  for (int i = 0; i < Dim; ++i) {
    findings.require_equal(lane_node_sum(s, 1 + i), lane_momentum(s, i), "momentum");
    if (column.load == Load::free_faces) continue;
    const double load =
        column.load == Load::end_face && i == column.axis ? -column.pressure * column.end_face_area() : 0;
    findings.require_equal(lane_node_sum(s, 1 + Dim + i), Sum{load, 0}, "force");
  }
  return findings.text();
}

/// The sum over all nodes of m dv, with the increments of the step under way.
template <int Dim, class Real>
Sum lane_impulse(const Lane<Dim, Real>& s, int i) {
  const auto& nodes = s.memory.nodes;
  const auto data = snapshot(nodes.data);
  Sum impulse;
  for (size_t I = 0; I < static_cast<size_t>(s.memory.lanes.node_count); ++I) {
    const auto inverse_mass = static_cast<double>(data(I, static_cast<size_t>(nodes.inverse_mass_column)));
    if (inverse_mass > 0)
      impulse.add(static_cast<double>(data(I, static_cast<size_t>(nodes.increment_column + i))) /
                  inverse_mass);
  }
  return impulse;
}

/// Sets the nodes' sums to zero, as the node kernels of the step leave them.
template <int Dim, class Real>
void clear_lane_sums(const Lane<Dim, Real>& s) {
  const auto& nodes = s.memory.nodes;
  Kokkos::deep_copy(Kokkos::subview(nodes.data, Kokkos::ALL(), std::make_pair(0, nodes.increment_column)), 0);
}

/// Particles gain the momentum that the nodes gain, and the nodes of the re-map have it.
template <int Dim, class Real, class Run>
std::string check_lane_acceleration(const Lane<Dim, Real>& s, const Run& run) {
  Findings<Real> findings;
  Sum before[Dim], gain[Dim];
  for (int i = 0; i < Dim; ++i) {
    before[i] = lane_momentum(s, i);
    gain[i] = lane_impulse(s, i);
  }
  run();
  for (int i = 0; i < Dim; ++i) {
    findings.require_equal(lane_momentum(s, i), before[i] + gain[i], "momentum");
    findings.require_equal(lane_node_sum(s, 1 + i), lane_momentum(s, i), "re-mapped momentum");
  }
  return findings.text();
}

/// Writes the node increments of the velocity field v dt = g x, x from the grid's corner in cells.
template <int Dim, class Real>
void stretch_nodes(const Lane<Dim, Real>& s, double g) {
  const auto& lanes = s.memory.lanes;
  const auto& nodes = s.memory.nodes;
  const auto data = snapshot(nodes.data);
  const auto node_group_at = snapshot(lanes.node_group_at);
  const int per_row = lanes.groups_per_row() + 1;
  for (int box_index = 0; box_index < static_cast<int>(node_group_at.extent(0)); ++box_index) {
    const int node_group = node_group_at(static_cast<size_t>(box_index)), row = box_index / per_row;
    if (node_group < 0) continue;
    for (int l = 0; l < lanes.width; ++l) {
      int at[3] = {box_index % per_row * lanes.width + l, row % lanes.node_rows_per_plane(),
                   row / lanes.node_rows_per_plane()};
      if (Dim == 2) at[1] = row;
      for (int i = 0; i < Dim; ++i) {
        const auto value = static_cast<Real>(g * (lanes.box.first[i] + at[i]));
        const auto node = static_cast<size_t>(node_group * lanes.width + l);
        data(node, static_cast<size_t>(nodes.displacement_column + i)) = value;
        data(node, static_cast<size_t>(nodes.remapped_column + i)) = value;
      }
    }
  }
  Kokkos::deep_copy(nodes.data, data);
}

/// In the velocity field v dt = g x, every volume grows by (1 + g)^Dim and every position by 1 + g, and the
/// nodes get the mass of all particles. g is so small that no particle leaves its cell.
template <int Dim, class Real, class Run>
std::string check_lane_motion(const Lane<Dim, Real>& s, const Run& run) {
  const auto& cells = s.memory.grid.cells;
  const double g = 0.02 / *std::max_element(&cells[0], &cells[0] + Dim);
  Findings<Real> findings;
  const auto& lanes = s.memory.lanes;
  const auto volume = [&] {
    return lane_sum(s, [&](const auto& p, const auto&) { return p(lanes.volume_column); });
  };
  const auto position = [&](int i) {
    return lane_sum(
        s, [i, &lanes](const auto& p, const auto& cell) { return p(lanes.xi_column + i) + cell[i]; });
  };
  clear_lane_sums(s);
  stretch_nodes(s, g);
  const Sum volumes = volume();
  Sum positions[Dim];
  for (int i = 0; i < Dim; ++i) positions[i] = position(i);
  run();
  findings.require(count_migrating(Exec(), s.memory) == 0, "a particle left its cell");
  findings.require_equal(volume(), std::pow(1 + g, Dim) * volumes, "volume");
  for (int i = 0; i < Dim; ++i)
    findings.require_equal(position(i), (1 + g) * positions[i], "sum of positions");
  findings.require_equal(lane_node_sum(s, 0),
                         lane_sum(s, [&](const auto& p, const auto&) { return p(lanes.mass_column); }),
                         "mass");
  return findings.text();
}

/// All particles are in the lanes once, each where it is in the column.
template <int Dim, class Real, class Run>
std::string check_packing(const Column<Dim, Real>& column, const Lane<Dim, Real>& s, const Run& run) {
  run();
  Findings<Real> findings;
  const int n = column.block.particles.count();
  const auto id = snapshot(s.memory.lanes.id);
  std::vector<int> times(static_cast<size_t>(n), 0);
  for (int e = 0; e < s.memory.lanes.slot_count * s.memory.lanes.width; ++e) {
    const int p = id(static_cast<size_t>(e));
    if (p >= 0 && p < n) ++times[static_cast<size_t>(p)];
  }
  findings.require(std::count(times.begin(), times.end(), 1) == n, "particles are missing or packed twice");
  auto unpacked = allocate_particles<Dim, Real, Device>(n);
  unpack_particles(Exec(), s.memory, unpacked.particles);
  const auto before = host_copy(column.block), after = host_copy(unpacked);
  double error = 0;
  for (int p = 0; p < n; ++p)
    for (int i = 0; i < Dim; ++i)
      error = std::max(error, std::abs(static_cast<double>(before.particles.position(p, i)) -
                                       static_cast<double>(after.particles.position(p, i))));
  findings.require(error <= 16 * column.length * std::numeric_limits<Real>::epsilon(),
                   "a particle moved by " + std::to_string(error) + " m");
  return findings.text();
}

/// The nodes have mass and momentum of the particles after the step, all numbers are finite, and N1 is
/// complete.
template <int Dim, class Real, class Run>
std::string check_lane_step(const Column<Dim, Real>& column, const Lane<Dim, Real>& s, const Run& run) {
  Findings<Real> findings;
  run();
  for (int i = 0; i < Dim; ++i)
    findings.require_equal(lane_node_sum(s, 1 + i), lane_momentum(s, i), "momentum");
  const Sum all = lane_sum(s, [&](const auto& p, const auto&) {
    double sum = 0;
    for (int c = 0; c < s.memory.lanes.columns(); ++c) sum += p(c);
    return sum;
  });
  findings.require(std::isfinite(static_cast<double>(all.magnitude)), "a particle is spoilt");
  const int found = count_loaded_nodes(Exec(), s.memory.lanes, s.boundary);
  findings.require(found == expected_boundary_nodes(column), "the number of boundary nodes is wrong");
  return findings.text();
}

/// After so many calls of run(n) no particle of a rigid translation, no mass and no momentum is missing.
template <int Dim, class Real, class Run>
std::string check_moving(const Column<Dim, Real>& column, const Lane<Dim, Real>& s, int steps,
                         const Run& run) {
  Findings<Real> findings;
  const auto& lanes = s.memory.lanes;
  Sum momentum[Dim];
  const auto mass = [&] {
    return lane_sum(s, [&](const auto& p, const auto&) { return p(lanes.mass_column); });
  };
  const Sum masses = mass();
  for (int i = 0; i < Dim; ++i) momentum[i] = lane_momentum(s, i);
  for (int n = 0; n < steps; ++n) run(n);
  const auto id = snapshot(s.memory.lanes.id);
  std::vector<int> times(static_cast<size_t>(column.block.particles.count()), 0);
  for (int e = 0; e < s.memory.lanes.slot_count * s.memory.lanes.width; ++e)
    if (const int p = id(static_cast<size_t>(e)); p >= 0) ++times[static_cast<size_t>(p)];
  findings.require(std::count(times.begin(), times.end(), 1) == column.block.particles.count(),
                   "particles are missing or there twice");
  findings.require_equal(mass(), masses, "mass");
  for (int i = 0; i < Dim; ++i) {
    const Sum now = lane_momentum(s, i);
    findings.require_equal(now, momentum[i], "momentum");
  }
  return findings.text();
}

}  // namespace vsb::bench
