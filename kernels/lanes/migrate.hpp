// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Migration: moves particles that left their cell to the lanes of their new cell, and adds them to the sums
/// of its nodes, m_I, p_I and f_I of kernels/lanes/sums.hpp.
///
/// One thread works on the layer to which particles go. It searches the layers from which they can come in a
/// fixed order, so that the bits are the same for any number of threads.
#pragma once

#include <vsb/kernels/lanes/build.hpp>
#include <vsb/kernels/lanes/spline_stencil.hpp>
#include <vsb/kernels/particles/particles_to_grid.hpp>
#include <vsb/physics/cell_mass_matrix.hpp>
#include <vsb/physics/multilinear.hpp>
#include <vsb/physics/shape.hpp>

namespace vsb {

namespace kernel {

/// Lanes of a slot whose particle found no group, or no free slot, at its new cell.
struct Overflow {
  LaneMask without_group, without_slot;
};

/// One layer: inserts the migrating particles that go there. Counts those without a group or slot, and the
/// layers whose sums must be computed anew.
template <int Dim, class Real, class Device, class Field>
struct InsertMigrating {
  static constexpr int width = Lanes<Real>::width;
  using P = typename Lanes<Real>::Pack;
  using Head = typename MigratingParticles<Dim, Real, Device>::Head;
  CellLanes<Dim, Real, Device> lanes;
  LaneNodes<Dim, Real, Device> nodes;
  MigratingParticles<Dim, Real, Device> migrating;
  UniformGrid<Dim, Real> grid;
  Field virtual_stress;
  BoundaryNodes<Device> tractions;  ///< [node of the lanes]
  bool compacting;                  ///< whether to fill empty entries from the last slots

