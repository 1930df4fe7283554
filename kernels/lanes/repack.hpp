// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Packs all particles of cell lanes anew, where a migrating particle finds no group or slot
/// (kernels/lanes/migrate.hpp).
#pragma once

#include <vsb/kernels/lanes/build.hpp>

namespace vsb {

namespace kernel {

/// One list: the particles without a group or slot.
template <int Dim, class Real, class Device>
struct UnpackOverflow {
  MigratingParticles<Dim, Real, Device> migrating;
  Particles<Dim, Real, Device> particles;
  UniformGrid<Dim, Real> grid;
  int state_size;  ///< numbers of material state
  KOKKOS_FUNCTION void operator()(int k) const {
    using Columns = CellLanes<Dim, Real, Device>;
    migrating.for_each_overflow(k, [&](int n, int l) {
      const auto& head = migrating.head(n);
      const int id = head.id[l];
      const auto number = [&](int column) { return migrating.data(n, column * migrating.width + l); };
      Vector<Dim, Real> xi;
      for (int i = 0; i < Dim; ++i) xi[i] = number(Columns::xi_column + i);
      const auto x = grid.map(head.cell[l], xi).x;
      for (int i = 0; i < Dim; ++i) {
        particles.position(id, i) = x[i];
        particles.velocity(id, i) = number(Columns::velocity_column + i);
      }
      particles.mass(id) = number(Columns::mass_column);
      particles.volume(id) = number(Columns::volume_column);
      for (int c = 0; c < particles.stress_size; ++c)
        particles.cauchy_stress(id, c) = number(Columns::stress_column + c);
      for (int c = 0; c < state_size; ++c)
        particles.material_state(id, c) = number(Columns::state_column + c);
    });
  }
};

/// One group of the old lanes: counts its particles by cell of the new box.
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
      for (int s = group.first; s < group.first + group.slots; ++s) n += before.with_particle(s) >> l & 1;
      if (n > 0) count(box.bin_of_cell(before.cell(group, l))) = n;
    }
  }
};

/// The source of every entry of the new lanes: an entry of the old lanes (>= 0), a migrating particle (-2 -
/// n), or none (-1). One group of the old lanes.
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
        if (before.with_particle(group.first + s) >> l & 1)
          source(entry(before.cell(group, l), n++)) = static_cast<int>(e);
      }
    }
  }
};

/// The migrating particles without a group or slot, list by list; a single work item. The first launch counts
/// them by cell; the second finds their entries.
template <int Dim, class Real, class Device>
struct InsertOverflow {
  FindSources<Dim, Real, Device> find;
  MigratingParticles<Dim, Real, Device> migrating;
  BoxBasis<Dim, Real> box;
  typename CellLanes<Dim, Real, Device>::Ints count;
  bool counting;
  KOKKOS_FUNCTION void operator()(int) const {
    for (int k = 0; k < find.before.layers(); ++k)
      migrating.for_each_overflow(k, [&](int n, int l) {
        const auto& cell = migrating.head(n).cell[l];
        if (counting) {
          ++count(box.bin_of_cell(cell));
          return;
        }
        int s = 0;
        while (find.source(find.entry(cell, s)) != -1) ++s;
        find.source(find.entry(cell, s)) = -2 - (n * migrating.width + l);
      });
  }
};

/// The range of cells that hold particles or will hold a particle that found no group or slot, and the
/// directions in which particles moved that found no group; a single work item.
template <int Dim, class Real, class Device>
struct OccupiedRange {
  CellLanes<Dim, Real, Device> lanes;
  MigratingParticles<Dim, Real, Device> migrating;
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
      migrating.for_each_overflow(k, [&](int n, int l) {
        const auto& cell = migrating.head(n).cell[l];
        const int id = migrating.head(n).id[l];
        bool inside = true;
        for (int i = 0; i < Dim; ++i) inside = inside && cell[i] >= 0 && cell[i] < grid_cells[i];
        if (inside) {
          include(cell);
          note_way(migrating.head(n), l);
        } else if (lost < 0 || id < lost) {
          lost = id;
        }
      });
    result(4 * Dim) = lost;
  }
  KOKKOS_FUNCTION void note_way(const typename MigratingParticles<Dim, Real, Device>::Head& head,
                                int lane) const {
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

/// One column of a group of the old lanes: copies the slots in use, before the new lanes overwrite them.
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
  MigratingParticles<Dim, Real, Device> migrating;
  Ints source;
  int column;
  KOKKOS_FUNCTION void operator()(int g) const {
    const auto& group = lanes.groups(g);
    const Real ghost = column < Dim ? Real(0.5) : Real(0);
    for (size_t e = lanes.begin(group); e < lanes.end(group); ++e) {
      const int from = source(e), migrating_entry = -2 - from, width = lanes.width;
      *lanes.at(column, e) = from >= 0              ? before(from)
                             : migrating_entry >= 0 ? migrating.data(migrating_entry / width,
                                                                     column * width + migrating_entry % width)
                                                    : ghost;
    }
  }
};

