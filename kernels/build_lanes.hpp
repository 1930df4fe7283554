// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Packs particles by cell (views/cell_lanes.hpp), packs them anew when they no longer fit, and unpacks them.
///
/// Within a cell, particles lie by number at first, and later in the order in which they came; both are the
/// same whatever ran in parallel.
#pragma once

#include <vector>
#include <vsb/kernels/locate_particles.hpp>
#include <vsb/physics/uniform_grid.hpp>
#include <vsb/physics/walls.hpp>
#include <vsb/views/cell_lanes.hpp>

namespace vsb {

/// How far from particles there are groups too, for those that move there: in groups along x, in rows along
/// the other axes.
template <int Dim>
struct Reach {
  Vector<Dim, int> below = Vector<Dim, int>::zero(), above = Vector<Dim, int>::zero();
  bool any() const {
    bool some = false;
    for (int i = 0; i < Dim; ++i) some = some || below[i] > 0 || above[i] > 0;
    return some;
  }
};

/// The box that holds cells lowest, ..., highest with a margin of void cells, so that the cells around them
/// are known (Algorithm 1) and particles can move as far as `reach` says. It may reach over the faces of the
/// grid: groups begin at the lowest cell along x.
template <int Dim, class Real>
CellBox<Dim> box_around(const Vector<Dim, int>& lowest, const Vector<Dim, int>& highest,
                        const Reach<Dim>& reach) {
  constexpr int width = Lanes<Real>::width;
  CellBox<Dim> box;
  for (int i = 0; i < Dim; ++i) {
    const int unit = i == 0 ? width : 1, void_cells = i == 0 ? std::max(width, 2) : 2;
    const int below = void_cells + unit * reach.below[i], above = void_cells + unit * reach.above[i];
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

/// The lowest and, with the other sign, the highest cell along axis i of the particles in the grid.
template <int Dim, class Real, class Device>
struct CellRange {
  Particles<Dim, Real, Device> particles;
  UniformGrid<Dim, Real> grid;
  int axis, sign;
  KOKKOS_FUNCTION void operator()(int p, int& minimum) const {
    const auto x = particles.position_of(p);
    if (grid.contains(x)) minimum = math::min(minimum, sign * grid.cell_containing(x)[axis]);
  }
};

/// How many slots a group needs: the most particles of a cell. One place in the box.
template <int Dim, class Real, class Device>
struct NeededSlots {
  using Ints = typename CellLanes<Dim, Real, Device>::Ints;
  Ints count;   ///< [cell of the box]: particles
  Ints needed;  ///< [place]
  KOKKOS_FUNCTION void operator()(int place) const {
    constexpr int width = Lanes<Real>::width;
    int most = 0;
    for (int l = 0; l < width; ++l) most = math::max(most, static_cast<int>(count(place * width + l)));
    needed(place) = most;
  }
};

/// The most that is needed from `below` places before to `above` places behind along an axis. One place in
/// the box.
template <int Dim, class Real, class Device>
struct NeededAround {
  using Ints = typename CellLanes<Dim, Real, Device>::Ints;
  CellLanes<Dim, Real, Device> lanes;
  Ints needed, around;
  int axis, below, above;
  KOKKOS_FUNCTION void operator()(int place) const {
    const int rows = lanes.rows_per_layer(), per_row = lanes.groups_per_row();
    const int stride = axis == 0 ? 1 : axis < Dim - 1 ? per_row : per_row * rows;
    const int places = axis == 0 ? per_row : axis < Dim - 1 ? rows : lanes.layers();
    const int at = place / stride % places;
    int most = 0;
    for (int i = math::max(-below, -at); i <= math::min(above, places - 1 - at); ++i)
      most = math::max(most, static_cast<int>(needed(place + i * stride)));
    around(place) = most;
  }
};

/// How many slots a group gets.
template <int Dim, class Real, class Device>
struct GroupRoom {
  typename CellLanes<Dim, Real, Device>::Ints needed;    ///< [place]
  typename CellLanes<Dim, Real, Device>::Ints reached;   ///< [place]: above zero where there is a group
  typename CellLanes<Dim, Real, Device>::Ints expected;  ///< [place]: slots that may be needed
  int slack;                                             ///< slots to spare
  KOKKOS_FUNCTION int capacity(int place) const { return reached(place) > 0 ? expected(place) + slack : 0; }
};

template <int Dim, class Real, class Device>
struct CountGroups {
  GroupRoom<Dim, Real, Device> room;
  KOKKOS_FUNCTION void operator()(int place, int& groups, int& slots) const {
    const int capacity = room.capacity(place);
    if (capacity == 0) return;
    ++groups;
    slots += capacity;
  }
};

/// Lines the groups up, one after the other; a single work item.
template <int Dim, class Real, class Device>
struct PlaceGroups {
  CellLanes<Dim, Real, Device> lanes;
  GroupRoom<Dim, Real, Device> room;

  KOKKOS_FUNCTION void operator()(int) const {
    const int per_row = lanes.groups_per_row(), places = lanes.row_count() * per_row;
    int group = 0, slot = 0;
    for (int place = 0; place < places; ++place) {
      const int capacity = room.capacity(place);
      if (capacity == 0) continue;
      auto& g = lanes.groups(group++);
      g = {};
      g.first = slot;
      g.slots = room.needed(place);
      g.capacity = capacity;
      g.x = place % per_row;
      g.row = place / per_row;
      slot += capacity;
    }
  }
};

/// Numbers the nodes of the groups, and says where in the box groups and nodes are; a single work item.
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
        const int chunk = lanes.node_row_of_cell(of.row, c) * (per_row + 1) + of.x;
        lanes.chunk_at(chunk) = lanes.chunk_at(chunk + 1) = 0;
      }
    }
    while (layer <= lanes.layers()) lanes.layer_first(layer++) = lanes.group_count;
    int chunk = 0;
    const int chunks = static_cast<int>(lanes.chunk_at.extent(0)),
              chunks_per_plane = lanes.node_rows_per_plane() * (per_row + 1);
    for (int n = 0; n < chunks; ++n) {
      if (n % chunks_per_plane == 0) lanes.plane_first(n / chunks_per_plane) = chunk * width;
      if (lanes.chunk_at(n) >= 0) lanes.chunk_at(n) = chunk++;
    }
    lanes.plane_first(chunks / chunks_per_plane) = chunk * width;
    for (int g = 0; g < lanes.group_count; ++g)
      for (int c = 0; c < rows; ++c) {
        auto& of = lanes.groups(g);
        const int node = lanes.chunk_at(lanes.node_row_of_cell(of.row, c) * (per_row + 1) + of.x) * width;
        (lanes.dual ? lanes.stencils(g).node[c] : of.node[c]) = node;
      }
    nodes = chunk * width;
  }
};

