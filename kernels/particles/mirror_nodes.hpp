// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Ghost nodes beyond a wall as mirror images of nodes inside (see physics/walls.hpp). With the sign s of a
/// component, -1 where it is prescribed at the wall, +1 otherwise and for masses, and the image I' of ghost
/// node I,
///   after a sum over particles:      f_I' <- f_I' + s f_I,   f_I <- 0;
///   after a velocity is known:       v_I <- s v_I'.
/// The first is the transpose of the second, so that momentum and energy are those of a body with its
/// reflection. The directions are worked on one after the other: this reflects edges and corners too.
///
/// Nothing is launched for bases without ghost nodes.
#pragma once

#include <vsb/views/nodes.hpp>

namespace vsb {

namespace kernel {

/// Line k of the nodes along an axis: its ghost nodes and their images, one cell on the other side of the
/// wall.
template <class Basis>
struct MirrorLine {
  Basis basis;
  int axis;

  int lines() const { return basis.node_count() / (basis.grid.cells[axis] + 1); }

  /// Calls work(side, ghost, image) for the walls at the ends of line k.
  template <class Work>
  KOKKOS_FUNCTION void visit(int k, const Work& work) const {
    const int stride = basis.grid.node_stride(axis), last = basis.grid.cells[axis];
    const int first = k / stride * stride * (last + 1) + k % stride;
    if (basis.mirrored(axis, 0)) work(0, first, first + 2 * stride);
    if (basis.mirrored(axis, 1)) work(1, first + last * stride, first + (last - 2) * stride);
  }
};

/// Adds the sums of the ghost nodes of a line to those of their images.
template <class Basis, class Fields>
struct FoldLine {
  MirrorLine<Basis> line;
  Fields sums;
  int scalars;  ///< leading columns that are no vector components

  KOKKOS_FUNCTION void operator()(int k) const {
    constexpr int Dim = Basis::dimension;
    line.visit(k, [&](int side, int ghost, int image) {
      for (int c = 0; c < static_cast<int>(sums.extent(1)); ++c) {
        const int s = c < scalars ? 1 : line.basis.walls.sign(line.axis, side, (c - scalars) % Dim);
        sums(image, c) += static_cast<typename Basis::real>(s) * sums(ghost, c);
        sums(ghost, c) = 0;
      }
    });
  }
};

/// Gives the ghost nodes of a line the vectors of their images.
template <class Basis, class Fields>
struct MirrorVectors {
  MirrorLine<Basis> line;
  Fields vectors;

  KOKKOS_FUNCTION void operator()(int k) const {
    line.visit(k, [&](int side, int ghost, int image) {
      for (int i = 0; i < Basis::dimension; ++i)
        vectors(ghost, i) =
            static_cast<typename Basis::real>(line.basis.walls.sign(line.axis, side, i)) * vectors(image, i);
    });
  }
};

/// Gives the ghost nodes of a line the tractions of their images.
template <class Basis, class Device>
struct MirrorMasks {
  MirrorLine<Basis> line;
  BoundaryNodes<Device> masks;

  KOKKOS_FUNCTION void operator()(int k) const {
    line.visit(k, [&](int, int ghost, int image) { masks(ghost) = masks(image); });
  }
};

/// Launches make(line) over the lines of each direction that ends at a wall.
template <class Exec, class Basis, class Make>
void for_each_mirror_line(const Exec& exec, const std::string& label, const Basis& basis, const Make& make) {
  if constexpr (Basis::ghost_layers > 0)
    for (int axis = 0; axis < Basis::dimension; ++axis) {
      if (!basis.mirrored(axis, 0) && !basis.mirrored(axis, 1)) continue;
      const MirrorLine<Basis> line{basis, axis};
      Kokkos::parallel_for(label, Kokkos::RangePolicy<Exec>(exec, 0, line.lines()), make(line));
    }
}

}  // namespace kernel

/// Adds the sums of ghost nodes to their images and clears them; columns from `scalars` on are vector
/// components.
template <class Exec, class Basis, class Fields>
void fold_ghost_nodes(const Exec& exec, const Basis& basis, const Fields& sums, int scalars) {
  kernel::for_each_mirror_line(exec, "vsb::fold_ghost_nodes", basis, [&](const auto& line) {
    return kernel::FoldLine<Basis, Fields>{line, sums, scalars};
  });
}

/// Overwrites vectors at ghost nodes.
template <class Exec, class Basis, class Fields>
void mirror_vectors(const Exec& exec, const Basis& basis, const Fields& vectors) {
  kernel::for_each_mirror_line(exec, "vsb::mirror_vectors", basis, [&](const auto& line) {
    return kernel::MirrorVectors<Basis, Fields>{line, vectors};
  });
}

/// Overwrites traction masks at ghost nodes.
template <class Exec, class Basis, class Device>
void mirror_masks(const Exec& exec, const Basis& basis, const BoundaryNodes<Device>& masks) {
  kernel::for_each_mirror_line(exec, "vsb::mirror_masks", basis, [&](const auto& line) {
    return kernel::MirrorMasks<Basis, Device>{line, masks};
  });
}

}  // namespace vsb
