// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Particles packed by cell, one cell in every lane of a pack.
///
/// A group is `width` cells side by side in a row along x, one cell in each lane. Particle s of the cell in
/// lane l of a group is entry (first + s) * width + l of every column. A lane with fewer particles than the
/// group has slots is filled up with ghosts without mass and volume, so that the arithmetic needs no masks.
/// The group and the lane give the cell of a particle; xi in [0, 1)^Dim is its position in the cell.
///
/// Cells and nodes are counted within a box around the particles, so that memory and time grow with the body
/// and not with the grid. A layer is all groups of one k (one j in 2D, everything in 1D). It alone writes to
/// the lower sums of the node plane below it and to the upper sums of the plane above it; the sum of a node
/// is lower plus upper. One thread works on a layer, so that the sums are the same for any number of threads.
///
/// With quadratic B-splines the cells of the lanes are the cells around the nodes (CellLanes::node_centred).
/// All particles of such a cell have the same 3^Dim nodes, and a layer writes to three node planes.
#pragma once

#include <vsb/views/masks.hpp>
#include <vsb/views/nodes.hpp>
#include <vsb/views/pack.hpp>
#include <vsb/views/particles.hpp>
#include <vsb/views/static_for.hpp>

namespace vsb {

/// How tractions act on the nodes of a group.
enum class GroupLoad : std::uint8_t {
  none,   ///< at no node
  whole,  ///< at all nodes of a cell or at none, by one mask
  part,   ///< at some nodes, by one mask
  mixed   ///< by masks that differ from node to node
};

/// `width` cells side by side, and where their particles and nodes are.
template <int Dim>
struct LaneGroup {
  static constexpr int corner_rows =
      1 << (Dim - 1);                 ///< rows of nodes along x; bit i: upper in direction 1 + i
  int first;                          ///< slot
  int slots;                          ///< in use
  int capacity;                       ///< slots that it may use
  int x;                              ///< cells x * width, ... of the box's row
  int row;                            ///< of cells in the box
  int node[corner_rows];              ///< the lower node of lane 0 in every corner row
  GroupLoad load;                     ///< how tractions act on its nodes
  TractionMask tractions;             ///< of the loaded nodes, where they have the same
  std::uint64_t loaded[corner_rows];  ///< bit l: the lower node of lane l is loaded, up to l = width
};

/// The nodes of a group with quadratic B-splines, and which of them are loaded; in place of those in
/// LaneGroup.
template <int Dim>
struct LaneStencil {
  static constexpr int rows = Dim == 1 ? 1 : Dim == 2 ? 3 : 9;  ///< of nodes along x: 3 (k - 1) + j - 1
  int node[rows];                                               ///< the lowest node of lane 0 in every row
  std::uint64_t loaded[rows];  ///< bit l: the lowest node of lane l is loaded, up to l = width + 1
};

/// A box of cells of a grid.
template <int Dim>
struct CellBox {
  Vector<Dim, int> first;  ///< lowest cell
  Vector<Dim, int> cells;  ///< their number in each direction
};

/// Particles packed by cell, and the groups, cells and nodes of their box; the top of this file tells how.
/// kernels/lanes/build.hpp makes one. Copying the bundle copies no data.
template <int Dim, class Real, class Device>
struct CellLanes {
  static constexpr int width = Lanes<Real>::width;                   ///< cells of a group, lanes of a pack
  static constexpr int stress_size = symmetric_components(Dim);      ///< stored stress components: 3, 4 or 6
  using P = typename Lanes<Real>::Pack;                              ///< one number of every cell of a group
  using Columns = Kokkos::View<Real**, Kokkos::LayoutLeft, Device>;  ///< one column per number of a particle
  using Ints = Kokkos::View<int*, Device>;  ///< numbers of particles, groups and nodes

  ///@{
  /// The columns of a particle: xi, velocity in m/s, mass, volume, Cauchy stress, material state; units as in
  /// Particles.
  static constexpr int xi_column = 0, velocity_column = Dim, mass_column = 2 * Dim,
                       volume_column = 2 * Dim + 1, stress_column = 2 * Dim + 2,
                       state_column = 2 * Dim + 2 + stress_size;
  ///@}

