// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Brings particles that left their cell to their new one, and adds to the nodes what they give there; packs
/// all particles anew where one finds no place.
///
/// The layers a particle can come from are searched in a fixed order, each by the one thread that works on
/// the layer it goes to: the same order, and the same bits, for any number of threads.
#pragma once

#include <vsb/kernels/build_lanes.hpp>
#include <vsb/kernels/give_to_stencil.hpp>
#include <vsb/kernels/particles_to_grid.hpp>
#include <vsb/physics/cell_mass_matrix.hpp>
#include <vsb/physics/multilinear.hpp>
#include <vsb/physics/shape.hpp>

namespace vsb {

namespace kernel {

/// Lanes of a slot whose particle found no place where it went.
struct Homeless {
  LaneMask without_group, without_slot;
};

/// One layer: takes in the leavers that go there. Counts those without a place, each once, and layers whose
/// sums are to be made anew.
template <int Dim, class Real, class Device, class Field>
struct TakeInLeavers {
  static constexpr int width = Lanes<Real>::width;
  using P = typename Lanes<Real>::Pack;
  using Head = typename Leavers<Dim, Real, Device>::Head;
  CellLanes<Dim, Real, Device> lanes;
  LaneNodes<Dim, Real, Device> nodes;
  Leavers<Dim, Real, Device> leavers;
  UniformGrid<Dim, Real> grid;
  Field virtual_stress;
  BoundaryNodes<Device> tractions;  ///< [node of the lanes]
  bool closing;                     ///< whether to close ranks

