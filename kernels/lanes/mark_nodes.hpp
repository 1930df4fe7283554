// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Algorithm 1 on cell lanes (see kernels/boundary/mark_boundary_nodes.hpp): from the cells that hold
/// particles to the tractions of every node and to the loads of every group. Words of bits and groups without
/// a change are skipped.
#pragma once

#include <vsb/kernels/boundary/mark_boundary_nodes.hpp>
#include <vsb/physics/virtual_stress.hpp>
#include <vsb/views/cell_lanes.hpp>

namespace vsb {

/// Which tractions act on the nodes of cell lanes.
template <int Dim, class Device>
struct LaneBoundary {
  using Rows = typename CellBits<Device>::Rows;  ///< sets of cells or nodes
  CellBits<Device> bits;  ///< of the box; bits.occupied is kept up to date by every sweep. With
                          ///< node-centred cells, of the grid's cells from the lowest node of the box on
  ///@{
  /// [row of nodes of the box][word]: N1, and nodes with mass.
  Rows marked, active;
  ///@}
  Kokkos::View<int*, Device> changed;  ///< [row of nodes]: 1 where tractions changed
  Kokkos::View<int*, Device> stale;    ///< [layer]: 1 where the load of a group changed with the last marking
  BoundaryNodes<Device> tractions;     ///< [node of the lanes]: those that act there
  TractionMask everywhere = 0;         ///< tractions declared at all nodes
  /// [node of the grid]: tractions declared at some nodes; may be empty. prepare_lane_step reads it; call
  /// that again after a change of the array.
  Kokkos::View<const TractionMask*, Device> declared;
  TractionMask at_all_active_nodes = 0;  ///< those that act at all active nodes
  TractionMask all_declared = 0;  ///< declared at any node so far. The members below belong to the marks
  ///@{
  /// `everywhere` and `at_all_active_nodes` as the last marking found them.
  TractionMask marked_everywhere = 0, marked_at_all_active_nodes = 0;
  ///@}
  const TractionMask* marked_declared = nullptr;  ///< the memory of `declared` at the last marking
  bool up_to_date = false;                        ///< whether the members above belong to declarations
};

namespace kernel {

/// One row of cells: which of them hold particles; counts the words that changed.
template <int Dim, class Real, class Device>
struct OccupyLanes {
  CellLanes<Dim, Real, Device> lanes;
  typename CellBits<Device>::Rows occupied;

  KOKKOS_FUNCTION void operator()(int row, int& changes) const {
    constexpr int width = Lanes<Real>::width;
    const int per_row = lanes.groups_per_row(), words = static_cast<int>(occupied.extent(1));
    for (int w = 0; w < words; ++w) {
      std::uint64_t bits = 0;
      for (int x = 64 / width * w; x < math::min(64 / width * (w + 1), per_row); ++x) {
        const int g = lanes.group_at(row * per_row + x);
        if (g < 0) continue;
        bits |= static_cast<std::uint64_t>(lanes.cells_with_particles(lanes.groups(g)))
                << (x * width - 64 * w);
      }
      if (bits != occupied(row, w)) ++changes;
      occupied(row, w) = bits;
    }
  }
};

/// One word of nodes: N1, and the tractions of the nodes where anything changed. ghost_layers: of the basis.
template <int ghost_layers, int Dim, class Real, class Device>
struct MarkLaneNodes {
  CellLanes<Dim, Real, Device> lanes;
  LaneBoundary<Dim, Device> boundary;
  BitRows<Dim> tiling;
  Vector<Dim, int> grid_cells;  ///< of the grid at whose nodes tractions are declared
  bool anew;                    ///< whether or not anything changed

