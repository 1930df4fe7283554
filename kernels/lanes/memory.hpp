// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What cell lanes need beside their particles (views/cell_lanes.hpp), and where their memory comes from.
#pragma once

#include <vsb/physics/uniform_grid.hpp>
#include <vsb/physics/walls.hpp>
#include <vsb/views/cell_lanes.hpp>

namespace vsb {

/// How far beyond the particles there are groups, for particles that will move there: in groups along x, in
/// rows along the other axes.
template <int Dim>
struct GroupMargin {
  ///@{
  /// In groups along x, in rows along the other axes; 0: only where particles are.
  Vector<Dim, int> below = Vector<Dim, int>::zero(), above = Vector<Dim, int>::zero();
  ///@}
  /// Whether there is room beyond the particles in some direction.
  bool any() const {
    bool some = false;
    for (int i = 0; i < Dim; ++i) some = some || below[i] > 0 || above[i] > 0;
    return some;
  }
};

/// How a step re-maps: by the consistent mass matrix, in one sweep over the particles, or in a second sweep.
/// chosen: the faster one by the number of particles per cell.
enum class RemapMethod : std::uint8_t { chosen, mass_matrix, second_sweep };

/// Whether the re-map by the mass matrix is faster, as measured. The mass matrix costs work per cell; it
/// saves work per particle. In 3D it saves mostly memory traffic, which counts only where the particles do
/// not fit into the caches. The cache size is a constant, so that a scene has the same bits on all machines.
template <int Dim, class Real, class Device>
bool mass_matrix_is_faster(const CellLanes<Dim, Real, Device>& lanes, int cells_with_particles) {
  constexpr int per_cell = CellLanes<Dim, Real, Device>::mass_matrix_size;
  constexpr double caches = 96e6;  // bytes
  const double bytes = static_cast<double>(sizeof(Real)) * lanes.columns() * lanes.particle_count;
  return lanes.particle_count >= per_cell * cells_with_particles && (Dim < 3 || bytes > caches);
}

/// What the cell lanes of a body need beside the particles.
template <int Dim, class Real, class Device>
struct LaneMemory {
  CellLanes<Dim, Real, Device> lanes;               ///< the packed particles
  LaneNodes<Dim, Real, Device> nodes;               ///< of the groups
  MigratingParticles<Dim, Real, Device> migrating;  ///< particles under way to another cell
  UniformGrid<Dim, Real> grid;                      ///< of the cells in the lanes
  Walls<Dim> walls;                    ///< faces whose ghost nodes are mirror images, for node-centred cells
  UniformGrid<Dim, Real> packed_grid;  ///< what `grid` and `walls` were when the nodes were numbered
  Walls<Dim> packed_walls;             ///< see packed_grid
  int slack = 1;                       ///< slots that a group has to spare
  GroupMargin<Dim> group_margin;       ///< of every packing, until particles stay in their groups for long
  RemapMethod remap_method = RemapMethod::chosen;      ///< how steps re-map
  typename CellLanes<Dim, Real, Device>::Ints source;  ///< scratch of repack_lanes, as is column_before
  Kokkos::View<Real*, Device> column_before;           ///< see source
};

/// Makes steps re-map by the mass matrix (`by_mass_matrix`), or in a second sweep.
template <int Dim, class Real, class Device>
void set_remap_method(CellLanes<Dim, Real, Device>& lanes, bool by_mass_matrix) {
  lanes.mass_matrices = by_mass_matrix ? decltype(lanes.mass_matrices)(
                                             "vsb::mass_matrices", static_cast<size_t>(lanes.group_count) *
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

/// Rows to allocate where their number may grow. On the host, rows that are not written to take no memory.
template <class Device>
int reserved_rows(int rows) {
  using Memory = typename Device::memory_space;
  return Kokkos::SpaceAccessibility<Kokkos::HostSpace, Memory>::accessible ? 2 * rows : rows + rows / 16;
}

/// Columns for `slots` slots, with reserve.
template <int Dim, class Real, class Device>
void allocate_columns(CellLanes<Dim, Real, Device>& lanes, int slots) {
  lanes.data =
      decltype(lanes.data)(Kokkos::view_alloc("vsb::cell_lanes", Kokkos::WithoutInitializing),
                           static_cast<size_t>(padded_rows<Real>(reserved_rows<Device>(slots) * lanes.width)),
                           static_cast<size_t>(lanes.columns()));
}

/// Numbers of particles for `slots` slots.
template <int Dim, class Real, class Device>
void allocate_numbers(CellLanes<Dim, Real, Device>& lanes, int slots) {
  lanes.id = decltype(lanes.id)(Kokkos::view_alloc("vsb::lane_ids", Kokkos::WithoutInitializing),
                                static_cast<size_t>(slots) * lanes.width);
  lanes.with_particle = decltype(lanes.with_particle)("vsb::lanes_with_particle", static_cast<size_t>(slots));
}

/// Allocates the lists of migrating particles, each with capacity for all particles of its layer.
template <class Exec, int Dim, class Real, class Device>
void allocate_migrating(const Exec& exec, LaneMemory<Dim, Real, Device>& m) {
  const auto& lanes = m.lanes;
  const auto slots = static_cast<size_t>(lanes.slot_count),
             numbers = static_cast<size_t>(lanes.columns() * lanes.width);
  auto& l = m.migrating;
  if (l.data.extent(0) < slots || l.data.extent(1) != numbers) {
    l.data =
        decltype(l.data)(Kokkos::view_alloc("vsb::migrating", Kokkos::WithoutInitializing), slots, numbers);
    l.head = decltype(l.head)(Kokkos::view_alloc("vsb::migrating_heads", Kokkos::WithoutInitializing), slots);
  }
  const auto per_layer = [&](const std::string& name) {
    return decltype(l.first)(name, static_cast<size_t>(lanes.layers()));
  };
  l.count = per_layer("vsb::migrating_count");
  l.lost = per_layer("vsb::migrating_lost");
  l.many = per_layer("vsb::migrating_many");
  l.unsummed = per_layer("vsb::unsummed_layers");
  l.first = per_layer("vsb::migrating_first");
  const auto first = l.first;
  Kokkos::parallel_for(
      "vsb::first_migrating", Kokkos::RangePolicy<Exec>(exec, 0, lanes.layers()), KOKKOS_LAMBDA(int k) {
        const int g = lanes.layer_first(k);
        first(k) = g < lanes.group_count ? lanes.groups(g).first : 0;
      });
}

}  // namespace detail

}  // namespace vsb