  Columns data;  ///< [slot * width + lane][column]
  Ints id;       ///< [slot * width + lane]: number of the particle; ghosts: -1
  Kokkos::View<LaneMask*, Device> with_particle;     ///< [slot]: bit l: lane l holds a particle
  Kokkos::View<LaneGroup<Dim>*, Device> groups;      ///< by layer, row and x
  Kokkos::View<LaneStencil<Dim>*, Device> stencils;  ///< [group]: where cells are node-centred
  Ints layer_first;                                  ///< [layers + 1]: the groups of a layer
  Ints plane_first;                                  ///< [layers + 2]: the nodes of a plane
  Ints group_at;       ///< [row of cells][groups per row]: number, -1 where there is none
  Ints node_group_at;  ///< [row of nodes][groups per row + 1]: `width` nodes side by side
  Kokkos::View<Real*, Device>
      mass_matrices;          ///< [(group * 3^Dim + number) * width + lane], kg, numbers as in
                              ///< physics/cell_mass_matrix.hpp; empty: steps re-map in a second sweep
  CellBox<Dim> box;           ///< the cells of the scene's grid that are stored; the outermost ones are void
  bool node_centred = false;  ///< whether cells are those around the nodes of a scene's grid
  int state_size = 0;         ///< numbers of material state per particle
  ///@{
  /// The numbers in use: of groups, of their slots, and of the nodes that they store.
  int group_count = 0, slot_count = 0, node_count = 0;
  ///@}
  int particle_count = 0;  ///< particles in the lanes, without ghosts

  /// Stored numbers of a cell's mass matrix, which is symmetric and of product form: 3^Dim.
  static constexpr int mass_matrix_size = Dim == 1 ? 3 : Dim == 2 ? 9 : 27;
  /// Whether steps re-map by the mass matrices of the cells, in one sweep over the particles.
  KOKKOS_FUNCTION bool remaps_by_mass_matrix() const { return mass_matrices.size() > 0; }
  /// Where one of the 3^Dim numbers of a group's mass matrices begins, in kg: `width` entries, one per cell.
  KOKKOS_FORCEINLINE_FUNCTION Real* mass_matrix_at(int group, int number) const {
    return mass_matrices.data() +
           (static_cast<size_t>(group) * mass_matrix_size + static_cast<size_t>(number)) * width;
  }
  /// Groups that a full row of cells takes, the last one in part.
  KOKKOS_FUNCTION int groups_per_row() const { return (box.cells[0] + width - 1) / width; }
  /// Layers of cells of the box.
  KOKKOS_FUNCTION int layers() const { return Dim == 1 ? 1 : box.cells[Dim - 1]; }
  /// Rows of cells along x in one layer.
  KOKKOS_FUNCTION int rows_per_layer() const { return Dim == 3 ? box.cells[1 % Dim] : 1; }
  /// Rows of cells of the box; row % rows_per_layer() is j, row / rows_per_layer() the layer.
  KOKKOS_FUNCTION int row_count() const { return layers() * rows_per_layer(); }
  /// Rows of nodes along x in one node plane.
  KOKKOS_FUNCTION int node_rows_per_plane() const { return Dim == 3 ? box.cells[1 % Dim] + 1 : 1; }
  /// Columns of `data` in use.
  KOKKOS_FUNCTION int columns() const { return state_column + state_size; }
  /// The row of nodes at corner row c of a row of cells.
  KOKKOS_FUNCTION int node_row(int row, int c) const {
    const int j = row % rows_per_layer(), k = row / rows_per_layer();
    if constexpr (Dim == 1) return 0;
    if constexpr (Dim == 2) return k + c;
    return (k + (c >> 1)) * node_rows_per_plane() + j + (c & 1);
  }
  /// The row of nodes at stencil row r of a row of node-centred cells.
  KOKKOS_FUNCTION int stencil_row(int row, int r) const {
    const int j = row % rows_per_layer(), k = row / rows_per_layer();
    return Dim == 3 ? (k + r / 3) * node_rows_per_plane() + j + r % 3 : k + r;
  }
  ///@{
  /// The number of node rows of a cell, and row r of them, for either kind of cells.
  KOKKOS_FUNCTION int node_rows_of_cell() const {
    return node_centred ? LaneStencil<Dim>::rows : LaneGroup<Dim>::corner_rows;
  }
  KOKKOS_FUNCTION int node_row_of_cell(int row, int r) const {
    return node_centred ? stencil_row(row, r) : node_row(row, r);
  }
  ///@}
  /// The lowest node (i, j, k) of the box in the scene's grid. The outermost cells are void, so that
  /// node-centred cells need no more nodes than others.
  KOKKOS_FUNCTION Vector<Dim, int> lowest_node() const {
    auto node = box.first;
    if (node_centred)
      for (int i = 0; i < Dim; ++i) --node[i];
    return node;
  }
  /// Node x of a row of nodes of the box; -1 where no cell around it is in a group, so that it is not stored.
  KOKKOS_FUNCTION int node_at(int node_row, int x) const {
    const int node_group = node_group_at(node_row * (groups_per_row() + 1) + x / width);
    return node_group < 0 ? -1 : node_group * width + x % width;
  }
  /// The nodes of cell x of a row of cells of the box, numbered as in multilinear.hpp.
  KOKKOS_FUNCTION void nodes_of_cell(int row, int x, int (&node)[1 << Dim]) const {
    for (int c = 0; c < LaneGroup<Dim>::corner_rows; ++c) {
      const int along = node_row(row, c);
      node[2 * c] = node_at(along, x);
      node[2 * c + 1] = node_at(along, x + 1);
    }
  }
  /// The grid's cell in a lane.
  KOKKOS_FUNCTION Vector<Dim, int> cell(const LaneGroup<Dim>& group, int lane) const {
    Vector<Dim, int> c;
    c[0] = box.first[0] + group.x * width + lane;
    if constexpr (Dim == 2) c[1] = box.first[1] + group.row;
    if constexpr (Dim == 3) {
      c[1] = box.first[1] + group.row % rows_per_layer();
      c[2] = box.first[2] + group.row / rows_per_layer();
    }
    return c;
  }

