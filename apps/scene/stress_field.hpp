// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The stress field of a traction at full load, as a scene gives it. Plain data; what the fields are is told
/// in physics/stress_fields.hpp. Stresses in Pa, tension positive.
#pragma once

#include <array>
#include <variant>

#include "scene/region.hpp"

namespace vsb::app {

/// Stress components in the order xx yy zz xy yz xz, Pa, tension positive.
using Stress6 = std::array<double, 6>;

/// value + sum_k gradient[k] x_k.
template <class Value>
struct Affine {
  Value value{};
  std::array<Value, 3> gradient{};

  Value at(const Point& x) const {
    Value v = value;
    for (size_t k = 0; k < 3; ++k)
      for (size_t c = 0; c < v.size(); ++c) v[c] += gradient[k][c] * x[k];
    return v;
  }
};

struct HydrostaticSpec {
  double unit_weight;  ///< N/m^3
  double level;        ///< of the free surface along `up`, m
  Point up;            ///< unit vector
  double width;        ///< over which the kink at the free surface is averaged, m
};

struct RadialBlendSpec {
  Point center;
  int axis;  ///< 0, 1, 2; -1 for none
  double inner_radius, outer_radius;
  Stress6 inner, outer;
};

struct PlanarBlendSpec {
  Point start, end;  ///< a point of the first plane, and that of the second one opposite to it
  Stress6 at_start, at_end;
};

/// The plate with an elliptic hole of physics/exact_ellipse.hpp; poisson_ratio is that of the first body.
struct EllipseSpec {
  double semi_major, semi_minor, pressure, far_stress, far_ratio;
};

using StressFieldSpec =
    std::variant<Stress6, Affine<Stress6>, HydrostaticSpec, RadialBlendSpec, PlanarBlendSpec, EllipseSpec>;

/// A function for each alternative of a variant: std::visit does not compile where one is forgotten.
template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

/// The largest stress component that the field has in a box, about; Pa.
double largest_stress(const StressFieldSpec& field, const Point& lower, const Point& upper);

}  // namespace vsb::app
