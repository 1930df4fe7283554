// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Brings particles that left their cell to their new one, and adds to the nodes what they give there; packs
/// all particles anew where one finds no place.
///
/// The layers a particle can come from are searched in a fixed order, each by the one thread that works on
/// the layer it goes to: the same order, and the same bits, for any number of threads.
#pragma once

#include <vsb/kernels/build_lanes.hpp>
#include <vsb/kernels/particles_to_grid.hpp>
#include <vsb/physics/multilinear.hpp>
#include <vsb/physics/shape.hpp>

namespace vsb {

namespace kernel {

/// One layer: takes in the leavers that go there. Counts those without a place, each once.
template <int Dim, class Real, class Device, class Field>
struct TakeInLeavers {
  CellLanes<Dim, Real, Device> lanes;
  LaneNodes<Dim, Real, Device> nodes;
  Leavers<Dim, Real, Device> leavers;
  UniformGrid<Dim, Real> grid;
  Field virtual_stress;
  BoundaryNodes<Device> tractions;  ///< [node of the lanes]
  bool scatter;                     ///< whether to add to the nodes

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
  KOKKOS_FUNCTION void operator()(int layer, int& homeless) const {
    for (int g = lanes.layer_first(layer); g < lanes.layer_first(layer + 1); ++g)
      while (lanes.groups(g).slots > 0 && last_slot_is_empty(lanes.groups(g))) --lanes.groups(g).slots;
    for (int from = math::max(layer - 1, 0); from <= math::min(layer + 1, lanes.layers() - 1); ++from)
      for (int n = leavers.first(from); n < leavers.first(from) + leavers.count(from); ++n) {
        auto& head = leavers.head(n);
        const int to = within(head.cell) ? layer_of(head.cell) : -2;
        const bool far = to < from - 1 || to > from + 1;
        if (to == layer && !far)
          head.homeless = !take_in(n, head);
        else if (far && from == layer)
          head.homeless = true;
        else
          continue;
        if (head.homeless) ++homeless;
      }
  }
  KOKKOS_FUNCTION bool last_slot_is_empty(const LaneGroup<Dim>& group) const {
    const size_t end = lanes.end(group);
    for (size_t e = end - lanes.width; e < end; ++e)
      if (lanes.id(e) >= 0) return false;
    return true;
  }
  KOKKOS_FUNCTION bool take_in(int n, const typename Leavers<Dim, Real, Device>::Head& head) const {
    constexpr int width = Lanes<Real>::width;
    const int x = head.cell[0] - lanes.box.first[0], lane = x % width;
    int row = layer_of(head.cell) * lanes.rows_per_layer();
    if constexpr (Dim == 3) row += head.cell[1] - lanes.box.first[1];
    const int g = lanes.group_at(row * lanes.groups_per_row() + x / width);
    if (g < 0) return false;
    auto& group = lanes.groups(g);
    for (int s = 0; s < group.capacity; ++s) {
      const size_t e = static_cast<size_t>(group.first + s) * width + static_cast<size_t>(lane);
      if (lanes.id(e) >= 0) continue;
      group.slots = math::max(group.slots, s + 1);
      for (int c = 0; c < lanes.columns(); ++c) *lanes.at(c, e) = leavers.data(n, c);
      lanes.id(e) = head.id;
      if (scatter) give_to_nodes(e, group, lane);
      return true;
    }
    return false;
  }