  ///@{
  /// The entries of a group's lane 0, one `width` after the other: begin, ..., end - width.
  KOKKOS_FORCEINLINE_FUNCTION size_t begin(const LaneGroup<Dim>& group) const {
    return static_cast<size_t>(group.first) * width;
  }
  KOKKOS_FORCEINLINE_FUNCTION size_t end(const LaneGroup<Dim>& group) const {
    return static_cast<size_t>(group.first + group.slots) * width;
  }
  ///@}

  /// Where an entry of a column is stored. `entry` is (slot * width + lane); of a pack, that of lane 0.
  KOKKOS_FORCEINLINE_FUNCTION Real* at(int column, size_t entry) const {
    return data.data() + static_cast<size_t>(column) * data.stride(1) + entry;
  }
  /// The numbers of a column in all lanes of a slot; `entry` is that of lane 0.
  KOKKOS_FORCEINLINE_FUNCTION P load(int column, size_t entry) const { return P::load(at(column, entry)); }
  /// Writes a column in all lanes of a slot; `entry` is that of lane 0.
  KOKKOS_FORCEINLINE_FUNCTION void store(int column, size_t entry, P value) const {
    value.store(at(column, entry));
  }
  /// N columns from `column` on, in all lanes of a slot.
  template <int N>
  KOKKOS_FORCEINLINE_FUNCTION Vector<N, P> load_row(int column, size_t entry) const {
    Vector<N, P> v;
    static_for<N>([&](auto i) VSB_UNROLLED { v[i] = load(column + i, entry); });
    return v;
  }
  /// Writes Row::size columns from `column` on, in all lanes of a slot.
  template <class Row>
  KOKKOS_FORCEINLINE_FUNCTION void store_row(int column, size_t entry, const Row& v) const {
    static_for<Row::size>([&](auto i) VSB_UNROLLED { store(column + i, entry, v[i]); });
  }
  /// The position in the cell, [0, 1)^Dim, in all lanes of a slot.
  KOKKOS_FORCEINLINE_FUNCTION Vector<Dim, P> load_xi(size_t entry) const {
    return load_row<Dim>(xi_column, entry);
  }
  /// The Cauchy stress in Pa, in all lanes of a slot.
  KOKKOS_FORCEINLINE_FUNCTION SymmetricTensor<Dim, P> load_stress(size_t entry) const {
    SymmetricTensor<Dim, P> s;
    static_for<stress_size>([&](auto c) VSB_UNROLLED { s[c] = load(stress_column + c, entry); });
    return s;
  }
  /// The number of one of `groups`.
  KOKKOS_FORCEINLINE_FUNCTION int number_of(const LaneGroup<Dim>& group) const {
    return static_cast<int>(&group - groups.data());
  }
  /// The number of a group, or -1 where there is none; x in groups.
  KOKKOS_FUNCTION int group_of(int row, int x) const {
    return x < 0 || x >= groups_per_row() ? -1 : group_at(row * groups_per_row() + x);
  }
  /// The lanes in which a group holds particles.
  KOKKOS_FUNCTION LaneMask cells_with_particles(const LaneGroup<Dim>& group) const {
    LaneMask lanes = 0;
    for (int s = group.first; s < group.first + group.slots; ++s) lanes |= with_particle(s);
    return lanes;
  }
  /// Makes an entry a ghost. The caller updates the mask of its slot.
  KOKKOS_FUNCTION void clear(size_t entry) const {
    for (int c = 0; c < columns(); ++c) *at(c, entry) = c < Dim ? Real(0.5) : Real(0);
    id(entry) = -1;
  }
};

/// Nodes of the cell lanes, in node groups of `width` side by side.
template <int Dim, class Real, class Device>
struct LaneNodes {
  /// Columns of one set of sums: mass, momentum, force.
  static constexpr int sum_columns = 1 + 2 * Dim;
  ///@{
  /// The columns of `data`: the sums of the layers above and below the node, dt a, dt v, dt v*, 1 / m. Only
  /// node-centred cells have the sums of a layer in the middle.
  static constexpr int lower_sums = 0, upper_sums = sum_columns, increment_column = 2 * sum_columns,
                       displacement_column = increment_column + Dim,
                       remapped_column = displacement_column + Dim,
                       inverse_mass_column = remapped_column + Dim, column_count = inverse_mass_column + 1;
  /// Node-centred cells: sums of the plane in the middle of a layer.
  static constexpr int middle_sums = column_count, spline_column_count = column_count + sum_columns;
  ///@}
  using P = typename Lanes<Real>::Pack;                   ///< one number of `width` nodes side by side
  Kokkos::View<Real**, Kokkos::LayoutLeft, Device> data;  ///< [node][column]: lower and upper sums of mass in
                                                          ///< kg, momentum in kg m/s and force in N; dt a in
                                                          ///< m/s; dt v and dt v* in cells; 1 / m
  Kokkos::View<std::uint32_t* [Dim], Device> fixed;  ///< [node group][component]: bit l: prescribed in lane l

