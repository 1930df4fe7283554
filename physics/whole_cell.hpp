// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The force of a whole cell under a virtual stress at one of its nodes, Eq. (21), Eq. (22), by Gauss points:
///   sum_c V_c (sbar_c . grad N_c + N_c fbar_c).
#pragma once

#include <vsb/physics/gauss_points.hpp>
#include <vsb/physics/virtual_stress.hpp>

namespace vsb {

/// Adds the force of `cell` at its corner a under the given tractions to f, N. Corners are numbered as in
/// multilinear.hpp.
template <class Basis, class Field, int Dim, class Real>
KOKKOS_INLINE_FUNCTION void add_whole_cell(const Basis& basis, const Vector<Dim, int>& cell, int a,
                                           const Field& field, TractionMask tractions,
                                           const GaussPoints<Real>& gauss, Vector<Dim, Real>& f) {
  int points = 1;
  for (int i = 0; i < Dim; ++i) points *= gauss.count;
  for (int c = 0; c < points; ++c) {
    Vector<Dim, Real> xi;
    Real weight = 1;
    for (int i = 0, k = c; i < Dim; ++i, k /= gauss.count) {
      xi[i] = gauss.point[k % gauss.count];
      weight *= gauss.weight[k % gauss.count];
    }
    const auto point = basis.grid.map(cell, xi);
    const auto shape = basis.shape(point.x);
    const auto bar = field.at(point.x, tractions);
    const Real V = weight * point.volume_ratio;
    f += V * (bar.stress * shape.dN[a] + shape.N[a] * bar.divergence);
  }
}

}  // namespace vsb
