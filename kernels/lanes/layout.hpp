// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The groups of cells that a body needs, and their nodes: cell lanes without their particles.
#pragma once

#include <vector>
#include <vsb/kernels/lanes/memory.hpp>

namespace vsb {

/// The box of cells lowest, ..., highest with a margin of void cells. Algorithm 1 needs the void cells around
/// the body; particles can move within `group_margin` without a new box. The box may extend over the faces of
/// the grid: groups begin at the lowest cell along x.
template <int Dim, class Real>
CellBox<Dim> box_around(const Vector<Dim, int>& lowest, const Vector<Dim, int>& highest,
                        const GroupMargin<Dim>& group_margin) {
  constexpr int width = Lanes<Real>::width;
  CellBox<Dim> box;
  for (int i = 0; i < Dim; ++i) {
    const int unit = i == 0 ? width : 1, void_cells = i == 0 ? std::max(width, 2) : 2;
    const int below = void_cells + unit * group_margin.below[i],
              above = void_cells + unit * group_margin.above[i];
    box.first[i] = lowest[i] - below;
    box.cells[i] = highest[i] - lowest[i] + 1 + below + above;
    if (i == 0) box.cells[i] = (box.cells[i] + width - 1) / width * width;
  }
  return box;
}

namespace kernel {

/// The bin of a particle is its cell in a box.
template <int Dim, class Real>
struct BoxBasis {
  UniformGrid<Dim, Real> grid;
  CellBox<Dim> box;
  KOKKOS_FUNCTION bool contains(const Vector<Dim, Real>& x) const { return grid.contains(x); }
  KOKKOS_FUNCTION int bin(const Vector<Dim, Real>& x) const { return bin_of_cell(grid.cell_containing(x)); }
  KOKKOS_FUNCTION int bin_of_cell(const Vector<Dim, int>& cell) const {
    int index = 0;
    for (int i = Dim - 1; i >= 0; --i) index = index * box.cells[i] + cell[i] - box.first[i];
    return index;
  }
  int bin_count() const {
    int n = 1;
    for (int i = 0; i < Dim; ++i) n *= box.cells[i];
    return n;
  }
};

/// The slots that the cells of a group need: the most particles of a cell. One position of a group in the
/// box.
template <int Dim, class Real, class Device>
struct NeededSlots {
  using Ints = typename CellLanes<Dim, Real, Device>::Ints;
  Ints count;   ///< [cell of the box]: particles
  Ints needed;  ///< [box_index]
  KOKKOS_FUNCTION void operator()(int box_index) const {
    constexpr int width = Lanes<Real>::width;
    int most = 0;
    for (int l = 0; l < width; ++l) most = math::max(most, static_cast<int>(count(box_index * width + l)));
    needed(box_index) = most;
  }
};

/// The maximum of the needed slots over the group positions from `below` before to `above` behind along an
/// axis. One group of the box.
template <int Dim, class Real, class Device>
struct NeededAround {
  using Ints = typename CellLanes<Dim, Real, Device>::Ints;
  CellLanes<Dim, Real, Device> lanes;
  Ints needed, around;
  int axis, below, above;
  KOKKOS_FUNCTION void operator()(int box_index) const {
    const int rows = lanes.rows_per_layer(), per_row = lanes.groups_per_row();
    const int stride = axis == 0 ? 1 : axis < Dim - 1 ? per_row : per_row * rows;
    const int box_size = axis == 0 ? per_row : axis < Dim - 1 ? rows : lanes.layers();
    const int at = box_index / stride % box_size;
    int most = 0;
    for (int i = math::max(-below, -at); i <= math::min(above, box_size - 1 - at); ++i)
      most = math::max(most, static_cast<int>(needed(box_index + i * stride)));
    around(box_index) = most;
  }
};

/// How many slots the group at a position in the box gets.
template <int Dim, class Real, class Device>
struct GroupSlots {
  typename CellLanes<Dim, Real, Device>::Ints needed;    ///< [box_index]
  typename CellLanes<Dim, Real, Device>::Ints nearby;    ///< [box_index]: above zero where there is a group
  typename CellLanes<Dim, Real, Device>::Ints expected;  ///< [box_index]: slots that may be needed
  int slack;                                             ///< slots to spare
  KOKKOS_FUNCTION int capacity(int box_index) const {
    return nearby(box_index) > 0 ? expected(box_index) + slack : 0;
  }
};

template <int Dim, class Real, class Device>
struct CountGroups {
  GroupSlots<Dim, Real, Device> group_slots;
  KOKKOS_FUNCTION void operator()(int box_index, int& groups, int& slots) const {
    const int capacity = group_slots.capacity(box_index);
    if (capacity == 0) return;
    ++groups;
    slots += capacity;
  }
};

/// Stores the groups one after the other, with their slots; a single work item.
template <int Dim, class Real, class Device>
struct StoreGroups {
  CellLanes<Dim, Real, Device> lanes;
  GroupSlots<Dim, Real, Device> group_slots;

