// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Brings everything up to date that depends on the positions of the particles: their bins at every call; the
/// order of the particles by bin and the boundary nodes when a particle changed its bin, or a traction is
/// declared at other nodes.
///
/// Bases with ghost layers have bins that are not cells: a particle may change its cell and stay in its bin.
/// Their boundary nodes are found at every call. With a fill criterion the boundary nodes depend on the
/// volumes too, and the fill of the cells is summed at every call. The nodes depend on the present particles
/// alone, so that a resumed run has the same ones.
#pragma once

#include <vsb/kernels/boundary/filter_voids.hpp>
#include <vsb/kernels/boundary/mark_boundary_nodes.hpp>
#include <vsb/kernels/boundary/mark_underfilled_cells.hpp>
#include <vsb/kernels/particles/locate_particles.hpp>

namespace vsb {

/// Cells, bins and boundary nodes of a set of particles; kept from step to step.
template <class Device>
struct Occupancy {
  ParticleBins<Device> bins;        ///< of the particles
  CellBits<Device> cells;           ///< E1, E2 and the other sets of Algorithm 1
  BoundaryNodes<Device> tractions;  ///< [node]: the tractions declared at the node
  BoundaryNodes<Device> boundary;   ///< [node]: the tractions that act there, N1 of Algorithm 1
  TractionMask at_all_active_nodes =
      0;                         ///< the tractions that act at all active nodes, where they are declared
  BoundaryNodes<Device> marked;  ///< [node]: `tractions` as the last update found them
  TractionMask marked_at_all_active_nodes = 0;  ///< `at_all_active_nodes` as the last update found it
  TractionMask declared = 0;                    ///< the tractions that were declared at any node so far
  int boundary_node_count = 0;                  ///< nodes at which some traction acts
  double minimum_fill = 0;  ///< of a cell's volume, see set_fill_criterion; 0: no criterion
};

/// Allocates the occupancy of `particles` particles; no traction is declared anywhere yet.
template <class Device, class Basis>
Occupancy<Device> allocate_occupancy(int particles, const Basis& basis) {
  check_grid(basis.grid);
  const auto nodes = static_cast<size_t>(basis.node_count());
  Occupancy<Device> o;
  o.bins = allocate_bins<Device>(particles, basis.bin_count());
  o.cells = allocate_cell_bits<Device>(basis.grid);
  o.tractions = BoundaryNodes<Device>("vsb::declared_tractions", nodes);
  o.boundary = BoundaryNodes<Device>("vsb::boundary_nodes", nodes);
  o.marked = BoundaryNodes<Device>("vsb::marked_tractions", nodes);
  return o;
}

/// From the next update on, cells that the particles fill by less than 1 - tau, 0 < tau < 1, are cells of E2.
/// tau must be well above the strain of the cells inside the body and the scatter of their fill; else these
/// are cells of E2 too.
template <class Device>
void set_fill_criterion(Occupancy<Device>& o, double tau) {
  o.minimum_fill = 1 - tau;
  o.cells.underfilled = typename CellBits<Device>::Rows("vsb::cells_underfilled", o.cells.boundary.extent(0),
                                                        o.cells.boundary.extent(1));
  Kokkos::deep_copy(o.cells.underfilled,
                    ~std::uint64_t(0));  // not a valid set, so that the next update finds a change
}

/// From the next update on, tractions are declared where the particles are that carry them, beside those of
/// Occupancy::tractions. carried [particle]; `tractions`: those that some particle carries.
template <class Device, class Basis>
void set_carried_tractions(Occupancy<Device>& o, const Basis& basis,
                           const Kokkos::View<TractionMask*, Device>& carried, TractionMask tractions) {
  auto& c = o.cells.carried;
  c.particle = carried;
  c.tractions = tractions;
  const BitRows<Basis::dimension> rows(basis.grid);
  fit_carried(c, static_cast<size_t>(rows.cell_row_count()), static_cast<size_t>(rows.node_row_count()),
              static_cast<size_t>(rows.words));
  mark_anew(o);
}

/// Makes the next update mark the boundary whether or not a particle has changed its bin.
template <class Device>
void mark_anew(Occupancy<Device>& o) {
  Kokkos::deep_copy(o.bins.bin, -1);
}

/// From the next update on, only void cells of the outside are cells of E1. The outside starts with all
/// cells; clear the bits in CellBits::outside of cells that are known to lie in the body.
template <class Device, class Basis>
void set_void_filter(Occupancy<Device>& o, const Basis& basis) {
  o.cells.outside = typename CellBits<Device>::Rows("vsb::cells_outside", o.cells.boundary.extent(0),
                                                    o.cells.boundary.extent(1));
  const auto host = Kokkos::create_mirror_view(o.cells.outside);
  const auto tiling = BitRows<Basis::dimension>::of(basis);
  for (int r = 0; r < tiling.cell_row_count(); ++r)
    for (int w = 0; w < tiling.words; ++w) host(r, w) = tiling.existing(tiling.cell_row_indices(r), w, 0);
  Kokkos::deep_copy(o.cells.outside, host);
  mark_anew(o);
}

namespace kernel {

/// One particle as in LocateParticle, and one node: the result is 0 also where the node's declaration is not
/// the one that was marked.
template <class Basis, class Cloud, class Device>
struct LocateAndCompare {
  LocateParticle<Basis, Cloud, Device> locate;
  BoundaryNodes<Device> tractions, marked;
  int particles, nodes;

