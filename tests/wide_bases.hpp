// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The bases with a layer of ghost cells, on a grid that is given without it.
#pragma once

#include <tuple>
#include <vsb/physics/quadratic_bspline_basis.hpp>
#include <vsb/physics/uniform_gimp_basis.hpp>

#include "support.hpp"

namespace vsb::test {

using WideBases = std::tuple<QuadraticBSplineBasis<1, double>, QuadraticBSplineBasis<2, double>,
                             QuadraticBSplineBasis<3, double>, UniformGimpBasis<1, double>,
                             UniformGimpBasis<2, double>, UniformGimpBasis<3, double>>;

template <class Basis>
struct WideBasis;

template <int Dim, class Real>
struct WideBasis<QuadraticBSplineBasis<Dim, Real>> {
  static QuadraticBSplineBasis<Dim, Real> on(const UniformGrid<Dim, Real>& grid) {
    QuadraticBSplineBasis<Dim, Real> basis;
    basis.grid = with_ghost_layer(grid);
    return basis;
  }
};

template <int Dim, class Real>
struct WideBasis<UniformGimpBasis<Dim, Real>> {
  /// Another size of particles in each direction: 1/8, 1/4 and 3/8 of a cell.
  static UniformGimpBasis<Dim, Real> on(const UniformGrid<Dim, Real>& grid) {
    UniformGimpBasis<Dim, Real> basis;
    basis.grid = with_ghost_layer(grid);
    for (int i = 0; i < Dim; ++i) basis.half_width[i] = static_cast<Real>(0.125 * (i + 1));
    return basis;
  }
};

}  // namespace vsb::test
