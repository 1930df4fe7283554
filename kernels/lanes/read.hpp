// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Reads single fields of particles in cell lanes, by particle number, without unpacking all particles.
#pragma once

#include <vsb/kernels/lanes/build.hpp>
#include <vsb/physics/plastic_strain.hpp>
#include <vsb/views/nodes.hpp>

namespace vsb {

/// The entry of every particle, and the group of every slot.
template <class Device>
struct LaneIndex {
  Kokkos::View<int*, Device> entry;  ///< [particle]
  Kokkos::View<int*, Device> group;  ///< [slot]
};

namespace kernel {

template <int Dim, class Real, class Device>
struct IndexLanes {
  CellLanes<Dim, Real, Device> lanes;
  LaneIndex<Device> index;
  KOKKOS_FUNCTION void operator()(int g) const {
    const auto& group = lanes.groups(g);
    for (int s = group.first; s < group.first + group.slots; ++s) index.group(s) = g;
    for (size_t e = lanes.begin(group); e < lanes.end(group); ++e)
      if (lanes.id(e) >= 0) index.entry(lanes.id(e)) = static_cast<int>(e);
  }
};

/// Row r: columns column, ..., column + count - 1 of particle first + r.
template <int Dim, class Real, class Device>
struct ReadLaneColumns {
  CellLanes<Dim, Real, Device> lanes;
  LaneIndex<Device> index;
  int first, column, count;
  Kokkos::View<double**, Kokkos::LayoutRight, Device> rows;
  KOKKOS_FUNCTION void operator()(int r) const {
    const auto e = static_cast<size_t>(index.entry(first + r));
    for (int c = 0; c < count; ++c) rows(r, c) = *lanes.at(column + c, e);
  }
};

/// Row r: the position of particle first + r, m.
template <int Dim, class Real, class Device>
struct ReadLanePositions {
  CellLanes<Dim, Real, Device> lanes;
  LaneIndex<Device> index;
  UniformGrid<Dim, Real> grid;
  int first;
  Kokkos::View<double**, Kokkos::LayoutRight, Device> rows;
  KOKKOS_FUNCTION void operator()(int r) const {
    const auto e = static_cast<size_t>(index.entry(first + r));
    const auto& group = lanes.groups(index.group(e / lanes.width));
    Vector<Dim, Real> xi;
    for (int i = 0; i < Dim; ++i) xi[i] = *lanes.at(lanes.xi_column + i, e);
    const auto x = grid.map(lanes.cell(group, static_cast<int>(e % lanes.width)), xi).x;
    for (int i = 0; i < Dim; ++i) rows(r, i) = x[i];
  }
};

/// flag(r): whether a traction acts at a node of the cell of particle first + r (see
/// kernels/boundary/flag_boundary_particles.hpp).
template <int Dim, class Real, class Device>
struct FlagLaneParticle {
  CellLanes<Dim, Real, Device> lanes;
  LaneIndex<Device> index;
  BoundaryNodes<Device> tractions;  ///< [node of the lanes]
  int first;
  Kokkos::View<unsigned char*, Device> flag;
  KOKKOS_FUNCTION void operator()(int r) const {
    const auto e = static_cast<size_t>(index.entry(first + r));
    const auto& group = lanes.groups(index.group(e / lanes.width));
    const int lane = static_cast<int>(e % lanes.width);
    TractionMask any = 0;
    for (int a = 0; a < 1 << Dim; ++a) any |= tractions(group.node[a >> 1] + lane + (a & 1));
    flag(r) = any != 0;
  }
};

/// The particles of one group: the equivalent plastic strain (see kernels/readout/plastic_strain.hpp).
template <int Dim, class Real, class Device>
struct LanePlasticStrain {
  CellLanes<Dim, Real, Device> lanes;
  Kokkos::View<Real*, Device> strain;
  KOKKOS_FUNCTION void operator()(int g) const {
    const auto& group = lanes.groups(g);
    for (size_t e = lanes.begin(group); e < lanes.end(group); ++e) {
      if (lanes.id(e) < 0) continue;
      SymmetricTensor<Dim, Real> plastic;
      for (int c = 0; c < plastic.size; ++c) plastic[c] = *lanes.at(lanes.state_column + c, e);
      strain(lanes.id(e)) = equivalent_plastic_deviatoric_strain(plastic);
    }
  }
};

/// The particles of one group: positions and masses alone.
template <int Dim, class Real, class Device>
struct UnpackMassPoints {
  CellLanes<Dim, Real, Device> lanes;
  Particles<Dim, Real, Device> particles;
  UniformGrid<Dim, Real> grid;
  KOKKOS_FUNCTION void operator()(int g) const {
    const auto& group = lanes.groups(g);
    for (size_t e = lanes.begin(group); e < lanes.end(group); ++e) {
      const int p = lanes.id(e);
      if (p < 0) continue;
      Vector<Dim, Real> xi;
      for (int i = 0; i < Dim; ++i) xi[i] = *lanes.at(lanes.xi_column + i, e);
      const auto x = grid.map(lanes.cell(group, static_cast<int>(e % lanes.width)), xi).x;
      for (int i = 0; i < Dim; ++i) particles.position(p, i) = x[i];
      particles.mass(p) = *lanes.at(lanes.mass_column, e);
    }
  }
};

}  // namespace kernel

/// Finds the entries and groups of all particles. They are valid until the next step.
template <class Exec, int Dim, class Real, class Device>
LaneIndex<Device> index_lanes(const Exec& exec, const CellLanes<Dim, Real, Device>& lanes) {
  const auto ints = [](const std::string& name, int n) {
    return Kokkos::View<int*, Device>(Kokkos::view_alloc(name, Kokkos::WithoutInitializing),
                                      static_cast<size_t>(n));
  };
  const LaneIndex<Device> index{ints("vsb::lane_entries", lanes.particle_count),
                                ints("vsb::lane_group_of_slot", lanes.slot_count)};
  Kokkos::parallel_for("vsb::index_lanes", Kokkos::RangePolicy<Exec>(exec, 0, lanes.group_count),
                       kernel::IndexLanes<Dim, Real, Device>{lanes, index});
  return index;
}

/// Particles with positions and masses alone, for sums over nodes that need no other field.
template <class Exec, int Dim, class Real, class Device>
Particles<Dim, Real, Device> unpack_mass_points(const Exec& exec, const LaneMemory<Dim, Real, Device>& m) {
  const auto n = static_cast<size_t>(m.lanes.particle_count);
  Particles<Dim, Real, Device> particles;
  particles.position = Kokkos::View<Real**, Kokkos::LayoutLeft, Device>(
      Kokkos::view_alloc("vsb::mass_point_position", Kokkos::WithoutInitializing), n, Dim);
  particles.mass =
      Kokkos::View<Real*, Device>(Kokkos::view_alloc("vsb::mass_point_mass", Kokkos::WithoutInitializing), n);
  Kokkos::parallel_for("vsb::unpack_mass_points", Kokkos::RangePolicy<Exec>(exec, 0, m.lanes.group_count),
                       kernel::UnpackMassPoints<Dim, Real, Device>{m.lanes, particles, m.grid});
  return particles;
}

}  // namespace vsb
