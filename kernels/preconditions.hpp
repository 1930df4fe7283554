// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Checks of what a caller passes, where an omission would run and give wrong results without any sign of it.
/// They run on the host at every call, on extents and flags. Each throws std::invalid_argument with what to
/// do.
///
/// check_masses alone reads fields of particles: masses and volumes, once for new particles.
#pragma once

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <type_traits>
#include <vsb/physics/uniform_grid.hpp>
#include <vsb/physics/virtual_stress.hpp>
#include <vsb/views/particles.hpp>

namespace vsb {

namespace detail {

/// Throws std::invalid_argument with the text that the parts make.
template <class... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  std::ostringstream text;
  text << "vsb: ";
  (text << ... << parts);
  throw std::invalid_argument(text.str());
}

/// Refuses a View with another number of rows than expected.
inline void check_rows(const char* what, size_t rows, int expected, const char* cure) {
  if (rows != static_cast<size_t>(expected))
    refuse(what, " has ", rows, " rows where there are ", expected, ": ", cure);
}

}  // namespace detail

/// Refuses a grid without cells, or with more nodes than an int counts.
template <int Dim>
void check_grid(const CellNumbering<Dim>& grid) {
  double nodes = 1;
  for (int i = 0; i < Dim; ++i) {
    if (grid.cells[i] < 1)
      detail::refuse("the grid has ", grid.cells[i], " cells in direction ", i, ": give it one or more");
    nodes *= grid.cells[i] + 1.0;
  }
  if (nodes > std::numeric_limits<int>::max())
    detail::refuse("the grid has ", nodes,
                   " nodes, more than an int counts: make it smaller, or its cells larger");
}

/// Refuses a grid without cells, or whose cells have no size.
template <int Dim, class Real>
void check_grid(const UniformGrid<Dim, Real>& grid) {
  for (int i = 0; i < Dim; ++i)
    if (!(grid.spacing[i] > Real(0)) || !std::isfinite(grid.spacing[i]) || !std::isfinite(grid.lower[i]) ||
        !std::isfinite(grid.inverse_spacing[i]))
      detail::refuse("the grid begins at ", grid.lower[i], " m and has cells of ", grid.spacing[i],
                     " m in direction ", i,
                     ": set it to UniformGrid(lower corner, cell size, number of cells), the size above 0");
  check_grid(static_cast<const CellNumbering<Dim>&>(grid));
}

/// Refuses particles whose material state has too few rows or columns for a material.
template <int Dim, class Real, class Device>
void check_material_state(const Particles<Dim, Real, Device>& particles, int first, int last, int columns) {
  const auto& state = particles.material_state;
  if (columns == 0 || first == last ||
      (first >= 0 && last <= static_cast<int>(state.extent(0)) &&
       columns <= static_cast<int>(state.extent(1))))
    return;
  throw std::invalid_argument("vsb::Particles: material_state is " + std::to_string(state.extent(0)) + " x " +
                              std::to_string(state.extent(1)) + "; a body's material needs rows " +
                              std::to_string(first) + " to " + std::to_string(last - 1) + " with " +
                              std::to_string(columns) + " columns");
}

namespace kernel {

/// One particle: the lowest number of those without a mass and a volume above 0.
template <int Dim, class Real, class Device>
struct FindMassless {
  Particles<Dim, Real, Device> particles;
  KOKKOS_FUNCTION void operator()(int p, int& lowest) const {
    if (p < lowest && !(particles.mass(p) > Real(0) && particles.volume(p) > Real(0))) lowest = p;
  }
};

}  // namespace kernel

/// Refuses particles of which some have no mass or no volume. Reads all particles, so call it only for new
/// ones. Waits for the device.
template <class Exec, int Dim, class Real, class Device>
void check_masses(const Exec& exec, const Particles<Dim, Real, Device>& particles) {
  const int n = particles.count();
  int lowest = n;
  Kokkos::parallel_reduce("vsb::find_massless", Kokkos::RangePolicy<Exec>(exec, 0, n),
                          kernel::FindMassless<Dim, Real, Device>{particles}, Kokkos::Min<int>(lowest));
  exec.fence();
  if (lowest < n)
    detail::refuse("particle ", lowest,
                   " has a mass or a volume that is not above 0: fill Particles::mass (kg) and "
                   "Particles::volume (m^3; per unit of the directions left out in 1D and 2D) first");
}

/// Refuses numbers of Gauss points for which there is no rule.
inline void check_gauss_points(int per_direction) {
  if (per_direction < 1 || per_direction > 4)
    detail::refuse("the original method has ", per_direction,
                   " Gauss points per direction: allowed are 1 to 4");
}

/// Refuses a load that finds no node at the start. `loaded`: the nodes that carry a traction.
inline void check_loaded(int loaded) {
  if (loaded > 0) return;
  detail::refuse(
      "tractions are declared, but no boundary node carries one: the method loads nodes between a cell with "
      "particles and an empty one, so let the grid reach a cell beyond a loaded face, and declare at its "
      "nodes "
      "(count_loaded_nodes and Occupancy::boundary_node_count tell how many are loaded); pass "
      "NoVirtualStress{} as long as there is nothing to load");
}

/// Refuses a load that does not go with what is declared: `declared` are the tractions declared at nodes,
/// `beside` says whether some act beside the nodes of the modified method, on surface points for example.
template <class Field>
void check_load(const Field& field, TractionMask declared, bool beside) {
  if constexpr (!std::is_same_v<Field, NoVirtualStress>) {
    const TractionMask known = field.known();
    if (known == 0)
      detail::refuse("the load has no traction: set its `count` to their number, or pass NoVirtualStress{}");
    if constexpr (Field::loaded) {
      if (declared == 0 && !beside)
        detail::refuse(
            "no traction is declared at any node, so that the load would act nowhere: set bit k at "
            "the nodes where traction k may act (State::occupancy.tractions; on cell lanes "
            "LaneState::boundary.everywhere or .declared), or pass NoVirtualStress{}");
      for (int k = 0; k < 32; ++k)
        if ((declared & ~known) >> k & 1u)
          detail::refuse("traction ", k,
                         " is declared at nodes, but the load has no stress for it: set its "
                         "`count` to the number of tractions, and a stress for each");
    }
  }
}

}  // namespace vsb