  /// The column of sum number `sum` to which a cell adds at its corner a, by the layer of the cell.
  KOKKOS_FUNCTION static constexpr int sum_column(int sum, int a) {
    return (Dim > 1 && (a >> (Dim - 1) & 1) ? upper_sums : lower_sums) + sum;
  }
  /// The sums to which a layer of node-centred cells adds at its node plane 0, 1 or 2.
  KOKKOS_FUNCTION static constexpr int sums_of_plane(int plane) {
    return plane == 0 ? lower_sums : plane == 1 ? middle_sums : upper_sums;
  }
  /// Where a number of a node is stored.
  KOKKOS_FORCEINLINE_FUNCTION Real* at(int column, int node) const {
    return data.data() + static_cast<size_t>(column) * data.stride(1) + node;
  }
  /// A column of `width` nodes from `node` on.
  KOKKOS_FORCEINLINE_FUNCTION P load(int column, int node) const { return P::load(at(column, node)); }
};

/// Migrating particles: copies of the slots that particles left, in the order in which the sweep over their
/// layer came to the slots.
template <int Dim, class Real, class Device>
struct MigratingParticles {
  /// Lanes of a slot.
  static constexpr int width = Lanes<Real>::width;
  /// Who left a slot, and where to.
  struct Head {
    ///@{
    /// Of the group that they left.
    int x, row;
    ///@}
    LaneMask to[3];                ///< lanes whose particle goes to the layer below, the same, the one above
    LaneMask far;                  ///< lanes whose particle goes farther
    LaneMask overflow[3];          ///< of `to` and `far`: those that found no group or slot
    int id[width];                 ///< of the particle in a lane
    Vector<Dim, int> cell[width];  ///< where to; only of lanes that lost their particle
    /// The lanes whose particle found no position in its new cell.
    KOKKOS_FUNCTION LaneMask overflowed() const { return overflow[0] | overflow[1] | overflow[2]; }
  };
  Kokkos::View<Real**, Kokkos::LayoutRight, Device> data;  ///< [copy][column of CellLanes * width + lane]
  Kokkos::View<Head*, Device> head;                        ///< [copy]
  Kokkos::View<int*, Device> first;                        ///< [layer]: first copy of the list of the layer
  Kokkos::View<int*, Device> count;                        ///< [layer]: number of copies
  Kokkos::View<int*, Device> lost;                         ///< [layer]: particles in them
  Kokkos::View<int*, Device> many;      ///< [layer]: 1 where so many left that the sums of the layers around
                                        ///< are to be made anew
  Kokkos::View<int*, Device> unsummed;  ///< [layer]: 1 where they have not been

  /// Calls work(copy, lane) for all particles without a group or slot, in order.
  template <class Work>
  KOKKOS_FUNCTION void for_each_overflow(int layer, const Work& work) const {
    for (int n = first(layer); n < first(layer) + count(layer); ++n) {
      const LaneMask lanes = head(n).overflowed();
      for (int l = 0; l < width; ++l)
        if (lanes >> l & 1) work(n, l);
    }
  }
};

}  // namespace vsb