  /// Adds to the lower and upper sums of the layer.
  struct Sink {
    LaneNodes<Dim, Real, Device> nodes;
    KOKKOS_FUNCTION Real& operator()(int a, int node, int column) const {
      const bool upper = Dim > 1 && (a >> (Dim - 1) & 1);
      return *nodes.at((upper ? nodes.upper_sums : nodes.lower_sums) + column, node);
    }
  };
  KOKKOS_FUNCTION void give_to_nodes(size_t e, const LaneGroup<Dim>& group, int lane) const {
    Vector<Dim, Real> xi, v;
    SymmetricTensor<Dim, Real> sigma;
    for (int i = 0; i < Dim; ++i) {
      xi[i] = *lanes.at(lanes.xi_column + i, e);
      v[i] = *lanes.at(lanes.velocity_column + i, e);
    }
    for (int c = 0; c < sigma.size; ++c) sigma[c] = *lanes.at(lanes.stress_column + c, e);
    Shape<Dim, (1 << Dim), Real> shape;
    multilinear(xi, grid.inverse_spacing, shape.N, shape.dN);
    for (int a = 0; a < shape.support; ++a) shape.node[a] = group.node[a >> 1] + lane + (a & 1);
    add_particle(shape, grid.map(lanes.cell(group, lane), xi).x, v, sigma, *lanes.at(lanes.mass_column, e),
                 *lanes.at(lanes.volume_column, e), virtual_stress, tractions, Vector<Dim, Real>::zero(),
                 Sink{nodes});
  }
};

/// One list: the particles without a place, as far as a report of a lost one needs them.
template <int Dim, class Real, class Device>
struct UnpackHomeless {
  Leavers<Dim, Real, Device> leavers;
  Particles<Dim, Real, Device> particles;
  UniformGrid<Dim, Real> grid;
  KOKKOS_FUNCTION void operator()(int k) const {
    for (int n = leavers.first(k); n < leavers.first(k) + leavers.count(k); ++n) {
      const auto& head = leavers.head(n);
      if (!head.homeless) continue;
      Vector<Dim, Real> xi;
      for (int i = 0; i < Dim; ++i) xi[i] = leavers.data(n, i);
      const auto x = grid.map(head.cell, xi).x;
      for (int i = 0; i < Dim; ++i) {
        particles.position(head.id, i) = x[i];
        particles.velocity(head.id, i) = leavers.data(n, Dim + i);
      }
      particles.volume(head.id) = leavers.data(n, 2 * Dim + 1);
      for (int c = 0; c < particles.stress_size; ++c)
        particles.cauchy_stress(head.id, c) = leavers.data(n, 2 * Dim + 2 + c);
    }
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
      for (int s = 0; s < group.slots; ++s)
        n += before.id(static_cast<size_t>(group.first + s) * width + static_cast<size_t>(l)) >= 0;
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
        if (before.id(e) >= 0) source(entry(before.cell(group, l), n++)) = static_cast<int>(e);
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
      for (int n = leavers.first(k); n < leavers.first(k) + leavers.count(k); ++n) {
        const auto& head = leavers.head(n);
        if (!head.homeless) continue;
        if (counting) {
          ++count(box.bin_of_cell(head.cell));
          continue;
        }
        for (int s = 0;; ++s) {
          const size_t e = find.entry(head.cell, s);
          if (find.source(e) != -1) continue;
          find.source(e) = -2 - n;
          break;
        }
      }
  }
};

/// The range of cells along an axis: groups of the lanes, then homeless leavers; a single work item.
template <int Dim, class Real, class Device>
struct OccupiedRange {
  CellLanes<Dim, Real, Device> lanes;
  Leavers<Dim, Real, Device> leavers;
  Vector<Dim, int> grid_cells;
  Kokkos::View<int*, Device> result;  ///< lowest and highest cell by axis, and the number of a lost particle

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
    }
    int lost = -1;
    for (int g = 0; g < lanes.group_count; ++g) {
      const auto& group = lanes.groups(g);
      for (int l = 0; l < width; ++l)
        for (int s = 0; s < group.slots; ++s)
          if (lanes.id(static_cast<size_t>(group.first + s) * width + static_cast<size_t>(l)) >= 0) {
            include(lanes.cell(group, l));
            break;
          }
    }
    for (int k = 0; k < lanes.layers(); ++k)
      for (int n = leavers.first(k); n < leavers.first(k) + leavers.count(k); ++n) {
        const auto& head = leavers.head(n);
        if (!head.homeless) continue;
        bool inside = true;
        for (int i = 0; i < Dim; ++i) inside = inside && head.cell[i] >= 0 && head.cell[i] < grid_cells[i];
        if (inside)
          include(head.cell);
        else if (lost < 0 || head.id < lost)
          lost = head.id;
      }
    result(2 * Dim) = lost;
  }
};

/// One entry of one column of the new lanes.
template <int Dim, class Real, class Device>
struct TakeColumn {
  using Ints = typename CellLanes<Dim, Real, Device>::Ints;
  Kokkos::View<const Real*, Device> before;
  CellLanes<Dim, Real, Device> lanes;
  Leavers<Dim, Real, Device> leavers;
  Ints source;
  int column;
  KOKKOS_FUNCTION void operator()(int e) const {
    const int from = source(e);
    *lanes.at(column, static_cast<size_t>(e)) = from >= 0      ? before(from)
                                                : from <= -2   ? leavers.data(-2 - from, column)
                                                : column < Dim ? Real(0.5)
                                                               : Real(0);
  }
};

template <int Dim, class Real, class Device>
struct TakeIds {
  using Ints = typename CellLanes<Dim, Real, Device>::Ints;
  Ints before, id;
  Leavers<Dim, Real, Device> leavers;
  Ints source;
  KOKKOS_FUNCTION void operator()(int e) const {
    const int from = source(e);
    id(e) = from >= 0 ? before(from) : from <= -2 ? leavers.head(-2 - from).id : -1;
  }
};

}  // namespace kernel