/// Who is where in one group, from particles sorted by cell.
template <int Dim, class Real, class Device>
struct PackNumbers {
  CellLanes<Dim, Real, Device> lanes;
  ParticleBins<Device> bins;

  KOKKOS_FUNCTION void operator()(int g) const {
    constexpr int width = Lanes<Real>::width;
    const auto& group = lanes.groups(g);
    const int first_bin = (group.row * lanes.groups_per_row() + group.x) * width;
    for (int s = 0; s < group.capacity; ++s) {
      LaneMask held = 0;
      for (int l = 0; l < width; ++l) {
        const int begin = bins.offset(first_bin + l), count = bins.offset(first_bin + l + 1) - begin;
        lanes.id((group.first + s) * width + l) = s < count ? bins.order(begin + s) : -1;
        if (s < count) held |= LaneMask(1) << l;
      }
      lanes.held(group.first + s) = held;
    }
  }
};

/// One column of a group: the slots in use.
template <int Dim, class Real, class Device>
struct PackColumn {
  CellLanes<Dim, Real, Device> lanes;
  typename Particles<Dim, Real, Device>::Scalars of_particle;
  UniformGrid<Dim, Real> grid;
  int column;

  KOKKOS_FUNCTION void operator()(int g) const {
    const auto& group = lanes.groups(g);
    const bool coordinate = column < Dim;
    for (size_t e = lanes.begin(group); e < lanes.end(group); ++e) {
      const int p = lanes.id(e);
      Real value = p < 0 ? Real(0) : of_particle(p);
      if (coordinate)
        value = p < 0 ? Real(0.5)
                      : grid.in_cells(value, column) -
                            static_cast<Real>(lanes.cell(group, static_cast<int>(e % lanes.width))[column]);
      *lanes.at(column, e) = value;
    }
  }
};

template <int Dim, class Real, class Device>
struct UnpackGroup {
  CellLanes<Dim, Real, Device> lanes;
  Particles<Dim, Real, Device> particles;
  UniformGrid<Dim, Real> grid;