  KOKKOS_FUNCTION void operator()(int i, int& minimum) const {
    if (i < particles) locate(i, minimum);
    if (i < nodes && tractions(i) != marked(i)) minimum = math::min(minimum, 0);
  }
};

/// One node: stores its declaration, to compare later ones with; reduces to the union of all declarations.
template <class Device>
struct TakeDeclaration {
  BoundaryNodes<Device> tractions, marked;
  KOKKOS_FUNCTION void operator()(int node, TractionMask& all) const {
    marked(node) = tractions(node);
    all |= tractions(node);
  }
};

}  // namespace kernel

/// Brings the occupancy up to date with the particles and with what is declared. Returns the lowest number of
/// a particle that left the grid, else -1.
template <class Exec, class Basis, int Dim, class Real, class Device>
int update_occupancy(const Exec& exec, const Particles<Dim, Real, Device>& particles, Occupancy<Device>& o,
                     const Basis& basis) {
  const int n = particles.count(), nodes = basis.node_count();
  detail::check_rows("Occupancy::tractions", o.tractions.extent(0), nodes,
                     "make the state, or the occupancy, with the basis of the step");
  if (o.minimum_fill > 0 && o.cells.underfilled.size() == 0)
    detail::refuse("Occupancy::minimum_fill is set without the cells that it needs: call set_fill_criterion");
  using Look = kernel::LocateAndCompare<Basis, Particles<Dim, Real, Device>, Device>;
  auto where =
      detail::whereabouts(exec, Look{{particles, basis, o.bins.bin}, o.tractions, o.marked, n, nodes},
                          math::max(n, nodes), n, o.bins, basis);
  if (where.lost >= 0) return where.lost;
  where.changed = where.changed || o.at_all_active_nodes != o.marked_at_all_active_nodes;
  if (where.changed) {
    sort_by_bin(exec, o.bins);
    TractionMask declared = 0;
    Kokkos::parallel_reduce("vsb::take_declarations", Kokkos::RangePolicy<Exec>(exec, 0, nodes),
                            kernel::TakeDeclaration<Device>{o.tractions, o.marked},
                            Kokkos::BOr<TractionMask>(declared));
    exec.fence();
    o.declared |= declared;
    o.marked_at_all_active_nodes = o.at_all_active_nodes;
  }
  const bool refilled = o.minimum_fill > 0 && mark_underfilled_cells(exec, particles, o.bins, basis,
                                                                     o.minimum_fill, o.cells.underfilled);
  const bool moved = where.changed || Basis::ghost_layers > 0;
  if (moved && o.cells.outside.size() > 0) update_outside(exec, particles, o.cells, basis);
  if (moved || refilled)
    o.boundary_node_count = mark_boundary_of_located(exec, particles, o.cells, basis, o.tractions, o.boundary,
                                                     o.at_all_active_nodes);
  return -1;
}

}  // namespace vsb