  KOKKOS_FUNCTION void operator()(int) const {
    const int per_row = lanes.groups_per_row(), box_size = lanes.row_count() * per_row;
    int group = 0, slot = 0;
    for (int box_index = 0; box_index < box_size; ++box_index) {
      const int capacity = group_slots.capacity(box_index);
      if (capacity == 0) continue;
      auto& g = lanes.groups(group++);
      g = {};
      g.first = slot;
      g.slots = group_slots.needed(box_index);
      g.capacity = capacity;
      g.x = box_index % per_row;
      g.row = box_index / per_row;
      slot += capacity;
    }
  }
};

/// Numbers the nodes of the groups, and fills the index of groups and nodes in the box; a single work item.
template <int Dim, class Real, class Device>
struct NumberNodes {
  CellLanes<Dim, Real, Device> lanes;

  KOKKOS_FUNCTION void operator()(int, int& nodes) const {
    constexpr int width = Lanes<Real>::width;
    const int per_row = lanes.groups_per_row(), rows = lanes.node_rows_of_cell();
    int layer = 0;
    for (int g = 0; g < lanes.group_count; ++g) {
      const auto& of = lanes.groups(g);
      while (layer <= of.row / lanes.rows_per_layer()) lanes.layer_first(layer++) = g;
      lanes.group_at(of.row * per_row + of.x) = g;
      for (int c = 0; c < rows; ++c) {
        const int node_group = lanes.node_row_of_cell(of.row, c) * (per_row + 1) + of.x;
        lanes.node_group_at(node_group) = lanes.node_group_at(node_group + 1) = 0;
      }
    }
    while (layer <= lanes.layers()) lanes.layer_first(layer++) = lanes.group_count;
    int node_group = 0;
    const int node_groups = static_cast<int>(lanes.node_group_at.extent(0)),
              node_groups_per_plane = lanes.node_rows_per_plane() * (per_row + 1);
    for (int n = 0; n < node_groups; ++n) {
      if (n % node_groups_per_plane == 0) lanes.plane_first(n / node_groups_per_plane) = node_group * width;
      if (lanes.node_group_at(n) >= 0) lanes.node_group_at(n) = node_group++;
    }
    lanes.plane_first(node_groups / node_groups_per_plane) = node_group * width;
    for (int g = 0; g < lanes.group_count; ++g)
      for (int c = 0; c < rows; ++c) {
        auto& of = lanes.groups(g);
        const int node =
            lanes.node_group_at(lanes.node_row_of_cell(of.row, c) * (per_row + 1) + of.x) * width;
        (lanes.node_centred ? lanes.stencils(g).node[c] : of.node[c]) = node;
      }
    nodes = node_group * width;
  }
};

/// The components prescribed at a node, from the faces of the grid on which it lies; one node group.
template <int Dim, class Real, class Device>
struct FixLaneNodes {
  CellLanes<Dim, Real, Device> lanes;
  LaneNodes<Dim, Real, Device> nodes;
  Vector<Dim, int> last;  ///< node of the grid
  Walls<Dim> walls;