  KOKKOS_FUNCTION void operator()(int g) const {
    constexpr int width = Lanes<Real>::width;
    const auto& group = lanes.groups(g);
    for (int s = 0; s < group.slots; ++s)
      for (int l = 0; l < width; ++l) {
        const size_t e = static_cast<size_t>(group.first + s) * width + static_cast<size_t>(l);
        const int p = lanes.id(e);
        if (p < 0) continue;
        Vector<Dim, Real> xi;
        for (int i = 0; i < Dim; ++i) xi[i] = *lanes.at(lanes.xi_column + i, e);
        const auto x = grid.map(lanes.cell(group, l), xi).x;
        for (int i = 0; i < Dim; ++i) {
          particles.position(p, i) = x[i];
          particles.velocity(p, i) = *lanes.at(lanes.velocity_column + i, e);
        }
        particles.mass(p) = *lanes.at(lanes.mass_column, e);
        particles.volume(p) = *lanes.at(lanes.volume_column, e);
        for (int c = 0; c < lanes.stress_size; ++c)
          particles.cauchy_stress(p, c) = *lanes.at(lanes.stress_column + c, e);
        for (int c = 0; c < lanes.state_size; ++c)
          particles.material_state(p, c) = *lanes.at(lanes.state_column + c, e);
      }
  }
};

/// The components prescribed at a node, from the faces of the grid on which it lies; one chunk of nodes.
template <int Dim, class Real, class Device>
struct FixLaneNodes {
  CellLanes<Dim, Real, Device> lanes;
  LaneNodes<Dim, Real, Device> nodes;
  Vector<Dim, int> last;  ///< node of the grid
  Walls<Dim> walls;

  KOKKOS_FUNCTION void operator()(int place) const {
    constexpr int width = Lanes<Real>::width;
    const int chunk = lanes.chunk_at(place);
    if (chunk < 0) return;
    const int per_row = lanes.groups_per_row() + 1, row = place / per_row;
    const auto lowest = lanes.lowest_node();
    auto ijk = lowest;
    if constexpr (Dim == 2) ijk[1] += row;
    if constexpr (Dim == 3) {
      ijk[1] += row % lanes.node_rows_per_plane();
      ijk[2] += row / lanes.node_rows_per_plane();
    }
    for (int i = 0; i < Dim; ++i) nodes.fixed(chunk, i) = 0;
    for (int l = 0; l < width; ++l) {
      ijk[0] = lowest[0] + place % per_row * width + l;
      ComponentMask fixed = 0;
      for (int i = 0; i < Dim; ++i) {
        if (ijk[i] == 0) fixed = static_cast<ComponentMask>(fixed | walls.fixed[i][0]);
        if (ijk[i] == last[i]) fixed = static_cast<ComponentMask>(fixed | walls.fixed[i][1]);
      }
      for (int i = 0; i < Dim; ++i)
        if (fixed >> i & 1) nodes.fixed(chunk, i) |= std::uint32_t(1) << l;
    }
  }
};

}  // namespace kernel

/// How often a step looks at all particles: as their number per cell makes it worth while.
enum class Sweeps : std::uint8_t { chosen, one, two };

/// Whether one sweep is faster, as measured: the mass matrix is work per cell, what it saves is work per
/// particle, and in 3D mostly memory traffic, which only counts where the particles do not fit into caches.
template <int Dim, class Real, class Device>
bool one_sweep_is_faster(const CellLanes<Dim, Real, Device>& lanes, int cells_with_particles) {
  constexpr int per_cell = CellLanes<Dim, Real, Device>::mass_matrix_size;
  constexpr double caches = 24e6;  // bytes
  const double bytes = static_cast<double>(sizeof(Real)) * lanes.columns() * lanes.particle_count;
  return lanes.particle_count >= per_cell * cells_with_particles && (Dim < 3 || bytes > caches);
}

/// What the cell lanes of a body need beside the particles.
template <int Dim, class Real, class Device>
struct LaneMemory {
  CellLanes<Dim, Real, Device> lanes;
  LaneNodes<Dim, Real, Device> nodes;
  Leavers<Dim, Real, Device> leavers;
  UniformGrid<Dim, Real> grid;
  Walls<Dim> walls;
  int slack = 1;  ///< slots that a group has to spare
  Reach<Dim> reach;
  Sweeps sweeps = Sweeps::chosen;
  typename CellLanes<Dim, Real, Device>::Ints source;  ///< scratch of repack_lanes, as is column_before
  Kokkos::View<Real*, Device> column_before;
};