/// Particles that left their cells in the last sweep. Waits for the device.
template <class Exec, int Dim, class Real, class Device>
int count_leavers(const Exec& exec, const LaneMemory<Dim, Real, Device>& m) {
  int count = 0;
  Kokkos::parallel_reduce("vsb::count_leavers", Kokkos::RangePolicy<Exec>(exec, 0, m.lanes.layers()),
                          kernel::AddUp<Device>{m.leavers.count}, count);
  exec.fence();
  return count;
}

/// Brings the leavers to their cells and, if asked to, adds them to the nodes. Returns how many found no
/// place; then repack_lanes must follow. Waits for the device.
template <class Exec, class Field, int Dim, class Real, class Device>
int take_in_leavers(const Exec& exec, const LaneMemory<Dim, Real, Device>& m, const Field& virtual_stress,
                    const BoundaryNodes<Device>& tractions, bool scatter) {
  int homeless = 0;
  Kokkos::parallel_reduce("vsb::take_in_leavers", Kokkos::RangePolicy<Exec>(exec, 0, m.lanes.layers()),
                          kernel::TakeInLeavers<Dim, Real, Device, Field>{m.lanes, m.nodes, m.leavers, m.grid,
                                                                          virtual_stress, tractions, scatter},
                          homeless);
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

/// Packs all particles anew, the leavers without a place among them. Returns -1, or the lowest number of a
/// particle outside the grid, and then nothing is packed.
template <class Exec, int Dim, class Real, class Device>
int repack_lanes(const Exec& exec, LaneMemory<Dim, Real, Device>& m) {
  using Cells = CellLanes<Dim, Real, Device>;
  using Ints = typename Cells::Ints;
  const Kokkos::RangePolicy<Exec> once(exec, 0, 1);
  const Cells before = m.lanes;
  const Kokkos::View<int*, Device> range("vsb::occupied_range", 2 * Dim + 1);
  Kokkos::parallel_for("vsb::occupied_range", once,
                       kernel::OccupiedRange<Dim, Real, Device>{before, m.leavers, m.grid.cells, range});
  exec.fence();
  const auto found = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), range);
  if (found(2 * Dim) >= 0) return found(2 * Dim);
  Vector<Dim, int> lowest, highest;
  for (int i = 0; i < Dim; ++i) {
    lowest[i] = found(static_cast<size_t>(2 * i));
    highest[i] = found(static_cast<size_t>(2 * i + 1));
  }
  const kernel::BoxBasis<Dim, Real> basis{m.grid, box_around<Dim, Real>(lowest, highest)};
  const Ints count("vsb::particles_of_cell", static_cast<size_t>(basis.bin_count()));
  const Kokkos::RangePolicy<Exec> over_groups(exec, 0, before.group_count);
  Kokkos::parallel_for("vsb::count_lanes", over_groups,
                       kernel::CountLanes<Dim, Real, Device>{before, basis, count});
  kernel::PlaceHomeless<Dim, Real, Device> place{{before, {}, {}}, m.leavers, basis, count, true};
  Kokkos::parallel_for("vsb::count_homeless", once, place);
  m.lanes.data = {};  // only `before` holds it now
  m.lanes.id = {};
  detail::number_lanes(exec, m, basis.box, count);
  auto& lanes = m.lanes;
  const int entries = lanes.slot_count * lanes.width;
  const Ints source("vsb::source_of_entry", static_cast<size_t>(entries));
  Kokkos::deep_copy(exec, source, -1);
  place.find = {before, lanes, source};
  place.counting = false;
  Kokkos::parallel_for("vsb::find_sources", over_groups, place.find);
  Kokkos::parallel_for("vsb::place_homeless", once, place);
  const bool fits = static_cast<int>(before.data.extent(0)) >= entries;
  if (fits) {
    lanes.data = before.data;
    lanes.id = Ints(Kokkos::view_alloc("vsb::lane_ids", Kokkos::WithoutInitializing), before.data.extent(0));
  } else {
    detail::allocate_particle_columns(lanes, lanes.slot_count + lanes.slot_count / 16);
  }
  const Kokkos::RangePolicy<Exec> over_entries(exec, 0, entries);
  const auto entries_before = static_cast<size_t>(before.slot_count * before.width);
  const Kokkos::View<Real*, Device> copy(
      Kokkos::view_alloc("vsb::column_before", Kokkos::WithoutInitializing), entries_before);
  for (int c = 0; c < lanes.columns(); ++c) {
    Kokkos::deep_copy(exec, copy, Kokkos::subview(before.data, std::make_pair(size_t(0), entries_before), c));
    Kokkos::parallel_for("vsb::take_column", over_entries,
                         kernel::TakeColumn<Dim, Real, Device>{copy, lanes, m.leavers, source, c});
  }
  Kokkos::parallel_for("vsb::take_ids", over_entries,
                       kernel::TakeIds<Dim, Real, Device>{before.id, lanes.id, m.leavers, source});
  exec.fence();
  detail::allocate_leavers(exec, m);
  return -1;
}

}  // namespace vsb