  KOKKOS_FUNCTION void operator()(int r) const {
    const Vector<2, int> at{{r % tiling.node_rows[0], r / tiling.node_rows[0]}};
    const Vector<2, int> from{{at[0] - 1 - ghost_layers, at[1] - 1 - ghost_layers}},
        to{{at[0] + ghost_layers, at[1] + ghost_layers}};
    boundary.changed(r) = 0;
    for (int w = 0; w < tiling.words; ++w) {
      const std::uint64_t active =
          tiling.existing(at, w, 1) &
          dilated_word(boundary.bits.occupied, tiling, w, from, to, ghost_layers, 1 + ghost_layers);
      const std::uint64_t marked =
          active & dilated_word(boundary.bits.boundary, tiling, w, from, to, ghost_layers, 1 + ghost_layers);
      const bool carried_anew = declare_carried(r, w, at);
      if (!anew && !carried_anew && marked == boundary.marked(r, w) && active == boundary.active(r, w))
        continue;
      boundary.marked(r, w) = marked;
      boundary.active(r, w) = active;
      boundary.changed(r) = 1;
      write(r, w, at, marked, active);
    }
  }
  KOKKOS_FUNCTION void write(int r, int w, const Vector<2, int>& at, std::uint64_t marked,
                             std::uint64_t active) const {
    constexpr int width = Lanes<Real>::width;
    const int node_groups = lanes.groups_per_row() + 1;
    const bool alike = boundary.declared.size() == 0 && !boundary.bits.carried.any();
    for (int c = 64 / width * w; c < math::min(64 / width * (w + 1), node_groups); ++c) {
      const int node_group = lanes.node_group_at(r * node_groups + c);
      if (node_group < 0) continue;
      for (int x = c * width; x < (c + 1) * width; ++x) {
        const TractionMask here = marked >> x % 64 & 1   ? ~TractionMask(0)
                                  : active >> x % 64 & 1 ? boundary.at_all_active_nodes
                                                         : 0;
        boundary.tractions(node_group * width + x % width) = alike       ? here & boundary.everywhere
                                                             : here == 0 ? 0
                                                                         : here & declared(r, x, at);
      }
    }
  }
  /// Word w of the carried tractions; whether it changed.
  KOKKOS_FUNCTION bool declare_carried(int r, int w, const Vector<2, int>& at) const {
    const auto& carried = boundary.bits.carried;
    bool changed = false;
    for (int k = 0; k < carried.count(); ++k) {
      const std::uint64_t bits = carried_nodes(carried, k, tiling, at, w, ghost_layers);
      changed = changed || bits != carried.nodes(k, r, w);
      carried.nodes(k, r, w) = bits;
    }
    return changed;
  }
  KOKKOS_FUNCTION TractionMask declared(int r, int x, const Vector<2, int>& at) const {
    TractionMask mask = boundary.everywhere | boundary.bits.carried.at(r, x);
    if (boundary.declared.size() == 0) return mask;
    int node = 0;
    for (int i = Dim - 1; i >= 0; --i)
      node = node * (grid_cells[i] + 1) + lanes.box.first[i] + (i == 0 ? x : at[i > 0 ? i - 1 : 0]);
    return mask | boundary.declared(node);
  }
};

/// One group: marks the cells with particles that carry tractions, of the scene's grid where cells are
/// node-centred ones (see spline_mark_nodes.hpp).
template <int Dim, class Real, class Device>
struct MarkCarryingLanes {
  CellLanes<Dim, Real, Device> lanes;
  CarriedTractions<Device> carried;

