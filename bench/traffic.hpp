// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The bytes that a kernel must at least move between memory and processor, per particle: every field it
/// reads once, every field it writes once, nodal and bin arrays shared out over the particles. What a
/// strategy adds (zeroing, copies per thread, sums per bin, the order of a sort) is its own cost and is not
/// counted.
#pragma once

#include "scene.hpp"

namespace vsb::bench {

template <int Dim, class Real>
struct Traffic {
  static constexpr double word = sizeof(Real), index = sizeof(int), mask = sizeof(TractionMask);
  static constexpr double stress = symmetric_components(Dim), sums = 1 + 2 * Dim;
  double nodes;  ///< nodes of the grid per particle
  double bins;   ///< bins of the grid per particle

  explicit Traffic(const Scene<Dim, Real>& s)
      : nodes(double(s.basis.node_count()) / s.block.particles.count()),
        bins(double(s.basis.bin_count()) / s.block.particles.count()) {}

  /// Reads x, v, m, V, sigma; writes the nodal sums; reads the boundary nodes where there is a load.
  double particles_to_grid(Load load) const {
    return word * (2 * Dim + 2 + stress) + nodes * (word * sums + (load == Load::off ? 0 : mask));
  }
  /// Reads the nodal sums and fixed components; writes a and v.
  double update_nodes() const { return nodes * (word * (sums + 2 * Dim) + sizeof(ComponentMask)); }
  /// Reads x, v and a; writes v.
  double grid_to_particles() const { return word * (3 * Dim + nodes * Dim); }
  /// Reads x, v, m, and nodal masses and fixed components; writes v*.
  double remap_velocity() const {
    return word * (2 * Dim + 1) + nodes * (word * (1 + Dim) + sizeof(ComponentMask));
  }
  /// Reads v and v*; reads and writes x, V, sigma.
  double update_stress() const { return word * (2 * (Dim + 1 + stress) + nodes * 2 * Dim); }
  /// Reads x and the declared tractions; writes the boundary nodes.
  double mark_boundary_nodes() const { return word * Dim + nodes * 2 * mask; }
  /// Reads x and the bin; writes the bin.
  double update_occupancy() const { return word * Dim + 2 * index; }
  /// Reads the bin; writes the order, and offset, slot and occupied of all bins.
  double sort_by_bin() const { return index * (2 + 3 * bins); }

  /// The phases of a step in which no particle changes its bin.
  double step(Load load) const {
    return update_occupancy() + particles_to_grid(load) + update_nodes() + grid_to_particles() +
           remap_velocity() + update_stress();
  }
};

template <class View>
double bytes(const View& view) {
  return static_cast<double>(view.span() * sizeof(typename View::value_type));
}

/// Bytes of particles, nodes, bins and boundary marking, and of what the scatter strategy keeps, per
/// particle.
template <int Dim, class Real>
double state_bytes(const Scene<Dim, Real>& scene) {
  const auto& s = scene.state;
  const auto& bins = s.occupancy.bins;
  const auto& cells = s.occupancy.cells;
  const auto& n = s.nodes;
  double sum = bytes(scene.block.block) + bytes(n.sums) + bytes(n.acceleration) + bytes(n.velocity) +
               bytes(n.remapped_velocity) + bytes(n.fixed_components) + bytes(bins.bin) + bytes(bins.order) +
               bytes(bins.offset) + bytes(bins.cursor) + bytes(bins.slot) + bytes(bins.occupied) +
               bytes(cells.occupied) + bytes(cells.exterior) + bytes(cells.boundary) +
               bytes(s.occupancy.tractions) + bytes(s.occupancy.boundary) +
               bytes(s.sums_workspace.particles.bin_sums) + bytes(s.remap_workspace.bin_sums);
  if (scene.options.scatter == Scatter::duplicated)
    sum += Exec().concurrency() * (bytes(n.sums) + bytes(n.remapped_velocity));
  return sum / s.particles.count();
}

}  // namespace vsb::bench
