// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Packs particles by cell (views/cell_lanes.hpp) and unpacks them.
///
/// Within a cell, particles are in the order of their numbers at first, and later in the order in which they
/// arrived. Neither order depends on the number of threads.
#pragma once

#include <vsb/kernels/lanes/layout.hpp>
#include <vsb/kernels/particles/locate_particles.hpp>
#include <vsb/physics/multilinear.hpp>

namespace vsb {

namespace kernel {

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

/// The particle numbers of the entries of one group, from particles sorted by cell.
template <int Dim, class Real, class Device>
struct PackNumbers {
  CellLanes<Dim, Real, Device> lanes;
  ParticleBins<Device> bins;

  KOKKOS_FUNCTION void operator()(int g) const {
    constexpr int width = Lanes<Real>::width;
    const auto& group = lanes.groups(g);
    const int first_bin = (group.row * lanes.groups_per_row() + group.x) * width;
    for (int s = 0; s < group.capacity; ++s) {
      LaneMask with_particle = 0;
      for (int l = 0; l < width; ++l) {
        const int begin = bins.offset(first_bin + l), count = bins.offset(first_bin + l + 1) - begin;
        lanes.id((group.first + s) * width + l) = s < count ? bins.order(begin + s) : -1;
        if (s < count) with_particle |= LaneMask(1) << l;
      }
      lanes.with_particle(group.first + s) = with_particle;
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
                      : off_the_faces(
                            grid.in_cells(value, column) -
                            static_cast<Real>(lanes.cell(group, static_cast<int>(e % lanes.width))[column]));
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

}  // namespace kernel

namespace detail {

/// Makes groups for the particles and fills in their numbers. The caller fills the columns. Returns -1, or
/// the lowest number of a particle outside the grid.
template <class Exec, int Dim, class Real, class Device>
int lay_out_particles(const Exec& exec, const Particles<Dim, Real, Device>& particles,
                      LaneMemory<Dim, Real, Device>& m) {
  using Cells = CellLanes<Dim, Real, Device>;
  require_accessible<Exec, Device>();
  const int n = particles.count();
  particles.check();
  check_grid(m.grid);
  check_material_state(particles, 0, n, m.lanes.state_size);
  check_masses(exec, particles);
  Vector<Dim, int> lowest, highest;
  for (int i = 0; i < Dim; ++i)
    for (const int sign : {1, -1}) {
      int found = 0;
      Kokkos::parallel_reduce("vsb::cell_range", Kokkos::RangePolicy<Exec>(exec, 0, n),
                              kernel::CellRange<Dim, Real, Device>{particles, m.grid, i, sign},
                              Kokkos::Min<int>(found));
      exec.fence();
      // Without particles, or with all of them outside, the minimum is the largest int.
      const int cell = found == std::numeric_limits<int>::max() ? 0 : sign * found;
      (sign > 0 ? lowest : highest)[i] = cell;
    }
  const kernel::BoxBasis<Dim, Real> basis{m.grid, box_around<Dim, Real>(lowest, highest, m.group_margin)};
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

/// The field component of the particles that becomes a column of the lanes.
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
  detail::allocate_migrating(exec, m);
  exec.fence();
  return -1;
}

/// Zero-filled particles to be packed in their own memory. It has capacity for the entries of slots that stay
/// empty, and for `state_size` numbers of material state per particle. On the host, memory that is not
/// written to is not taken from the system.
template <int Dim, class Real, class Device>
ParticleBlock<Dim, Real, Device> allocate_particles_to_pack(int n, int state_size = 0) {
  using Result = ParticleBlock<Dim, Real, Device>;
  static_assert(Result::columns() == CellLanes<Dim, Real, Device>::state_column,
                "the lanes have the block's");
  const int rows = detail::reserved_rows<Device>(n) + 64 * Lanes<Real>::width;
  const typename Result::Block block(Kokkos::view_alloc("vsb::particles", Kokkos::WithoutInitializing),
                                     static_cast<size_t>(padded_rows<Real>(rows)),
                                     static_cast<size_t>(Result::columns() + state_size));
  Kokkos::deep_copy(Kokkos::subview(block, std::make_pair(0, n), std::make_pair(0, Result::columns())),
                    Real(0));
  return Result(block, n);
}

/// pack_particles for particles that the caller no longer needs. Their memory becomes that of the lanes where
/// it is large enough (allocate_particles_to_pack), so that there are never two copies of all particles. The
/// block is empty afterwards, and views of its fields must not be used any more. Where a particle lies
/// outside the grid, nothing is changed.
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
  detail::allocate_migrating(exec, m);
  exec.fence();
  return -1;
}

/// Writes the particles back, in the order of their numbers.
template <class Exec, int Dim, class Real, class Device>
void unpack_particles(const Exec& exec, const LaneMemory<Dim, Real, Device>& m,
                      const Particles<Dim, Real, Device>& particles) {
  particles.check();
  detail::check_rows("Particles::position", particles.position.extent(0), m.lanes.particle_count,
                     "unpack into as many particles as were packed");
  check_material_state(particles, 0, particles.count(), m.lanes.state_size);
  Kokkos::parallel_for("vsb::unpack_particles", Kokkos::RangePolicy<Exec>(exec, 0, m.lanes.group_count),
                       kernel::UnpackGroup<Dim, Real, Device>{m.lanes, particles, m.grid});
}

}  // namespace vsb