  KOKKOS_FUNCTION void operator()(int g) const {
    const auto& group = lanes.groups(g);
    for (size_t e = lanes.begin(group); e < lanes.end(group); ++e) {
      const TractionMask mask = lanes.id(e) < 0 ? 0 : carried.particle(lanes.id(e));
      if (mask == 0) continue;
      const int x = group.x * lanes.width + static_cast<int>(e % lanes.width);
      const int row = group.row + upper(e, 1) + (Dim == 3 ? upper(e, 2) * lanes.rows_per_layer() : 0);
      mark_carrying_cell(carried, mask, row, x + upper(e, 0));
    }
  }
  /// Whether a particle is in the upper half of its node-centred cell.
  KOKKOS_FUNCTION int upper(size_t e, int axis) const {
    return lanes.node_centred && axis < Dim && *lanes.at(lanes.xi_column + axis, e) >= Real(0.5) ? 1 : 0;
  }
};

/// One group whose nodes changed: how it is loaded.
template <int Dim, class Real, class Device>
struct LoadGroup {
  CellLanes<Dim, Real, Device> lanes;
  LaneBoundary<Dim, Device> boundary;

  KOKKOS_FUNCTION void operator()(int g) const {
    auto& group = lanes.groups(g);
    bool changed = false;
    for (int r = 0; r < lanes.node_rows_of_cell(); ++r)
      changed = changed || boundary.changed(lanes.node_row_of_cell(group.row, r)) != 0;
    if (!changed) return;
    if (lanes.node_centred)
      load(group, lanes.stencils(g).node, lanes.stencils(g).loaded, 3);
    else
      load(group, group.node, group.loaded, 2);
  }
  /// A cell has `along` nodes along x.
  template <int rows>
  KOKKOS_FUNCTION void load(LaneGroup<Dim>& group, const int (&node)[rows], std::uint64_t (&loaded)[rows],
                            int along) const {
    constexpr int width = Lanes<Real>::width;
    const auto load_before = group.load;
    const auto tractions_before = group.tractions;
    TractionMask common = 0;
    bool same = true, other = false;
    std::uint64_t all = ~std::uint64_t(0), any = 0;
    for (int r = 0; r < rows; ++r) {
      std::uint64_t bits = 0;
      for (int l = 0; l < width + along - 1; ++l) {
        const TractionMask mask = boundary.tractions(node[r] + l);
        if (mask == 0) continue;
        bits |= std::uint64_t(1) << l;
        if (common == 0) common = mask;
        same = same && mask == common;
      }
      other = other || bits != loaded[r];
      loaded[r] = bits;
      for (int a = 0; a < along; ++a) {
        all &= bits >> a;
        any |= bits >> a;
      }
    }
    constexpr auto cells = static_cast<std::uint64_t>(-1) >> (64 - width);
    group.tractions = common;
    group.load = common == 0                      ? GroupLoad::none
                 : !same                          ? GroupLoad::mixed
                 : (all & cells) == (any & cells) ? GroupLoad::whole
                                                  : GroupLoad::part;
    if (other || group.load == GroupLoad::mixed || group.load != load_before ||
        group.tractions != tractions_before)
      boundary.stale(group.row / lanes.rows_per_layer()) = 1;
  }
};

/// One node: its declaration, with all others.
template <class Device>
struct JoinDeclarations {
  Kokkos::View<const TractionMask*, Device> declared;
  KOKKOS_FUNCTION void operator()(int node, TractionMask& all) const { all |= declared(node); }
};

/// Counts loaded nodes.
template <class Device>
struct CountLoaded {
  BoundaryNodes<Device> tractions;
  KOKKOS_FUNCTION void operator()(int node, int& count) const {
    if (tractions(node) != 0) ++count;
  }
};

}  // namespace kernel

namespace detail {

/// Whether the marks belong to what is declared. Does not compare node by node.
template <int Dim, class Device>
bool declared_as_marked(const LaneBoundary<Dim, Device>& b) {
  return b.up_to_date && b.everywhere == b.marked_everywhere &&
         b.at_all_active_nodes == b.marked_at_all_active_nodes && b.declared.data() == b.marked_declared;
}

template <int Dim, class Device>
void forget_declarations(LaneBoundary<Dim, Device>& b) {
  b.up_to_date = false;
}

/// Notes what is declared, before the boundary is marked anew. Waits for the device.
template <class Exec, int Dim, class Device>
void take_declarations(const Exec& exec, LaneBoundary<Dim, Device>& b, int grid_nodes) {
  if (declared_as_marked(b)) return;
  if (b.declared.size() > 0) {
    TractionMask declared = 0;
    check_rows(
        "LaneBoundary::declared", b.declared.extent(0), grid_nodes,
        "give one mask per node of the grid (of the grid with its ghost layer with B-splines), or none");
    Kokkos::parallel_reduce("vsb::join_declarations", Kokkos::RangePolicy<Exec>(exec, 0, grid_nodes),
                            kernel::JoinDeclarations<Device>{b.declared},
                            Kokkos::BOr<TractionMask>(declared));
    exec.fence();
    b.all_declared |= declared;
  }
  b.all_declared |= b.everywhere;
  b.marked_everywhere = b.everywhere;
  b.marked_at_all_active_nodes = b.at_all_active_nodes;
  b.marked_declared = b.declared.data();
  b.up_to_date = true;
}

}  // namespace detail

/// The tractions declared at some node, or carried by some particle.
template <int Dim, class Device>
TractionMask declared_tractions(const LaneBoundary<Dim, Device>& b) {
  return b.all_declared | b.bits.carried.tractions;
}

/// Makes the boundary ready for lanes that were packed anew.
template <class Exec, int Dim, class Real, class Device>
void fit_boundary(const Exec& exec, const CellLanes<Dim, Real, Device>& lanes, LaneBoundary<Dim, Device>& b) {
  const CellNumbering<Dim> box{lanes.box.cells};
  const BitRows<Dim> tiling(box);
  const auto cell_rows = static_cast<size_t>(tiling.cell_row_count()),
             node_rows = static_cast<size_t>(tiling.node_row_count()),
             words = static_cast<size_t>(tiling.words), nodes = static_cast<size_t>(lanes.node_count);
  using Rows = typename CellBits<Device>::Rows;
  if (b.bits.occupied.extent(0) != cell_rows || b.bits.occupied.extent(1) != words) {
    b.bits.occupied = Rows("vsb::box_occupied", cell_rows, words);
    b.bits.exterior = Rows("vsb::box_exterior", cell_rows, words);
    b.bits.boundary = Rows("vsb::box_boundary", cell_rows, words);
    b.marked = Rows("vsb::box_marked", node_rows, words);
    b.active = Rows("vsb::box_active", node_rows, words);
    b.changed = decltype(b.changed)("vsb::box_changed", node_rows);
    b.stale = decltype(b.stale)("vsb::stale_layers", static_cast<size_t>(lanes.layers()));
  }
  fit_carried(b.bits.carried, cell_rows, node_rows, words);
  if (b.tractions.extent(0) < nodes)
    b.tractions = BoundaryNodes<Device>("vsb::lane_tractions", nodes + nodes / 16);
  else
    Kokkos::deep_copy(exec, b.tractions, TractionMask(0));
}

/// Brings the cells with carriers of tractions up to date. Returns whether there are such tractions.
template <class Exec, int Dim, class Real, class Device>
bool update_carrying(const Exec& exec, const CellLanes<Dim, Real, Device>& lanes,
                     const CarriedTractions<Device>& carried) {
  if (!carried.any()) return false;
  Kokkos::deep_copy(exec, carried.cells, std::uint64_t(0));
  Kokkos::parallel_for("vsb::mark_carrying_lanes", Kokkos::RangePolicy<Exec>(exec, 0, lanes.group_count),
                       kernel::MarkCarryingLanes<Dim, Real, Device>{lanes, carried});
  return true;
}

/// Brings bits.occupied and the cells with carried tractions up to date. Returns whether they may have
/// changed. Waits for the device.
template <class Exec, int Dim, class Real, class Device>
bool update_occupied(const Exec& exec, const CellLanes<Dim, Real, Device>& lanes,
                     const LaneBoundary<Dim, Device>& b) {
  const bool carried = update_carrying(exec, lanes, b.bits.carried);
  int changes = 0;
  Kokkos::parallel_reduce("vsb::occupy_lanes", Kokkos::RangePolicy<Exec>(exec, 0, lanes.row_count()),
                          kernel::OccupyLanes<Dim, Real, Device>{lanes, b.bits.occupied}, changes);
  exec.fence();
  return carried || changes > 0;
}

/// From bits.occupied, which `tiling` describes, to the tractions of nodes. anew: after packing anew, or
/// where a declaration changed. ghost_layers: of the basis.
template <int ghost_layers, class Exec, int Dim, class Real, class Device>
void mark_nodes(const Exec& exec, const CellLanes<Dim, Real, Device>& lanes, const BitRows<Dim>& tiling,
                const Vector<Dim, int>& grid_cells, LaneBoundary<Dim, Device>& b, bool anew) {
  const Kokkos::RangePolicy<Exec> over_words(exec, 0, tiling.cell_row_count() * tiling.words);
  Kokkos::parallel_for("vsb::find_exterior_cells", over_words,
                       kernel::FindExterior<Dim, Device>{b.bits, tiling});
  Kokkos::parallel_for("vsb::find_boundary_cells", over_words,
                       kernel::FindBoundary<Dim, Device>{b.bits, tiling});
  Kokkos::parallel_for(
      "vsb::mark_lane_nodes", Kokkos::RangePolicy<Exec>(exec, 0, tiling.node_row_count()),
      kernel::MarkLaneNodes<ghost_layers, Dim, Real, Device>{lanes, b, tiling, grid_cells, anew});
}

/// From the tractions of nodes to the loads of groups.
template <class Exec, int Dim, class Real, class Device>
void load_groups(const Exec& exec, const CellLanes<Dim, Real, Device>& lanes, LaneBoundary<Dim, Device>& b) {
  Kokkos::deep_copy(exec, b.stale, 0);
  Kokkos::parallel_for("vsb::load_groups", Kokkos::RangePolicy<Exec>(exec, 0, lanes.group_count),
                       kernel::LoadGroup<Dim, Real, Device>{lanes, b});
}

/// The cells of the box, which may reach over the faces of the grid, as rows of bits.
template <int Dim, class Real, class Device>
BitRows<Dim> box_tiling(const CellLanes<Dim, Real, Device>& lanes, const Vector<Dim, int>& grid_cells) {
  BitRows<Dim> tiling(CellNumbering<Dim>{lanes.box.cells});
  for (int i = 0; i < Dim; ++i) {
    tiling.first[i] = math::max(0, -lanes.box.first[i]);
    tiling.last[i] = math::min(lanes.box.cells[i], grid_cells[i] - lanes.box.first[i]) - 1;
  }
  return tiling;
}

/// From bits.occupied to the loads of nodes and groups. anew: after packing anew, or where a declaration
/// changed.
template <class Exec, int Dim, class Real, class Device>
void mark_lanes(const Exec& exec, const CellLanes<Dim, Real, Device>& lanes,
                const Vector<Dim, int>& grid_cells, LaneBoundary<Dim, Device>& b, bool anew) {
  mark_nodes<0>(exec, lanes, box_tiling(lanes, grid_cells), grid_cells, b, anew);
  load_groups(exec, lanes, b);
}

/// Nodes at which a traction acts. Waits for the device.
template <class Exec, int Dim, class Real, class Device>
int count_loaded_nodes(const Exec& exec, const CellLanes<Dim, Real, Device>& lanes,
                       const LaneBoundary<Dim, Device>& b) {
  int count = 0;
  Kokkos::parallel_reduce("vsb::count_loaded", Kokkos::RangePolicy<Exec>(exec, 0, lanes.node_count),
                          kernel::CountLoaded<Device>{b.tractions}, count);
  exec.fence();
  return count;
}

}  // namespace vsb