/// Makes steps take one sweep or two.
template <int Dim, class Real, class Device>
void set_sweeps(CellLanes<Dim, Real, Device>& lanes, bool one) {
  lanes.mass_matrices =
      one ? decltype(lanes.mass_matrices)("vsb::mass_matrices", static_cast<size_t>(lanes.group_count) *
                                                                    lanes.mass_matrix_size * lanes.width)
          : decltype(lanes.mass_matrices)();
}

namespace detail {

/// The first n entries of memory that is kept from one use to the next.
template <class View>
View scratch(View& kept, size_t n) {
  if (kept.extent(0) < n) {
    kept = View();
    kept = View(Kokkos::view_alloc("vsb::scratch", Kokkos::WithoutInitializing), n + n / 8);
  }
  return Kokkos::subview(kept, std::make_pair(size_t(0), n));
}

/// Rows to allocate for some that grow: on the host, rows that are not written to take no memory.
template <class Device>
int with_room(int rows) {
  using Memory = typename Device::memory_space;
  return Kokkos::SpaceAccessibility<Kokkos::HostSpace, Memory>::accessible ? 2 * rows : rows + rows / 16;
}

/// Columns for `slots` slots, and room for more.
template <int Dim, class Real, class Device>
void allocate_columns(CellLanes<Dim, Real, Device>& lanes, int slots) {
  lanes.data =
      decltype(lanes.data)(Kokkos::view_alloc("vsb::cell_lanes", Kokkos::WithoutInitializing),
                           static_cast<size_t>(padded_rows<Real>(with_room<Device>(slots) * lanes.width)),
                           static_cast<size_t>(lanes.columns()));
}

/// Numbers of particles for `slots` slots.
template <int Dim, class Real, class Device>
void allocate_numbers(CellLanes<Dim, Real, Device>& lanes, int slots) {
  lanes.id = decltype(lanes.id)(Kokkos::view_alloc("vsb::lane_ids", Kokkos::WithoutInitializing),
                                static_cast<size_t>(slots) * lanes.width);
  lanes.held = decltype(lanes.held)("vsb::lanes_held", static_cast<size_t>(slots));
}

/// The last nodes of the scene's grid: dual cells are one more than its cells.
template <int Dim, class Real, class Device>
Vector<Dim, int> last_nodes(const LaneMemory<Dim, Real, Device>& m) {
  auto last = m.grid.cells;
  if (m.lanes.dual)
    for (int i = 0; i < Dim; ++i) --last[i];
  return last;
}

/// The nodes of lanes whose box and groups are known.
template <class Exec, int Dim, class Real, class Device>
void number_nodes(const Exec& exec, LaneMemory<Dim, Real, Device>& m) {
  using Ints = typename CellLanes<Dim, Real, Device>::Ints;
  auto& lanes = m.lanes;
  const int per_row = lanes.groups_per_row(), layers = lanes.layers(), planes = Dim == 1 ? 1 : layers + 1,
            chunks = planes * lanes.node_rows_per_plane() * (per_row + 1);
  const auto ints = [](const std::string& name, int n) { return Ints(name, static_cast<size_t>(n)); };
  lanes.layer_first = ints("vsb::layer_first", layers + 1);
  lanes.plane_first = ints("vsb::plane_first", layers + 2);
  lanes.group_at = ints("vsb::group_at", lanes.row_count() * per_row);
  lanes.chunk_at = ints("vsb::chunk_at", chunks);
  Kokkos::deep_copy(exec, lanes.group_at, -1);
  Kokkos::deep_copy(exec, lanes.chunk_at, -1);
  if (lanes.dual)
    lanes.stencils = decltype(lanes.stencils)("vsb::lane_stencils", static_cast<size_t>(lanes.group_count));
  int node_count = 0;
  Kokkos::parallel_reduce("vsb::number_nodes", Kokkos::RangePolicy<Exec>(exec, 0, 1),
                          kernel::NumberNodes<Dim, Real, Device>{lanes}, node_count);
  exec.fence();
  lanes.node_count = node_count;
  if (static_cast<int>(m.nodes.data.extent(0)) < node_count) {
    m.nodes.data = decltype(m.nodes.data)(
        "vsb::lane_nodes", static_cast<size_t>(padded_rows<Real>(node_count + node_count / 16)),
        static_cast<size_t>(lanes.dual ? m.nodes.dual_column_count : m.nodes.column_count));
    m.nodes.fixed = decltype(m.nodes.fixed)("vsb::lane_nodes_fixed",
                                            m.nodes.data.extent(0) / static_cast<size_t>(lanes.width));
  } else {
    Kokkos::deep_copy(exec, m.nodes.data, Real(0));
  }
  Kokkos::parallel_for("vsb::fix_lane_nodes", Kokkos::RangePolicy<Exec>(exec, 0, chunks),
                       kernel::FixLaneNodes<Dim, Real, Device>{lanes, m.nodes, last_nodes(m), m.walls});
}

/// Groups and nodes for a box and the number of particles in each of its cells; the columns and numbers of
/// the particles are left to the caller.
template <class Exec, int Dim, class Real, class Device>
void number_lanes(const Exec& exec, LaneMemory<Dim, Real, Device>& m, const CellBox<Dim>& box,
                  const typename CellLanes<Dim, Real, Device>::Ints& count) {
  auto& lanes = m.lanes;
  lanes.box = box;
  int groups = 0, slots = 0;
  const Kokkos::RangePolicy<Exec> over_places(exec, 0, lanes.row_count() * lanes.groups_per_row());
  using Ints = typename CellLanes<Dim, Real, Device>::Ints;
  const auto places = static_cast<size_t>(lanes.row_count() * lanes.groups_per_row());
  kernel::GroupRoom<Dim, Real, Device> room{Ints("vsb::needed_slots", places), {}, {}, m.slack};
  Kokkos::parallel_for("vsb::needed_slots", over_places,
                       kernel::NeededSlots<Dim, Real, Device>{count, room.needed});
  room.reached = room.expected = room.needed;
  if (m.reach.any()) {
    const auto widen = [&](Ints& needed, int axis, int below, int above) {
      const Ints around("vsb::slots_around", places);
      Kokkos::parallel_for(
          "vsb::slots_around", over_places,
          kernel::NeededAround<Dim, Real, Device>{lanes, needed, around, axis, below, above});
      needed = around;
    };
    // A place lies above those from which it is reached.
    for (int i = 0; i < Dim; ++i) widen(room.reached, i, m.reach.above[i], m.reach.below[i]);
    // The edge of a body is thinner than what will come.
    room.expected = room.reached;
    for (int i = 0; i < Dim; ++i) widen(room.expected, i, 1, 1);
  }
  Kokkos::parallel_reduce("vsb::count_groups", over_places, kernel::CountGroups<Dim, Real, Device>{room},
                          groups, slots);
  exec.fence();
  lanes.group_count = groups;
  lanes.slot_count = slots;
  lanes.groups = decltype(lanes.groups)("vsb::lane_groups", static_cast<size_t>(groups));
  Kokkos::parallel_for("vsb::place_groups", Kokkos::RangePolicy<Exec>(exec, 0, 1),
                       kernel::PlaceGroups<Dim, Real, Device>{lanes, room});
  number_nodes(exec, m);
  int cells = 0;
  Kokkos::parallel_reduce(
      "vsb::count_cells", Kokkos::RangePolicy<Exec>(exec, 0, static_cast<int>(count.extent(0))),
      KOKKOS_LAMBDA(int cell, int& n) { n += count(cell) > 0; }, cells);
  exec.fence();
  set_sweeps(lanes,
             m.sweeps == Sweeps::one || (m.sweeps == Sweeps::chosen && one_sweep_is_faster(lanes, cells)));
}

/// Lists with room for all particles of their layers; memory that nobody writes to is not taken.
template <class Exec, int Dim, class Real, class Device>
void allocate_leavers(const Exec& exec, LaneMemory<Dim, Real, Device>& m) {
  const auto& lanes = m.lanes;
  const auto slots = static_cast<size_t>(lanes.slot_count),
             numbers = static_cast<size_t>(lanes.columns() * lanes.width);
  auto& l = m.leavers;
  if (l.data.extent(0) < slots || l.data.extent(1) != numbers) {
    l.data =
        decltype(l.data)(Kokkos::view_alloc("vsb::leavers", Kokkos::WithoutInitializing), slots, numbers);
    l.head = decltype(l.head)(Kokkos::view_alloc("vsb::leaver_heads", Kokkos::WithoutInitializing), slots);
  }
  const auto per_layer = [&](const std::string& name) {
    return decltype(l.first)(name, static_cast<size_t>(lanes.layers()));
  };
  l.count = per_layer("vsb::leaver_count");
  l.lost = per_layer("vsb::leavers_lost");
  l.many = per_layer("vsb::leavers_many");
  l.unsummed = per_layer("vsb::unsummed_layers");
  l.first = per_layer("vsb::leaver_first");
  const auto first = l.first;
  Kokkos::parallel_for(
      "vsb::first_leavers", Kokkos::RangePolicy<Exec>(exec, 0, lanes.layers()), KOKKOS_LAMBDA(int k) {
        const int g = lanes.layer_first(k);
        first(k) = g < lanes.group_count ? lanes.groups(g).first : 0;
      });
}

}  // namespace detail

