// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Scatter of a single particle of node-centred cell lanes to its nodes: the quadratic B-splines N_I(x_p) at
/// its position, and the sums of the layer to which they are added.
#pragma once

#include <vsb/physics/quadratic_bspline_basis.hpp>
#include <vsb/views/cell_lanes.hpp>

namespace vsb {

namespace kernel {

/// The basis functions at xi of the cell in a lane; node a as in multiply_triples.
template <int Dim, class Real>
KOKKOS_FUNCTION Shape<Dim, NearestNodeBasis<Dim, Real>::support, Real> stencil_shape(
    const LaneStencil<Dim>& stencil, int lane, const Vector<Dim, Real>& xi,
    const Vector<Dim, Real>& inverse_spacing) {
  NodeTriple<Real> along[Dim];
  for (int i = 0; i < Dim; ++i) {
    along[i] = quadratic_bspline(xi[i] - Real(0.5));
    for (int k = 0; k < 3; ++k) along[i].dN[k] *= inverse_spacing[i];
  }
  Shape<Dim, NearestNodeBasis<Dim, Real>::support, Real> shape;
  for (int a = 0; a < shape.support; ++a) shape.node[a] = stencil.node[a / 3] + lane + a % 3;
  multiply_triples(along, shape);
  return shape;
}

/// Adds to the sums of a layer's three node planes.
template <int Dim, class Real, class Device>
struct StencilSink {
  LaneNodes<Dim, Real, Device> nodes;
  KOKKOS_FUNCTION Real& operator()(int a, int node, int column) const {
    const int plane = Dim == 1 ? 0 : Dim == 2 ? a / 3 : a / 9;
    return *nodes.at(nodes.sums_of_plane(plane) + column, node);
  }
};

}  // namespace kernel

}  // namespace vsb
