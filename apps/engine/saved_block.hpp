// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The state of the particle kernels bit by bit: the columns of the particles and of their material states
/// without padding, positions and areas of the surface points, and the outside of the void filter.
#pragma once

#include <cstdint>
#include <vsb/kernels/step.hpp>
#include "engine/byte_stream.hpp"

namespace vsb::app {

namespace detail {

/// Visits the columns: first value, rows.
template <int Dim, class Real, class Visit>
void for_each_column(const ParticleBlock<Dim, Real, Kokkos::HostSpace>& host, const Visit& visit) {
  const auto columns = [&](const auto& block, size_t rows) {
    for (size_t c = 0; c < block.extent(1); ++c) visit(&block(0, c), rows);
  };
  columns(host.block, host.particles.mass.extent(0));
  columns(host.state_block, host.particles.material_state.extent(0));
}

}  // namespace detail

template <int Dim, class Real, class Device>
void save_block(const ParticleBlock<Dim, Real, Device>& block, const State<Dim, Real, Device>& state,
                ByteSink& to) {
  ByteWriter w(to);
  detail::for_each_column(host_copy(block), [&](const Real* column, size_t rows) { w.values(column, rows); });
  const auto save = [&](const auto& view) {
    const auto on_host =
        Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), view, "vsb::saved view on host");
    w.values(on_host.data(), on_host.span());
  };
  save(state.surface.position);
  save(state.surface.area);
  save(state.occupancy.cells.outside);
}

/// False where the bytes do not fit these particles.
template <int Dim, class Real, class Device>
bool restore_block(ByteSource& from, const ParticleBlock<Dim, Real, Device>& block,
                   State<Dim, Real, Device>& state) {
  ByteCount needed;
  save_block(block, state, needed);
  if (from.size() != needed.count) return false;
  ByteReader r(from);
  const auto host = host_copy(block);
  detail::for_each_column(host, [&](Real* column, size_t rows) { r.values(column, rows); });
  copy_to_device(host, block);
  const auto restore = [&](const auto& view) {
    const auto on_host = Kokkos::create_mirror_view(view);
    r.values(on_host.data(), on_host.span());
    Kokkos::deep_copy(view, on_host);
  };
  restore(state.surface.position);
  restore(state.surface.area);
  restore(state.occupancy.cells.outside);
  if (state.occupancy.cells.outside.span() > 0) mark_anew(state.occupancy);
  return true;
}

}  // namespace vsb::app