/// What a group has that does not follow from the rest.
struct GroupShape {
  int x, row, slots, capacity;
};

/// Lays lanes out as others were; columns and numbers of the particles are left to the caller. False where
/// that makes no sense, and then nothing is changed.
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
    const int place = of.row * lanes.groups_per_row() + of.x;
    if (place <= last || of.slots < 0 || of.capacity < of.slots || of.capacity > m.lanes.particle_count + 64)
      return false;
    last = place;
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
  detail::allocate_leavers(exec, m);
  exec.fence();
  return true;
}

namespace detail {

/// Finds groups for the particles, and says who is where; the columns are left to the caller. Returns -1, or
/// the lowest number of a particle outside the grid.
template <class Exec, int Dim, class Real, class Device>
int lay_out_particles(const Exec& exec, const Particles<Dim, Real, Device>& particles,
                      LaneMemory<Dim, Real, Device>& m) {
  using Cells = CellLanes<Dim, Real, Device>;
  const int n = particles.count();
  Vector<Dim, int> lowest, highest;
  for (int i = 0; i < Dim; ++i)
    for (const int sign : {1, -1}) {
      int found = 0;
      Kokkos::parallel_reduce("vsb::cell_range", Kokkos::RangePolicy<Exec>(exec, 0, n),
                              kernel::CellRange<Dim, Real, Device>{particles, m.grid, i, sign},
                              Kokkos::Min<int>(found));
      exec.fence();
      // A reduction over nothing, or over particles outside alone, leaves the largest number there is.
      const int cell = found == std::numeric_limits<int>::max() ? 0 : sign * found;
      (sign > 0 ? lowest : highest)[i] = cell;
    }
  const kernel::BoxBasis<Dim, Real> basis{m.grid, box_around<Dim, Real>(lowest, highest, m.reach)};
  auto bins = allocate_bins<Device>(n, basis.bin_count());
  const auto where = locate_particles(exec, particles, bins, basis);
  if (where.lost >= 0) return where.lost;
  sort_by_bin(exec, bins);
  typename Cells::Ints count("vsb::particles_of_cell", bins.slot.extent(0));
  Kokkos::parallel_for(
      "vsb::particles_of_cell", Kokkos::RangePolicy<Exec>(exec, 0, static_cast<int>(count.extent(0))),
      KOKKOS_LAMBDA(int b) { count(b) = bins.offset(b + 1) - bins.offset(b); });
  auto& lanes = m.lanes;
  lanes.data = {};
  lanes.particle_count = n;
  number_lanes(exec, m, basis.box, count);
  allocate_numbers(lanes, lanes.slot_count);
  Kokkos::parallel_for("vsb::pack_numbers", Kokkos::RangePolicy<Exec>(exec, 0, lanes.group_count),
                       kernel::PackNumbers<Dim, Real, Device>{lanes, bins});
  exec.fence();
  return -1;
}

/// The numbers that become a column of the lanes.
template <int Dim, class Real, class Device>
typename Particles<Dim, Real, Device>::Scalars column_of(const Particles<Dim, Real, Device>& particles,
                                                         int column) {
  using Columns = CellLanes<Dim, Real, Device>;
  const auto of = [](const auto& fields, int c) { return Kokkos::subview(fields, Kokkos::ALL(), c); };
  if (column >= Columns::state_column) return of(particles.material_state, column - Columns::state_column);
  if (column >= Columns::stress_column) return of(particles.cauchy_stress, column - Columns::stress_column);
  if (column == Columns::volume_column) return particles.volume;
  if (column == Columns::mass_column) return particles.mass;
  if (column >= Columns::velocity_column) return of(particles.velocity, column - Columns::velocity_column);
  return of(particles.position, column);
}

template <class Exec, int Dim, class Real, class Device>
void pack_column(const Exec& exec, const LaneMemory<Dim, Real, Device>& m,
                 const typename Particles<Dim, Real, Device>::Scalars& of_particle, int column) {
  Kokkos::parallel_for("vsb::pack_column", Kokkos::RangePolicy<Exec>(exec, 0, m.lanes.group_count),
                       kernel::PackColumn<Dim, Real, Device>{m.lanes, of_particle, m.grid, column});
}

}  // namespace detail

