// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Virtual stress fields of several kinds for the body of both_engines.hpp.
#pragma once

#include <vsb/physics/traction_fields.hpp>

#include "support.hpp"

namespace vsb::test {

/// The centre of the body of BothEngines' cavity, and anything else of the fields that depends on its grid.
template <int Dim, class Real>
Vector<Dim, Real> position_in(const UniformGrid<Dim, Real>& grid, Real cells) {
  Vector<Dim, Real> x;
  for (int i = 0; i < Dim; ++i) x[i] = grid.lower[i] + cells * grid.spacing[i];
  return x;
}

template <int Dim, class Real>
TractionFields<Dim, Real> four_fields(const UniformGrid<Dim, Real>& grid, Real amplitude) {
  TractionFields<Dim, Real> f;
  AffineStress<Dim, Real> affine;
  affine.value = pressure_stress<Dim>(Real(1));
  for (int k = 0; k < Dim; ++k) {
    affine.gradient[k] = SymmetricTensor<Dim, Real>::zero();
    for (int c = 0; c < affine.value.size; ++c)
      affine.gradient[k][c] = static_cast<Real>(0.1 * (k + 1) - 0.06 * c);
  }
  Vector<Dim, Real> all, up;
  for (int i = 0; i < Dim; ++i) {
    all[i] = Real(1);
    up[i] = static_cast<Real>(i == 0);
  }
  const auto centre = position_in<Dim, Real>(grid, Real(6.7));
  f.field[0] = affine;
  f.field[1] = RadialBlend<Dim, Real>{centre,
                                      all,
                                      grid.spacing[0],
                                      3 * grid.spacing[0],
                                      pressure_stress<Dim>(Real(2)),
                                      pressure_stress<Dim>(Real(-1))};
  f.field[2] = HydrostaticStress<Dim, Real>{Real(0.5), centre[0], grid.spacing[0], up};
  f.field[3] = UniformStress<Dim, Real>{pressure_stress<Dim>(Real(0.5))};
  f.count = 4;
  for (int k = 0; k < 4; ++k) f.factor[k] = amplitude * static_cast<Real>(1 - 0.2 * k);
  return f;
}

}  // namespace vsb::test
