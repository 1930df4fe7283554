// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A scene as read from a TOML file: everything a run needs, checked, in SI units. Plain data.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scene/grid_spec.hpp"
#include "scene/region.hpp"
#include "scene/time_function.hpp"

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

/// Prescribed (zero) velocity components at a face of the grid, bit i for component i; open faces have none.
struct FaceSpec {
  std::array<std::array<unsigned char, 2>, 3> fixed{};  ///< [logical axis][0: lower face, 1: upper]
};

struct LinearElasticSpec {
  double youngs_modulus, poisson_ratio;
};

struct BodySpec {
  std::string name;
  Region region;
  std::array<int, 3> particles_per_cell{1, 1, 1};  ///< in each direction
  double density = 0;                              ///< kg/m^3
  LinearElasticSpec material{};
  Affine<Stress6> stress;
  Affine<Point> velocity;  ///< m/s
};

struct TractionSpec {
  std::string name;
  Stress6 virtual_stress{};  ///< sbar at full load
  Region surface;
  TimeFunction time;
};

/// When a run counts as static.
struct StaticCriterion {
  double force_ratio, energy_ratio;
  long long check_every;  ///< steps
};

struct TimeSpec {
  double dt = 0;        ///< s
  double kappa = 0;     ///< share of the critical time step, Eq. (29); from dt where dt was given
  long long steps = 0;  ///< number of steps, or the limit for a run until static
  std::optional<StaticCriterion> until_static;
};

struct MethodSpec {
  double damping = 0;
  std::string volume_update, scatter;
};

struct OutputSpec {
  long long every = 0;  ///< steps between frames; 0: the first and the last state only
  std::vector<std::string> fields;
  bool grid = false;              ///< frames of the nodal fields too
  double checkpoint_minutes = 0;  ///< wall time between checkpoints
};

struct ColumnComparison {
  double length, traction;
};
struct CylinderComparison {
  double inner_radius, outer_radius, pressure;
};
struct EllipseComparison {
  double semi_major, semi_minor, pressure, far_stress, far_ratio;
};
using Comparison = std::variant<std::monostate, ColumnComparison, CylinderComparison, EllipseComparison>;

/// Figures to print beside ours: error name -> what the source says.
struct Published {
  std::string source;
  std::map<std::string, double> errors;
};

/// Tractions a scene may declare; the capacity of the field the kernels get.
constexpr size_t max_tractions = 8;

struct Scene {
  std::string name, title;
  int dimension = 0;
  bool single_precision = false;
  GridSpec grid;
  FaceSpec faces;
  std::vector<BodySpec> bodies;
  std::vector<TractionSpec> tractions;
  Point gravity{};  ///< m/s^2
  MethodSpec method;
  TimeSpec time;
  OutputSpec output;
  Comparison compare;
  std::vector<Published> published;

  std::string resolved;  ///< the scene with all defaults, as TOML
};

/// Reads and checks a scene. `overrides` are key=value pairs of the command line (key.sub=value,
/// array[0].key=value). Throws SceneError, whose text names file, line, column, key, value and what is
/// allowed.
Scene read_scene(const std::string& path, const std::vector<std::string>& overrides);

}  // namespace vsb::app
