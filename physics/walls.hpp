// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Faces of the grid beyond which nodes are mirror images of the nodes inside. A basis function that extends
/// over a wall is the sum of itself and its mirror image: the body moves as half of a body with its
/// reflection. Velocity components prescribed at the wall are odd, v(ghost) = -v(image), the others even,
/// v(ghost) = +v(image).
#pragma once

#include <vsb/views/masks.hpp>
#include <vsb/views/tensor.hpp>

namespace vsb {

/// Which velocity components the faces of a grid prescribe.
template <int Dim>
struct Walls {
  /// [direction][0: lower face, 1: upper]: bit i: velocity component i is prescribed at this face. A face
  /// without prescribed components is open, and the nodes beyond it are like all others.
  ComponentMask fixed[Dim][2] = {};

  /// Whether a face is a wall: side 0 is the lower face along `axis`, side 1 the upper.
  KOKKOS_FUNCTION bool mirrored(int axis, int side) const { return fixed[axis][side] != 0; }
  /// Of component i of a vector at a ghost node, compared with the node's image.
  KOKKOS_FUNCTION int sign(int axis, int side, int i) const { return fixed[axis][side] >> i & 1 ? -1 : 1; }
};

}  // namespace vsb