/// One slot of the new lanes: the numbers of its particles.
template <int Dim, class Real, class Device>
struct TakeIds {
  typename CellLanes<Dim, Real, Device>::Ints before;
  CellLanes<Dim, Real, Device> lanes;
  MigratingParticles<Dim, Real, Device> migrating;
  typename CellLanes<Dim, Real, Device>::Ints source;
  KOKKOS_FUNCTION void operator()(int slot) const {
    constexpr int width = Lanes<Real>::width;
    LaneMask with_particle = 0;
    for (int l = 0; l < width; ++l) {
      const int e = slot * width + l, from = source(e), migrating_entry = -2 - from;
      lanes.id(e) = from >= 0 ? before(from)
                    : migrating_entry >= 0
                        ? migrating.head(migrating_entry / width).id[migrating_entry % width]
                        : -1;
      if (from != -1) with_particle |= LaneMask(1) << l;
    }
    lanes.with_particle(slot) = with_particle;
  }
};

}  // namespace kernel

/// Writes the migrating particles without a group or slot to `particles`; unpack_particles writes all others.
template <class Exec, int Dim, class Real, class Device>
void unpack_overflow(const Exec& exec, const LaneMemory<Dim, Real, Device>& m,
                     const Particles<Dim, Real, Device>& particles) {
  Kokkos::parallel_for(
      "vsb::unpack_overflow", Kokkos::RangePolicy<Exec>(exec, 0, m.lanes.layers()),
      kernel::UnpackOverflow<Dim, Real, Device>{m.migrating, particles, m.grid, m.lanes.state_size});
}

/// Packs all particles anew, with the migrating particles that found no group or slot. extend_margin: adds
/// groups in the directions in which these went. Returns -1, or the lowest number of a particle outside the
/// grid; then nothing is packed.
template <class Exec, int Dim, class Real, class Device>
int repack_lanes(const Exec& exec, LaneMemory<Dim, Real, Device>& m, bool extend_margin = false) {
  using Cells = CellLanes<Dim, Real, Device>;
  using Ints = typename Cells::Ints;
  const Kokkos::RangePolicy<Exec> once(exec, 0, 1);
  const Cells before = m.lanes;
  const Kokkos::View<int*, Device> range("vsb::occupied_range", 4 * Dim + 1);
  Kokkos::parallel_for("vsb::occupied_range", once,
                       kernel::OccupiedRange<Dim, Real, Device>{before, m.migrating, m.grid.cells, range});
  exec.fence();
  const auto found = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), range);
  if (found(4 * Dim) >= 0) return found(4 * Dim);
  Vector<Dim, int> lowest, highest;
  for (int i = 0; i < Dim; ++i) {
    lowest[i] = found(static_cast<size_t>(2 * i));
    highest[i] = found(static_cast<size_t>(2 * i + 1));
    const auto way = static_cast<size_t>(2 * Dim + 2 * i);
    const int far = i == 0 ? 1 : math::min(math::max((highest[i] - lowest[i]) / 4, 2), 8);
    if (extend_margin && found(way) != 0) m.group_margin.below[i] = far;
    if (extend_margin && found(way + 1) != 0) m.group_margin.above[i] = far;
  }
  const kernel::BoxBasis<Dim, Real> basis{m.grid, box_around<Dim, Real>(lowest, highest, m.group_margin)};
  const Ints count("vsb::particles_of_cell", static_cast<size_t>(basis.bin_count()));
  const Kokkos::RangePolicy<Exec> over_groups(exec, 0, before.group_count);
  Kokkos::parallel_for("vsb::count_lanes", over_groups,
                       kernel::CountLanes<Dim, Real, Device>{before, basis, count});
  kernel::InsertOverflow<Dim, Real, Device> insert{{before, {}, {}}, m.migrating, basis, count, true};
  Kokkos::parallel_for("vsb::count_overflow", once, insert);
  m.lanes.data = {};  // only `before` holds it now
  m.lanes.id = {};
  m.lanes.with_particle = {};
  detail::number_lanes(exec, m, basis.box, count);
  auto& lanes = m.lanes;
  const int entries = lanes.slot_count * lanes.width;
  const Ints source = detail::scratch(m.source, static_cast<size_t>(entries));
  Kokkos::deep_copy(exec, source, -1);
  insert.find = {before, lanes, source};
  insert.counting = false;
  Kokkos::parallel_for("vsb::find_sources", over_groups, insert.find);
  Kokkos::parallel_for("vsb::insert_overflow", once, insert);
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
                         kernel::TakeColumn<Dim, Real, Device>{copy, lanes, m.migrating, source, c});
  }
  Kokkos::parallel_for("vsb::take_ids", Kokkos::RangePolicy<Exec>(exec, 0, lanes.slot_count),
                       kernel::TakeIds<Dim, Real, Device>{before.id, lanes, m.migrating, source});
  exec.fence();
  detail::allocate_migrating(exec, m);
  return -1;
}

}  // namespace vsb