  KOKKOS_FUNCTION int layer_of(const Vector<Dim, int>& cell) const {
    return Dim == 1 ? 0 : cell[Dim - 1] - lanes.box.first[Dim - 1];
  }
  /// The outermost cells of the box must stay void: Algorithm 1 needs the void cells around the body.
  KOKKOS_FUNCTION bool within(const Vector<Dim, int>& cell) const {
    for (int i = 0; i < Dim; ++i) {
      const int c = cell[i] - lanes.box.first[i];
      if (c < 1 || c > lanes.box.cells[i] - 2) return false;
      if (cell[i] < 0 || cell[i] >= grid.cells[i]) return false;
    }
    return true;
  }
  KOKKOS_FUNCTION void operator()(int layer, int& without_group, int& without_slot, int& unsummed) const {
    const int lowest_layer = math::max(layer - 1, 0),
              highest_layer = math::min(layer + 1, lanes.layers() - 1);
    int many = 0;
    for (int from = lowest_layer; from <= highest_layer; ++from) many |= migrating.many(from);
    migrating.unsummed(layer) = many;
    unsummed += many;
    for (int g = lanes.layer_first(layer); g < lanes.layer_first(layer + 1); ++g) {
      auto& group = lanes.groups(g);
      while (group.slots > 0 && lanes.with_particle(group.first + group.slots - 1) == 0) --group.slots;
    }
    for (int from = lowest_layer; from <= highest_layer; ++from)
      for (int n = migrating.first(from); n < migrating.first(from) + migrating.count(from); ++n) {
        auto& head = migrating.head(n);
        const int way = layer - from + 1;
        Overflow overflow{from == layer ? head.far : 0, 0};
        for (LaneMask left = head.to[way]; left != 0;) {
          const LaneMask together = with_the_first(head, left);
          insert(n, head, together, many == 0, overflow);
          left &= ~together;
        }
        head.overflow[way] = overflow.without_group | overflow.without_slot;
        for (int l = 0; l < width; ++l) {
          without_group += overflow.without_group >> l & 1;
          without_slot += overflow.without_slot >> l & 1;
        }
      }
    if (compacting)
      for (int g = lanes.layer_first(layer); g < lanes.layer_first(layer + 1); ++g) compact(lanes.groups(g));
  }
  /// Moves the particles of the last slots into empty entries of the slots before, as long as they fit.
  KOKKOS_FUNCTION void compact(LaneGroup<Dim>& group) const {
    for (; group.slots > 0; --group.slots) {
      const int last = group.first + group.slots - 1;
      LaneMask holes = 0;
      for (int s = group.first; s < last; ++s) holes |= ~lanes.with_particle(s);
      LaneMask moving = lanes.with_particle(last);
      if ((moving & ~holes) != 0) return;
      lanes.with_particle(last) = 0;
      for (int s = group.first; moving != 0; ++s) {
        const LaneMask fits = moving & ~lanes.with_particle(s);
        if (fits == 0) continue;
        const size_t from = static_cast<size_t>(last) * width, to = static_cast<size_t>(s) * width;
        const auto mask = P::Mask::from_bits(fits);
        for (int c = 0; c < lanes.columns(); ++c)
          lanes.store(c, to, math::select(mask, lanes.load(c, from), lanes.load(c, to)));
        for (size_t l = 0; l < width; ++l)
          if (fits >> l & 1) {
            lanes.id(to + l) = lanes.id(from + l);
            lanes.id(from + l) = -1;
          }
        lanes.with_particle(s) |= fits;
        moving &= ~fits;
      }
    }
  }
  /// The lanes whose particles move by the same offset of cells as that of the first lane.
  KOKKOS_FUNCTION static LaneMask with_the_first(const Head& head, LaneMask lanes) {
    const int first = lowest(lanes);
    LaneMask same = 0;
    for (int l = first; l < width; ++l) {
      if (!(lanes >> l & 1)) continue;
      bool together = head.cell[l][0] - l == head.cell[first][0] - first;
      for (int i = 1; i < Dim; ++i) together = together && head.cell[l][i] == head.cell[first][i];
      if (together) same |= LaneMask(1) << l;
    }
    return same;
  }
  KOKKOS_FUNCTION static int lowest(LaneMask lanes) {
    int l = 0;
    while (!(lanes >> l & 1)) ++l;
    return l;
  }
  /// Inserts the particles of some lanes of copy n, which move by the same offset. scatter: whether to add
  /// them to the nodal sums.
  KOKKOS_FUNCTION void insert(int n, const Head& head, LaneMask from, bool scatter,
                              Overflow& overflow) const {
    constexpr LaneMask all = ~LaneMask(0) >> (32 - width);
    for (int l = 0; l < width; ++l)
      if ((from >> l & 1) && !within(head.cell[l])) overflow.without_group |= LaneMask(1) << l;
    from &= ~overflow.without_group;
    if (from == 0) return;
    const int first = lowest(from);
    const auto& cell = head.cell[first];
    const int along = cell[0] - lanes.box.first[0] - (head.x * width + first);
    int row = layer_of(cell) * lanes.rows_per_layer();
    if constexpr (Dim == 3) row += cell[1] - lanes.box.first[1];
    if (along == 0) {
      put<0>(n, head, row, head.x, from, scatter, overflow);
    } else if (along == 1) {
      put<1>(n, head, row, head.x, from << 1 & all, scatter, overflow);
      put<1>(n, head, row, head.x + 1, from >> (width - 1), scatter, overflow);
    } else if (along == -1) {
      put<-1>(n, head, row, head.x, from >> 1, scatter, overflow);
      put<-1>(n, head, row, head.x - 1, from << (width - 1) & all, scatter, overflow);
    } else {
      overflow.without_group |= from;
    }
  }
  /// Puts particles of copy n into lanes of a group, shifted by `Along` lanes.
  template <int Along>
  KOKKOS_FUNCTION void put(int n, const Head& head, int row, int x, LaneMask into, bool scatter,
                           Overflow& overflow) const {
    if (into == 0) return;
    const int g = lanes.group_of(row, x);
    if (g < 0) {
      overflow.without_group |= lanes_before<Along>(into);
      return;
    }
    auto& group = lanes.groups(g);
    for (int s = 0; s < group.capacity && into != 0; ++s) {
      auto& with_particle = lanes.with_particle(group.first + s);
      const LaneMask fits = into & ~with_particle;
      if (fits == 0) continue;
      const size_t entry = static_cast<size_t>(group.first + s) * width;
      const auto mask = P::Mask::from_bits(fits);
      const bool fresh = s >= group.slots;  // the numbers in such a slot are stale
      for (int c = 0; c < lanes.columns(); ++c) {
        const P moved = rotated<Along>(P::load(&migrating.data(n, c * width)));
        const P others = fresh ? P(c < Dim ? Real(0.5) : Real(0)) : lanes.load(c, entry);
        lanes.store(c, entry, math::select(mask, moved, others));
      }
      with_particle |= fits;
      into &= ~fits;
      group.slots = math::max(group.slots, s + 1);
      for (int l = 0; l < width; ++l) {
        if (!(fits >> l & 1)) continue;
        const size_t e = entry + static_cast<size_t>(l);
        lanes.id(e) = head.id[(l - Along + width) % width];
        if (scatter) scatter_to_nodes(e, group, g, l);
      }
    }
    overflow.without_slot |= lanes_before<Along>(into);
  }
  /// The lanes from which particles come to these.
  template <int Along>
  KOKKOS_FUNCTION static LaneMask lanes_before(LaneMask lanes) {
    LaneMask before = 0;
    for (int l = 0; l < width; ++l)
      if (lanes >> l & 1) before |= LaneMask(1) << (l - Along + width) % width;
    return before;
  }