  KOKKOS_FUNCTION void operator()(int box_index) const {
    constexpr int width = Lanes<Real>::width;
    const int node_group = lanes.node_group_at(box_index);
    if (node_group < 0) return;
    const int per_row = lanes.groups_per_row() + 1, row = box_index / per_row;
    const auto lowest = lanes.lowest_node();
    auto ijk = lowest;
    if constexpr (Dim == 2) ijk[1] += row;
    if constexpr (Dim == 3) {
      ijk[1] += row % lanes.node_rows_per_plane();
      ijk[2] += row / lanes.node_rows_per_plane();
    }
    for (int i = 0; i < Dim; ++i) nodes.fixed(node_group, i) = 0;
    for (int l = 0; l < width; ++l) {
      ijk[0] = lowest[0] + box_index % per_row * width + l;
      ComponentMask fixed = 0;
      for (int i = 0; i < Dim; ++i) {
        if (ijk[i] == 0) fixed = static_cast<ComponentMask>(fixed | walls.fixed[i][0]);
        if (ijk[i] == last[i]) fixed = static_cast<ComponentMask>(fixed | walls.fixed[i][1]);
      }
      for (int i = 0; i < Dim; ++i)
        if (fixed >> i & 1) nodes.fixed(node_group, i) |= std::uint32_t(1) << l;
    }
  }
};

}  // namespace kernel

namespace detail {

/// The last nodes of the scene's grid: node-centred cells are one more than its cells.
template <int Dim, class Real, class Device>
Vector<Dim, int> last_nodes(const LaneMemory<Dim, Real, Device>& m) {
  auto last = m.grid.cells;
  if (m.lanes.node_centred)
    for (int i = 0; i < Dim; ++i) --last[i];
  return last;
}

/// The nodes of lanes whose box and groups are known.
template <class Exec, int Dim, class Real, class Device>
void number_nodes(const Exec& exec, LaneMemory<Dim, Real, Device>& m) {
  using Ints = typename CellLanes<Dim, Real, Device>::Ints;
  auto& lanes = m.lanes;
  const int per_row = lanes.groups_per_row(), layers = lanes.layers(), planes = Dim == 1 ? 1 : layers + 1,
            node_groups = planes * lanes.node_rows_per_plane() * (per_row + 1);
  const auto ints = [](const std::string& name, int n) { return Ints(name, static_cast<size_t>(n)); };
  lanes.layer_first = ints("vsb::layer_first", layers + 1);
  lanes.plane_first = ints("vsb::plane_first", layers + 2);
  lanes.group_at = ints("vsb::group_at", lanes.row_count() * per_row);
  lanes.node_group_at = ints("vsb::node_group_at", node_groups);
  Kokkos::deep_copy(exec, lanes.group_at, -1);
  Kokkos::deep_copy(exec, lanes.node_group_at, -1);
  if (lanes.node_centred)
    lanes.stencils = decltype(lanes.stencils)("vsb::lane_stencils", static_cast<size_t>(lanes.group_count));
  int node_count = 0;
  Kokkos::parallel_reduce("vsb::number_nodes", Kokkos::RangePolicy<Exec>(exec, 0, 1),
                          kernel::NumberNodes<Dim, Real, Device>{lanes}, node_count);
  exec.fence();
  lanes.node_count = node_count;
  m.packed_grid = m.grid;
  m.packed_walls = m.walls;
  if (static_cast<int>(m.nodes.data.extent(0)) < node_count) {
    m.nodes.data = decltype(m.nodes.data)(
        "vsb::lane_nodes", static_cast<size_t>(padded_rows<Real>(node_count + node_count / 16)),
        static_cast<size_t>(lanes.node_centred ? m.nodes.spline_column_count : m.nodes.column_count));
    m.nodes.fixed = decltype(m.nodes.fixed)("vsb::lane_nodes_fixed",
                                            m.nodes.data.extent(0) / static_cast<size_t>(lanes.width));
  } else {
    Kokkos::deep_copy(exec, m.nodes.data, Real(0));
  }
  Kokkos::parallel_for("vsb::fix_lane_nodes", Kokkos::RangePolicy<Exec>(exec, 0, node_groups),
                       kernel::FixLaneNodes<Dim, Real, Device>{lanes, m.nodes, last_nodes(m), m.walls});
}

/// Makes groups and nodes for a box and the number of particles in each of its cells. The caller fills
/// columns and numbers of the particles.
template <class Exec, int Dim, class Real, class Device>
void number_lanes(const Exec& exec, LaneMemory<Dim, Real, Device>& m, const CellBox<Dim>& box,
                  const typename CellLanes<Dim, Real, Device>::Ints& count) {
  auto& lanes = m.lanes;
  lanes.box = box;
  int groups = 0, slots = 0;
  const Kokkos::RangePolicy<Exec> over_box(exec, 0, lanes.row_count() * lanes.groups_per_row());
  using Ints = typename CellLanes<Dim, Real, Device>::Ints;
  const auto box_size = static_cast<size_t>(lanes.row_count() * lanes.groups_per_row());
  kernel::GroupSlots<Dim, Real, Device> group_slots{Ints("vsb::needed_slots", box_size), {}, {}, m.slack};
  Kokkos::parallel_for("vsb::needed_slots", over_box,
                       kernel::NeededSlots<Dim, Real, Device>{count, group_slots.needed});
  group_slots.nearby = group_slots.expected = group_slots.needed;
  if (m.group_margin.any()) {
    const auto widen = [&](Ints& needed, int axis, int below, int above) {
      const Ints around("vsb::slots_around", box_size);
      Kokkos::parallel_for(
          "vsb::slots_around", over_box,
          kernel::NeededAround<Dim, Real, Device>{lanes, needed, around, axis, below, above});
      needed = around;
    };
    // Particles that move up by n groups come from n groups below: below and above change roles.
    for (int i = 0; i < Dim; ++i)
      widen(group_slots.nearby, i, m.group_margin.above[i], m.group_margin.below[i]);
    // Cells at the edge of a body hold fewer particles than the cells behind them that will follow.
    group_slots.expected = group_slots.nearby;
    for (int i = 0; i < Dim; ++i) widen(group_slots.expected, i, 1, 1);
  }
  Kokkos::parallel_reduce("vsb::count_groups", over_box, kernel::CountGroups<Dim, Real, Device>{group_slots},
                          groups, slots);
  exec.fence();
  lanes.group_count = groups;
  lanes.slot_count = slots;
  lanes.groups = decltype(lanes.groups)("vsb::lane_groups", static_cast<size_t>(groups));
  Kokkos::parallel_for("vsb::store_groups", Kokkos::RangePolicy<Exec>(exec, 0, 1),
                       kernel::StoreGroups<Dim, Real, Device>{lanes, group_slots});
  number_nodes(exec, m);
  int cells = 0;
  Kokkos::parallel_reduce(
      "vsb::count_cells", Kokkos::RangePolicy<Exec>(exec, 0, static_cast<int>(count.extent(0))),
      KOKKOS_LAMBDA(int cell, int& n) { n += count(cell) > 0; }, cells);
  exec.fence();
  set_remap_method(lanes, m.remap_method == RemapMethod::mass_matrix ||
                              (m.remap_method == RemapMethod::chosen && mass_matrix_is_faster(lanes, cells)));
}

}  // namespace detail

/// The members of a group that do not follow from the others.
struct GroupShape {
  ///@{
  /// As in LaneGroup.
  int x, row, slots, capacity;
  ///@}
};

/// Lays lanes out with given groups. The caller fills columns and numbers of the particles. Returns false,
/// and changes nothing, where the groups are not valid.
template <class Exec, int Dim, class Real, class Device>
bool lay_out_lanes(const Exec& exec, LaneMemory<Dim, Real, Device>& m, const CellBox<Dim>& box,
                   const std::vector<GroupShape>& shape) {
  auto lanes = m.lanes;
  lanes.box = box;
  for (int i = 0; i < Dim; ++i)
    if (box.cells[i] < 1 || box.cells[i] > m.grid.cells[i] + 8 * lanes.width) return false;
  lanes.groups = decltype(lanes.groups)("vsb::lane_groups", shape.size());
  lanes.group_count = static_cast<int>(shape.size());
  lanes.slot_count = 0;
  const auto groups = Kokkos::create_mirror_view(lanes.groups);
  int last = -1;
  for (size_t g = 0; g < shape.size(); ++g) {
    const auto& of = shape[g];
    if (of.x < 0 || of.x >= lanes.groups_per_row() || of.row < 0 || of.row >= lanes.row_count()) return false;
    const int box_index = of.row * lanes.groups_per_row() + of.x;
    if (box_index <= last || of.slots < 0 || of.capacity < of.slots ||
        of.capacity > m.lanes.particle_count + 64)
      return false;
    last = box_index;
    groups(g) = {};
    groups(g).first = lanes.slot_count;
    groups(g).slots = of.slots;
    groups(g).capacity = of.capacity;
    groups(g).x = of.x;
    groups(g).row = of.row;
    lanes.slot_count += of.capacity;
  }
  Kokkos::deep_copy(lanes.groups, groups);
  m.lanes = lanes;
  detail::number_nodes(exec, m);
  detail::allocate_columns(m.lanes, m.lanes.slot_count);
  detail::allocate_numbers(m.lanes, m.lanes.slot_count);
  detail::allocate_migrating(exec, m);
  exec.fence();
  return true;
}

}  // namespace vsb