  KOKKOS_FUNCTION int layer_of(const Vector<Dim, int>& cell) const {
    return Dim == 1 ? 0 : cell[Dim - 1] - lanes.box.first[Dim - 1];
  }
  /// The outermost cells of the box must stay void, or the cells around the body would not be known.
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
    for (int from = lowest_layer; from <= highest_layer; ++from) many |= leavers.many(from);
    leavers.unsummed(layer) = many;
    unsummed += many;
    for (int g = lanes.layer_first(layer); g < lanes.layer_first(layer + 1); ++g) {
      auto& group = lanes.groups(g);
      while (group.slots > 0 && lanes.held(group.first + group.slots - 1) == 0) --group.slots;
    }
    for (int from = lowest_layer; from <= highest_layer; ++from)
      for (int n = leavers.first(from); n < leavers.first(from) + leavers.count(from); ++n) {
        auto& head = leavers.head(n);
        const int way = layer - from + 1;
        Homeless homeless{from == layer ? head.far : 0, 0};
        for (LaneMask left = head.to[way]; left != 0;) {
          const LaneMask together = with_the_first(head, left);
          take_in(n, head, together, many == 0, homeless);
          left &= ~together;
        }
        head.homeless[way] = homeless.without_group | homeless.without_slot;
        for (int l = 0; l < width; ++l) {
          without_group += homeless.without_group >> l & 1;
          without_slot += homeless.without_slot >> l & 1;
        }
      }
    if (closing)
      for (int g = lanes.layer_first(layer); g < lanes.layer_first(layer + 1); ++g)
        close_ranks(lanes.groups(g));
  }
  /// Empties the last slots into holes of those before, as far as there are any.
  KOKKOS_FUNCTION void close_ranks(LaneGroup<Dim>& group) const {
    for (; group.slots > 0; --group.slots) {
      const int last = group.first + group.slots - 1;
      LaneMask holes = 0;
      for (int s = group.first; s < last; ++s) holes |= ~lanes.held(s);
      LaneMask moving = lanes.held(last);
      if ((moving & ~holes) != 0) return;
      lanes.held(last) = 0;
      for (int s = group.first; moving != 0; ++s) {
        const LaneMask fits = moving & ~lanes.held(s);
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
        lanes.held(s) |= fits;
        moving &= ~fits;
      }
    }
  }
  /// The lanes whose particles go the same way as that of the first.
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
  /// Particles of these lanes of copy n, which go the same way; `scatter`: whether to add to the nodes.
  KOKKOS_FUNCTION void take_in(int n, const Head& head, LaneMask from, bool scatter,
                               Homeless& homeless) const {
    constexpr LaneMask all = ~LaneMask(0) >> (32 - width);
    for (int l = 0; l < width; ++l)
      if ((from >> l & 1) && !within(head.cell[l])) homeless.without_group |= LaneMask(1) << l;
    from &= ~homeless.without_group;
    if (from == 0) return;
    const int first = lowest(from);
    const auto& cell = head.cell[first];
    const int along = cell[0] - lanes.box.first[0] - (head.x * width + first);
    int row = layer_of(cell) * lanes.rows_per_layer();
    if constexpr (Dim == 3) row += cell[1] - lanes.box.first[1];
    if (along == 0) {
      put<0>(n, head, row, head.x, from, scatter, homeless);
    } else if (along == 1) {
      put<1>(n, head, row, head.x, from << 1 & all, scatter, homeless);
      put<1>(n, head, row, head.x + 1, from >> (width - 1), scatter, homeless);
    } else if (along == -1) {
      put<-1>(n, head, row, head.x, from >> 1, scatter, homeless);
      put<-1>(n, head, row, head.x - 1, from << (width - 1) & all, scatter, homeless);
    } else {
      homeless.without_group |= from;
    }
  }
  /// Puts particles of copy n, `Along` lanes on, into lanes of a group.
  template <int Along>
  KOKKOS_FUNCTION void put(int n, const Head& head, int row, int x, LaneMask into, bool scatter,
                           Homeless& homeless) const {
    if (into == 0) return;
    const int g = lanes.group_of(row, x);
    if (g < 0) {
      homeless.without_group |= lanes_before<Along>(into);
      return;
    }
    auto& group = lanes.groups(g);
    for (int s = 0; s < group.capacity && into != 0; ++s) {
      auto& held = lanes.held(group.first + s);
      const LaneMask fits = into & ~held;
      if (fits == 0) continue;
      const size_t entry = static_cast<size_t>(group.first + s) * width;
      const auto mask = P::Mask::from_bits(fits);
      const bool fresh = s >= group.slots;  // what such a slot holds is old
      for (int c = 0; c < lanes.columns(); ++c) {
        const P moved = rotated<Along>(P::load(&leavers.data(n, c * width)));
        const P others = fresh ? P(c < Dim ? Real(0.5) : Real(0)) : lanes.load(c, entry);
        lanes.store(c, entry, math::select(mask, moved, others));
      }
      held |= fits;
      into &= ~fits;
      group.slots = math::max(group.slots, s + 1);
      for (int l = 0; l < width; ++l) {
        if (!(fits >> l & 1)) continue;
        const size_t e = entry + static_cast<size_t>(l);
        lanes.id(e) = head.id[(l - Along + width) % width];
        if (scatter) give_to_nodes(e, group, g, l);
      }
    }
    homeless.without_slot |= lanes_before<Along>(into);
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
  KOKKOS_FUNCTION void give_to_nodes(size_t e, const LaneGroup<Dim>& group, int g, int lane) const {
    Vector<Dim, Real> xi, v;
    SymmetricTensor<Dim, Real> sigma;
    for (int i = 0; i < Dim; ++i) {
      xi[i] = *lanes.at(lanes.xi_column + i, e);
      v[i] = *lanes.at(lanes.velocity_column + i, e);
    }
    for (int c = 0; c < sigma.size; ++c) sigma[c] = *lanes.at(lanes.stress_column + c, e);
    if (lanes.dual) {
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
    if (!lanes.one_sweep()) return;
    auto M = CellMassMatrix<Dim, Real>::zero();
    add_mass<Dim>(M, *lanes.at(lanes.mass_column, e), xi);
    for (int k = 0; k < M.size; ++k) lanes.mass_matrix_at(g, k)[lane] += M[k];
  }
};

/// One list: the particles without a place, as far as a report of a lost one needs them.
template <int Dim, class Real, class Device>
struct UnpackHomeless {
  Leavers<Dim, Real, Device> leavers;
  Particles<Dim, Real, Device> particles;
  UniformGrid<Dim, Real> grid;
  KOKKOS_FUNCTION void operator()(int k) const {
    using Columns = CellLanes<Dim, Real, Device>;
    leavers.for_each_homeless(k, [&](int n, int l) {
      const auto& head = leavers.head(n);
      const int id = head.id[l];
      const auto number = [&](int column) { return leavers.data(n, column * leavers.width + l); };
      Vector<Dim, Real> xi;
      for (int i = 0; i < Dim; ++i) xi[i] = number(Columns::xi_column + i);
      const auto x = grid.map(head.cell[l], xi).x;
      for (int i = 0; i < Dim; ++i) {
        particles.position(id, i) = x[i];
        particles.velocity(id, i) = number(Columns::velocity_column + i);
      }
      particles.volume(id) = number(Columns::volume_column);
      for (int c = 0; c < particles.stress_size; ++c)
        particles.cauchy_stress(id, c) = number(Columns::stress_column + c);
    });
  }
};

template <class Device>
struct AddUp {
  Kokkos::View<int*, Device> count;
  KOKKOS_FUNCTION void operator()(int k, int& sum) const { sum += count(k); }
};

/// One group of the lanes before: counts its particles into the cells of the new box.
template <int Dim, class Real, class Device>
struct CountLanes {
  CellLanes<Dim, Real, Device> before;
  BoxBasis<Dim, Real> box;
  typename CellLanes<Dim, Real, Device>::Ints count;
  KOKKOS_FUNCTION void operator()(int g) const {
    constexpr int width = Lanes<Real>::width;
    const auto& group = before.groups(g);
    for (int l = 0; l < width; ++l) {
      int n = 0;
      for (int s = group.first; s < group.first + group.slots; ++s) n += before.held(s) >> l & 1;
      if (n > 0) count(box.bin_of_cell(before.cell(group, l))) = n;
    }
  }
};

/// Where every entry of the new lanes comes from: an entry of those before (>= 0), a leaver (-2 - n), or
/// nowhere (-1). One group of those before.
template <int Dim, class Real, class Device>
struct FindSources {
  CellLanes<Dim, Real, Device> before, lanes;
  typename CellLanes<Dim, Real, Device>::Ints source;
  KOKKOS_FUNCTION size_t entry(const Vector<Dim, int>& cell, int slot) const {
    constexpr int width = Lanes<Real>::width;
    int row = Dim == 1 ? 0 : cell[Dim - 1] - lanes.box.first[Dim - 1];
    if constexpr (Dim == 3) row = row * lanes.rows_per_layer() + cell[1] - lanes.box.first[1];
    const int x = cell[0] - lanes.box.first[0];
    const auto& group = lanes.groups(lanes.group_at(row * lanes.groups_per_row() + x / width));
    return static_cast<size_t>(group.first + slot) * width + static_cast<size_t>(x % width);
  }
  KOKKOS_FUNCTION void operator()(int g) const {
    constexpr int width = Lanes<Real>::width;
    const auto& group = before.groups(g);
    for (int l = 0; l < width; ++l) {
      int n = 0;
      for (int s = 0; s < group.slots; ++s) {
        const size_t e = static_cast<size_t>(group.first + s) * width + static_cast<size_t>(l);
        if (before.held(group.first + s) >> l & 1)
          source(entry(before.cell(group, l), n++)) = static_cast<int>(e);
      }
    }
  }
};

/// The leavers without a place, list by list; a single work item. First counts them into their cells, then
/// finds the entries they go to.
template <int Dim, class Real, class Device>
struct PlaceHomeless {
  FindSources<Dim, Real, Device> find;
  Leavers<Dim, Real, Device> leavers;
  BoxBasis<Dim, Real> box;
  typename CellLanes<Dim, Real, Device>::Ints count;
  bool counting;
  KOKKOS_FUNCTION void operator()(int) const {
    for (int k = 0; k < find.before.layers(); ++k)
      leavers.for_each_homeless(k, [&](int n, int l) {
        const auto& cell = leavers.head(n).cell[l];
        if (counting) {
          ++count(box.bin_of_cell(cell));
          return;
        }
        int s = 0;
        while (find.source(find.entry(cell, s)) != -1) ++s;
        find.source(find.entry(cell, s)) = -2 - (n * leavers.width + l);
      });
  }
};

/// The range of cells that hold particles or will hold a homeless leaver, and which way those went that found
/// no group; a single work item.
template <int Dim, class Real, class Device>
struct OccupiedRange {
  CellLanes<Dim, Real, Device> lanes;
  Leavers<Dim, Real, Device> leavers;
  Vector<Dim, int> grid_cells;
  Kokkos::View<int*, Device> result;  ///< lowest and highest cell by axis, whether any went below or above,
                                      ///< by axis, and the number of a lost particle

  KOKKOS_FUNCTION void include(const Vector<Dim, int>& cell) const {
    for (int i = 0; i < Dim; ++i) {
      result(2 * i) = math::min(result(2 * i), cell[i]);
      result(2 * i + 1) = math::max(result(2 * i + 1), cell[i]);
    }
  }
  KOKKOS_FUNCTION void operator()(int) const {
    constexpr int width = Lanes<Real>::width;
    for (int i = 0; i < Dim; ++i) {
      result(2 * i) = grid_cells[i];
      result(2 * i + 1) = -1;
      result(2 * Dim + 2 * i) = result(2 * Dim + 2 * i + 1) = 0;
    }
    int lost = -1;
    for (int g = 0; g < lanes.group_count; ++g) {
      const auto& group = lanes.groups(g);
      const LaneMask cells = lanes.cells_with_particles(group);
      for (int l = 0; l < width; ++l)
        if (cells >> l & 1) include(lanes.cell(group, l));
    }
    for (int k = 0; k < lanes.layers(); ++k)
      leavers.for_each_homeless(k, [&](int n, int l) {
        const auto& cell = leavers.head(n).cell[l];
        const int id = leavers.head(n).id[l];
        bool inside = true;
        for (int i = 0; i < Dim; ++i) inside = inside && cell[i] >= 0 && cell[i] < grid_cells[i];
        if (inside) {
          include(cell);
          note_way(leavers.head(n), l);
        } else if (lost < 0 || id < lost) {
          lost = id;
        }
      });
    result(4 * Dim) = lost;
  }
  KOKKOS_FUNCTION void note_way(const typename Leavers<Dim, Real, Device>::Head& head, int lane) const {
    LaneGroup<Dim> from{};
    from.x = head.x;
    from.row = head.row;
    const auto before = lanes.cell(from, lane);
    for (int i = 0; i < Dim; ++i) {
      if (head.cell[lane][i] < before[i]) result(2 * Dim + 2 * i) = 1;
      if (head.cell[lane][i] > before[i]) result(2 * Dim + 2 * i + 1) = 1;
    }
  }
};

/// One column of a group of the lanes before: the slots in use, to where they cannot be overwritten.
template <int Dim, class Real, class Device>
struct SaveColumn {
  CellLanes<Dim, Real, Device> before;
  Kokkos::View<Real*, Device> column_before;
  int column;
  KOKKOS_FUNCTION void operator()(int g) const {
    const auto& group = before.groups(g);
    for (size_t e = before.begin(group); e < before.end(group); ++e) column_before(e) = *before.at(column, e);
  }
};

/// One column of a group of the new lanes: the slots in use.
template <int Dim, class Real, class Device>
struct TakeColumn {
  using Ints = typename CellLanes<Dim, Real, Device>::Ints;
  Kokkos::View<const Real*, Device> before;
  CellLanes<Dim, Real, Device> lanes;
  Leavers<Dim, Real, Device> leavers;
  Ints source;
  int column;
  KOKKOS_FUNCTION void operator()(int g) const {
    const auto& group = lanes.groups(g);
    const Real ghost = column < Dim ? Real(0.5) : Real(0);
    for (size_t e = lanes.begin(group); e < lanes.end(group); ++e) {
      const int from = source(e), leaver = -2 - from, width = lanes.width;
      *lanes.at(column, e) = from >= 0     ? before(from)
                             : leaver >= 0 ? leavers.data(leaver / width, column * width + leaver % width)
                                           : ghost;
    }
  }
};

/// One slot of the new lanes: who is in it.
template <int Dim, class Real, class Device>
struct TakeIds {
  typename CellLanes<Dim, Real, Device>::Ints before;
  CellLanes<Dim, Real, Device> lanes;
  Leavers<Dim, Real, Device> leavers;
  typename CellLanes<Dim, Real, Device>::Ints source;
  KOKKOS_FUNCTION void operator()(int slot) const {
    constexpr int width = Lanes<Real>::width;
    LaneMask held = 0;
    for (int l = 0; l < width; ++l) {
      const int e = slot * width + l, from = source(e), leaver = -2 - from;
      lanes.id(e) = from >= 0     ? before(from)
                    : leaver >= 0 ? leavers.head(leaver / width).id[leaver % width]
                                  : -1;
      if (from != -1) held |= LaneMask(1) << l;
    }
    lanes.held(slot) = held;
  }
};

}  // namespace kernel

/// Particles that left their cells in the last sweep. Waits for the device.
template <class Exec, int Dim, class Real, class Device>
int count_leavers(const Exec& exec, const LaneMemory<Dim, Real, Device>& m) {
  int count = 0;
  Kokkos::parallel_reduce("vsb::count_leavers", Kokkos::RangePolicy<Exec>(exec, 0, m.lanes.layers()),
                          kernel::AddUp<Device>{m.leavers.lost}, count);
  exec.fence();
  return count;
}

/// How many particles found no place where they went, for want of a group there, or of a slot in it; and how
/// many layers are without sums.
struct HomelessCount {
  int without_group = 0, without_slot = 0, unsummed_layers = 0;
  bool any() const { return without_group + without_slot > 0; }
};

/// Brings the leavers to their cells, adds them to the nodes where there are not too many of them, and, if
/// asked to, empties last slots into holes (closing). Where some found no place, repack_lanes must follow.
/// Waits for the device.
template <class Exec, class Field, int Dim, class Real, class Device>
HomelessCount take_in_leavers(const Exec& exec, const LaneMemory<Dim, Real, Device>& m,
                              const Field& virtual_stress, const BoundaryNodes<Device>& tractions,
                              bool closing) {
  HomelessCount homeless;
  Kokkos::parallel_reduce("vsb::take_in_leavers", Kokkos::RangePolicy<Exec>(exec, 0, m.lanes.layers()),
                          kernel::TakeInLeavers<Dim, Real, Device, Field>{m.lanes, m.nodes, m.leavers, m.grid,
                                                                          virtual_stress, tractions, closing},
                          homeless.without_group, homeless.without_slot, homeless.unsummed_layers);
  exec.fence();
  return homeless;
}

/// Writes back the leavers without a place, which unpack_particles does not know.
template <class Exec, int Dim, class Real, class Device>
void unpack_homeless(const Exec& exec, const LaneMemory<Dim, Real, Device>& m,
                     const Particles<Dim, Real, Device>& particles) {
  Kokkos::parallel_for("vsb::unpack_homeless", Kokkos::RangePolicy<Exec>(exec, 0, m.lanes.layers()),
                       kernel::UnpackHomeless<Dim, Real, Device>{m.leavers, particles, m.grid});
}

/// Packs all particles anew, the leavers without a place among them. reach_out: with groups where these went.
/// Returns -1, or the lowest number of a particle outside the grid, and then nothing is packed.
template <class Exec, int Dim, class Real, class Device>
int repack_lanes(const Exec& exec, LaneMemory<Dim, Real, Device>& m, bool reach_out = false) {
  using Cells = CellLanes<Dim, Real, Device>;
  using Ints = typename Cells::Ints;
  const Kokkos::RangePolicy<Exec> once(exec, 0, 1);
  const Cells before = m.lanes;
  const Kokkos::View<int*, Device> range("vsb::occupied_range", 4 * Dim + 1);
  Kokkos::parallel_for("vsb::occupied_range", once,
                       kernel::OccupiedRange<Dim, Real, Device>{before, m.leavers, m.grid.cells, range});
  exec.fence();
  const auto found = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), range);
  if (found(4 * Dim) >= 0) return found(4 * Dim);
  Vector<Dim, int> lowest, highest;
  for (int i = 0; i < Dim; ++i) {
    lowest[i] = found(static_cast<size_t>(2 * i));
    highest[i] = found(static_cast<size_t>(2 * i + 1));
    const auto way = static_cast<size_t>(2 * Dim + 2 * i);
    const int far = i == 0 ? 1 : math::min(math::max((highest[i] - lowest[i]) / 4, 2), 8);
    if (reach_out && found(way) != 0) m.reach.below[i] = far;
    if (reach_out && found(way + 1) != 0) m.reach.above[i] = far;
  }
  const kernel::BoxBasis<Dim, Real> basis{m.grid, box_around<Dim, Real>(lowest, highest, m.reach)};
  const Ints count("vsb::particles_of_cell", static_cast<size_t>(basis.bin_count()));
  const Kokkos::RangePolicy<Exec> over_groups(exec, 0, before.group_count);
  Kokkos::parallel_for("vsb::count_lanes", over_groups,
                       kernel::CountLanes<Dim, Real, Device>{before, basis, count});
  kernel::PlaceHomeless<Dim, Real, Device> place{{before, {}, {}}, m.leavers, basis, count, true};
  Kokkos::parallel_for("vsb::count_homeless", once, place);
  m.lanes.data = {};  // only `before` holds it now
  m.lanes.id = {};
  m.lanes.held = {};
  detail::number_lanes(exec, m, basis.box, count);
  auto& lanes = m.lanes;
  const int entries = lanes.slot_count * lanes.width;
  const Ints source = detail::scratch(m.source, static_cast<size_t>(entries));
  Kokkos::deep_copy(exec, source, -1);
  place.find = {before, lanes, source};
  place.counting = false;
  Kokkos::parallel_for("vsb::find_sources", over_groups, place.find);
  Kokkos::parallel_for("vsb::place_homeless", once, place);
  const bool fits = static_cast<int>(before.data.extent(0)) >= entries;
  if (fits)
    lanes.data = before.data;
  else
    detail::allocate_columns(lanes, lanes.slot_count);
  detail::allocate_numbers(lanes, lanes.slot_count);
  const auto copy = detail::scratch(m.column_before, static_cast<size_t>(before.slot_count * before.width));
  for (int c = 0; c < lanes.columns(); ++c) {
    Kokkos::parallel_for("vsb::save_column", over_groups,
                         kernel::SaveColumn<Dim, Real, Device>{before, copy, c});
    Kokkos::parallel_for("vsb::take_column", Kokkos::RangePolicy<Exec>(exec, 0, lanes.group_count),
                         kernel::TakeColumn<Dim, Real, Device>{copy, lanes, m.leavers, source, c});
  }
  Kokkos::parallel_for("vsb::take_ids", Kokkos::RangePolicy<Exec>(exec, 0, lanes.slot_count),
                       kernel::TakeIds<Dim, Real, Device>{before.id, lanes, m.leavers, source});
  exec.fence();
  detail::allocate_leavers(exec, m);
  return -1;
}

}  // namespace vsb
