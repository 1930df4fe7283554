// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The memory of a mapped grid: the positions of its nodes, and the first cells of the search for a point.
#pragma once

#include <vsb/views/kokkos_compat.hpp>

namespace vsb {

/// Views of what a mapped grid reads; physics/mapped_grid.hpp computes with them,
/// kernels/mesh/make_mapped_mesh.hpp fills them.
template <class Real, class Device>
struct MappedNodes {
  Kokkos::View<Real**, Kokkos::LayoutRight, Device> position;  ///< [node][Dim], m
  Kokkos::View<int*, Device> start_cell;                       ///< [raster cell], see physics/mapped_grid.hpp
};

}  // namespace vsb