/// Packs particles that all lie in the grid. Returns -1, or the lowest number of one that does not.
template <class Exec, int Dim, class Real, class Device>
int pack_particles(const Exec& exec, const Particles<Dim, Real, Device>& particles,
                   LaneMemory<Dim, Real, Device>& m) {
  const int lost = detail::lay_out_particles(exec, particles, m);
  if (lost >= 0) return lost;
  detail::allocate_columns(m.lanes, m.lanes.slot_count);
  for (int c = 0; c < m.lanes.columns(); ++c)
    detail::pack_column(exec, m, detail::column_of(particles, c), c);
  detail::allocate_leavers(exec, m);
  exec.fence();
  return -1;
}

/// Particles to be packed where they are: with room for slots that they do not fill and for so many numbers
/// of material state each, which takes no memory before it is written to. Zero-filled.
template <int Dim, class Real, class Device>
ParticleBlock<Dim, Real, Device> allocate_particles_to_pack(int n, int state_size = 0) {
  using Result = ParticleBlock<Dim, Real, Device>;
  static_assert(Result::columns() == CellLanes<Dim, Real, Device>::state_column,
                "the lanes have the block's");
  const int rows = detail::with_room<Device>(n) + 64 * Lanes<Real>::width;
  const typename Result::Block block(Kokkos::view_alloc("vsb::particles", Kokkos::WithoutInitializing),
                                     static_cast<size_t>(padded_rows<Real>(rows)),
                                     static_cast<size_t>(Result::columns() + state_size));
  Kokkos::deep_copy(Kokkos::subview(block, std::make_pair(0, n), std::make_pair(0, Result::columns())),
                    Real(0));
  return Result(block, n);
}

