// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Removes particles (Algorithm 2, step 3). The fields of the others are compacted in their order:
///   row k of a field <- row kept(k),   kept = the numbers of the particles that stay, in increasing order.
///
/// Reads the flags of the particles to remove; changes fields in place, column by column through one column
/// of scratch memory. The result does not depend on the number of threads.
#pragma once

#include <vsb/views/particles.hpp>

namespace vsb {

namespace kernel {

/// Lists the numbers of the particles that stay.
template <class Device>
struct ListKept {
  Kokkos::View<const unsigned char*, Device> removed;  ///< [particle]: 1 where it goes
  Kokkos::View<int*, Device> kept;

  KOKKOS_FUNCTION void operator()(int p, int& count, bool final) const {
    if (removed(p) != 0) return;
    if (final) kept(count) = p;
    ++count;
  }
};

template <class Column, class Real, class Device>
struct GatherRows {
  Column column;
  Kokkos::View<const int*, Device> kept;
  Kokkos::View<Real*, Device> scratch;
  KOKKOS_FUNCTION void operator()(int k) const { scratch(k) = column(kept(k)); }
};

template <class Column, class Real, class Device>
struct StoreRows {
  Column column;
  Kokkos::View<Real*, Device> scratch;
  KOKKOS_FUNCTION void operator()(int k) const { column(k) = scratch(k); }
};

}  // namespace kernel

/// The numbers of the particles that stay, of those for which removed(p) is 0, in order. Waits for the
/// device.
template <class Exec, class Device>
Kokkos::View<int*, Device> list_kept(const Exec& exec,
                                     const Kokkos::View<const unsigned char*, Device>& removed) {
  const int n = static_cast<int>(removed.extent(0));
  const Kokkos::View<int*, Device> kept("vsb::kept_particles", removed.extent(0));
  int count = 0;
  Kokkos::parallel_scan("vsb::list_kept", Kokkos::RangePolicy<Exec>(exec, 0, n),
                        kernel::ListKept<Device>{removed, kept}, count);
  exec.fence();
  return Kokkos::View<int*, Device>(kept, std::make_pair(0, count));
}

/// Moves the kept rows of a field to its first rows; rows beyond them stay as they were. `scratch` must be
/// large enough for one column of them.
template <class Exec, class Real, class Device>
void keep_rows(const Exec& exec, const Kokkos::View<Real**, Kokkos::LayoutStride, Device>& field,
               const Kokkos::View<const int*, Device>& kept, const Kokkos::View<Real*, Device>& scratch) {
  const Kokkos::RangePolicy<Exec> over_kept(exec, 0, static_cast<int>(kept.extent(0)));
  for (size_t c = 0; c < field.extent(1); ++c) {
    const auto column = Kokkos::subview(field, Kokkos::ALL(), c);
    using Column = std::decay_t<decltype(column)>;
    Kokkos::parallel_for("vsb::gather_rows", over_kept,
                         kernel::GatherRows<Column, Real, Device>{column, kept, scratch});
    Kokkos::parallel_for("vsb::store_rows", over_kept,
                         kernel::StoreRows<Column, Real, Device>{column, scratch});
  }
}

/// Moves the particles of a block that stay up to its first rows, and returns the block with these particles
/// alone, in the same memory. `kept_states`: the rows of material state that stay.
template <class Exec, int Dim, class Real, class Device>
ParticleBlock<Dim, Real, Device> keep_particles(const Exec& exec,
                                                const ParticleBlock<Dim, Real, Device>& block,
                                                const Kokkos::View<const int*, Device>& kept,
                                                const Kokkos::View<const int*, Device>& kept_states) {
  using Fields = typename Particles<Dim, Real, Device>::Fields;
  const auto rows = std::max(kept.extent(0), kept_states.extent(0));
  const Kokkos::View<Real*, Device> scratch(
      Kokkos::view_alloc("vsb::kept_column", Kokkos::WithoutInitializing), rows);
  const auto of = [&](const auto& b, size_t n) {
    return Fields(Kokkos::subview(b, std::make_pair(size_t(0), n), Kokkos::ALL()));
  };
  keep_rows(exec, of(block.block, block.particles.mass.extent(0)), kept, scratch);
  ParticleBlock<Dim, Real, Device> left(block.block, static_cast<int>(kept.extent(0)));
  if (block.state_block.size() > 0) {
    keep_rows(exec, block.particles.material_state, kept_states, scratch);
    left.set_state(block.state_block, static_cast<int>(kept_states.extent(0)));
  }
  exec.fence();
  return left;
}

}  // namespace vsb