  /// Adds to the lower and upper sums of the layer.
  struct Sink {
    LaneNodes<Dim, Real, Device> nodes;
    KOKKOS_FUNCTION Real& operator()(int a, int node, int column) const {
      const bool upper = Dim > 1 && (a >> (Dim - 1) & 1);
      return *nodes.at((upper ? nodes.upper_sums : nodes.lower_sums) + column, node);
    }
  };
  KOKKOS_FUNCTION void scatter_to_nodes(size_t e, const LaneGroup<Dim>& group, int g, int lane) const {
    Vector<Dim, Real> xi, v;
    SymmetricTensor<Dim, Real> sigma;
    for (int i = 0; i < Dim; ++i) {
      xi[i] = *lanes.at(lanes.xi_column + i, e);
      v[i] = *lanes.at(lanes.velocity_column + i, e);
    }
    for (int c = 0; c < sigma.size; ++c) sigma[c] = *lanes.at(lanes.stress_column + c, e);
    if (lanes.node_centred) {
      add_particle(stencil_shape(lanes.stencils(g), lane, xi, grid.inverse_spacing),
                   grid.map(lanes.cell(group, lane), xi).x, v, sigma, *lanes.at(lanes.mass_column, e),
                   *lanes.at(lanes.volume_column, e), virtual_stress, tractions, Vector<Dim, Real>::zero(),
                   StencilSink<Dim, Real, Device>{nodes});
      return;
    }
    Shape<Dim, (1 << Dim), Real> shape;
    multilinear(xi, grid.inverse_spacing, shape.N, shape.dN);
    for (int a = 0; a < shape.support; ++a) shape.node[a] = group.node[a >> 1] + lane + (a & 1);
    add_particle(shape, grid.map(lanes.cell(group, lane), xi).x, v, sigma, *lanes.at(lanes.mass_column, e),
                 *lanes.at(lanes.volume_column, e), virtual_stress, tractions, Vector<Dim, Real>::zero(),
                 Sink{nodes});
    if (!lanes.remaps_by_mass_matrix()) return;
    auto M = CellMassMatrix<Dim, Real>::zero();
    add_mass<Dim>(M, *lanes.at(lanes.mass_column, e), xi);
    for (int k = 0; k < M.size; ++k) lanes.mass_matrix_at(g, k)[lane] += M[k];
  }
};

template <class Device>
struct AddUp {
  Kokkos::View<int*, Device> count;
  KOKKOS_FUNCTION void operator()(int k, int& sum) const { sum += count(k); }
};

}  // namespace kernel

/// Particles that left their cells in the last sweep. Waits for the device.
template <class Exec, int Dim, class Real, class Device>
int count_migrating(const Exec& exec, const LaneMemory<Dim, Real, Device>& m) {
  int count = 0;
  Kokkos::parallel_reduce("vsb::count_migrating", Kokkos::RangePolicy<Exec>(exec, 0, m.lanes.layers()),
                          kernel::AddUp<Device>{m.migrating.lost}, count);
  exec.fence();
  return count;
}

/// How many particles found no group at their new cell, or no free slot in it; and how many layers are
/// without sums.
struct OverflowCount {
  ///@{
  /// Numbers of particles, and of layers.
  int without_group = 0, without_slot = 0, unsummed_layers = 0;
  ///@}
  /// Whether a particle found no position, so that all are to be packed anew.
  bool any() const { return without_group + without_slot > 0; }
};

/// Moves the migrating particles to the lanes of their new cells. Adds them to the nodal sums, unless there
/// are many: then the sums of the layer are to be computed anew. compacting: fills empty entries from the
/// last slots. Where particles found no group or slot, repack_lanes must follow. Waits for the device.
template <class Exec, class Field, int Dim, class Real, class Device>
OverflowCount insert_migrating(const Exec& exec, const LaneMemory<Dim, Real, Device>& m,
                               const Field& virtual_stress, const BoundaryNodes<Device>& tractions,
                               bool compacting) {
  OverflowCount overflow;
  Kokkos::parallel_reduce("vsb::insert_migrating", Kokkos::RangePolicy<Exec>(exec, 0, m.lanes.layers()),
                          kernel::InsertMigrating<Dim, Real, Device, Field>{
                              m.lanes, m.nodes, m.migrating, m.grid, virtual_stress, tractions, compacting},
                          overflow.without_group, overflow.without_slot, overflow.unsummed_layers);
  exec.fence();
  return overflow;
}

}  // namespace vsb