/// The same for particles that are not needed any more: their memory becomes that of the lanes where it has
/// room for them (allocate_particles_to_pack), so that there are never two copies of all. The block is empty
/// afterwards, and views of its fields must not be used any more; where a particle lies outside the grid,
/// nothing is changed.
template <class Exec, int Dim, class Real, class Device>
int pack_particles(const Exec& exec, ParticleBlock<Dim, Real, Device>&& block,
                   LaneMemory<Dim, Real, Device>& m) {
  const auto entries = [&] { return static_cast<size_t>(m.lanes.slot_count) * m.lanes.width; };
  const int lost = detail::lay_out_particles(exec, block.particles, m);
  if (lost >= 0) return lost;
  const auto taken = std::move(block);
  block = {};
  const auto& particles = taken.particles;
  auto& lanes = m.lanes;
  const bool fits =
      taken.block.extent(0) >= entries() && taken.block.extent(1) >= static_cast<size_t>(lanes.columns());
  if (fits)
    lanes.data = taken.block;
  else
    detail::allocate_columns(lanes, lanes.slot_count);
  const auto n = static_cast<size_t>(particles.count());
  const auto copy = fits ? detail::scratch(m.column_before, n) : Kokkos::View<Real*, Device>();
  for (int c = 0; c < lanes.columns(); ++c) {
    auto column = detail::column_of(particles, c);
    if (fits) {
      Kokkos::deep_copy(exec, copy, column);
      column = copy;
    }
    detail::pack_column(exec, m, column, c);
  }
  exec.fence();
  m.column_before = {};
  detail::allocate_leavers(exec, m);
  exec.fence();
  return -1;
}

/// Writes the particles back, in the order of their numbers.
template <class Exec, int Dim, class Real, class Device>
void unpack_particles(const Exec& exec, const LaneMemory<Dim, Real, Device>& m,
                      const Particles<Dim, Real, Device>& particles) {
  Kokkos::parallel_for("vsb::unpack_particles", Kokkos::RangePolicy<Exec>(exec, 0, m.lanes.group_count),
                       kernel::UnpackGroup<Dim, Real, Device>{m.lanes, particles, m.grid});
}

}  // namespace vsb
