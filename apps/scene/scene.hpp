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
#include "scene/lattice.hpp"
#include "scene/material_spec.hpp"
#include "scene/region.hpp"
#include "scene/removal_spec.hpp"
#include "scene/stress_field.hpp"
#include "scene/time_function.hpp"

namespace vsb::app {

/// Prescribed (zero) velocity components at a face of the grid, bit i for component i; open faces have none.
struct FaceSpec {
  std::array<std::array<unsigned char, 2>, 3> fixed{};  ///< [logical axis][0: lower face, 1: upper]
  std::array<std::array<bool, 2>, 3> outflow{};         ///< whether an open face lets particles go

  bool any_outflow() const {
    for (const auto& sides : outflow)
      if (sides[0] || sides[1]) return true;
    return false;
  }
};

struct BodySpec {
  std::string name;
  Region region;
  Lattice lattice;
  Jitter jitter;
  BoundaryBoxes boundary = BoundaryBoxes::keep;
  double density = 0;  ///< kg/m^3
  MaterialSpec material{};
  Affine<Stress6> stress;
  Affine<Point> velocity;           ///< m/s
  std::string where, stress_where;  ///< file:line:column of the table, and of its key `stress`
};

/// Whether particles lie on rings or are jittered, so that sums over those of a cell are not exact.
inline bool is_irregular(const BodySpec& body) {
  return std::holds_alternative<ConcentricLattice>(body.lattice) || body.jitter.amount > 0;
}

/// How a traction becomes nodal forces.
enum class Imposition {
  virtual_stress,           ///< modified virtual stress boundary, Eq. (27), Eq. (28)
  virtual_stress_original,  ///< original virtual stress boundary, Eq. (21), Eq. (22)
  boundary_particles,       ///< massless particles on the surface, Eq. (13)
  material_points,          ///< the outermost layer of particles, Eq. (12)
  nodal                     ///< the nodes of a boundary that the grid follows
};

struct TractionSpec {
  std::string name;
  Imposition imposition = Imposition::virtual_stress;
  StressFieldSpec field;       ///< sbar at full load
  bool all_nodes = false;      ///< acts at all active nodes, not at the boundary nodes alone
  bool self_balanced = false;  ///< its resultant is zero, see kernels/boundary/self_balance.hpp
  Region surface;
  bool has_surface = false;  ///< whether the scene says which; everywhere otherwise
  bool carried = false;      ///< on nodes: the surface is that of the undeformed body and moves with it
  Region layer;              ///< which material points may carry the load
  int points_per_cell = 0;   ///< sampling of the surface, in each direction
  TimeFunction time;
  std::string where;  ///< file:line:column
};

/// When a run counts as static.
struct StaticCriterion {
  double force_ratio, energy_ratio;
  long long check_every;  ///< steps
};

/// The force ratio that counts as static with B-splines where a scene does not say: nodes that hold on to a
/// corner of one particle move too slowly for the damping to reach.
constexpr double static_spline_ratio = 2e-5;

struct TimeSpec {
  double dt = 0;        ///< s
  double kappa = 0;     ///< share of the critical time step, Eq. (29); from dt where dt was given
  long long steps = 0;  ///< number of steps, or the limit for a run until static
  std::optional<StaticCriterion> until_static;
};

/// The functions through which particles and nodes exchange data.
enum class BasisKind { linear, ugimp, quadratic_bspline };

struct MethodSpec {
  BasisKind basis = BasisKind::linear;
  std::array<double, 3> gimp_half_width{};  ///< of a particle, per direction, in cells; of uGIMP
  double damping = 0;
  double pic = 0;  ///< share of PIC in the velocities of particles
  std::string volume_update, scatter;
  std::string engine;          ///< auto, cell_lanes or particles, see engine/lane_engine.hpp
  int cell_gauss_points = 1;   ///< of the original virtual stress boundary method, per direction
  double fill_criterion = 0;   ///< tau, see kernels/boundary/mark_underfilled_cells.hpp; 0: off
  bool void_filter = false;    ///< see kernels/boundary/filter_voids.hpp
  bool moment_fit = false;     ///< see setup/moment_fit.hpp
  bool moves_by_grid = false;  ///< positions follow v_I, not v*_I: PositionVelocity
  bool averaged = false;       ///< particles strain by a mean divergence, see physics/mean_divergence.hpp
  bool allow_particles_on_grid_lines = false;
};

/// When the conjugate gradients of a static solution end.
struct StaticSpec {
  double residual = 0;  ///< relative
  int max_iterations = 0;
};

struct OutputSpec {
  long long every = 0;  ///< steps between frames; 0: the first and the last state only
  std::vector<std::string> fields;
  bool grid = false;              ///< frames of the nodal fields too
  double checkpoint_minutes = 0;  ///< wall time between checkpoints
};

struct ColumnComparison {
  double length, traction;
  bool printed_solution;  ///< whether e_u, against (A1), which is for small strain, is among the norms
};
struct CylinderComparison {
  double inner_radius, outer_radius, pressure;
  Point center{};  ///< m, of the undeformed cylinder
  Point moved{};   ///< m, by which it has been carried when it is compared
};
/// Of a body with law = "mohr_coulomb" or "tresca", about the origin.
struct YieldingCylinderComparison {
  double inner_radius, outer_radius, pressure;
};
/// Of a body with law = "hencky": a cylinder, or in 3D a sphere.
struct HenckyWallComparison {
  double inner_radius, outer_radius, pressure;
  int dimension;   ///< 2: a cylinder along z, 3: a sphere
  Point center{};  ///< m
};
using EllipseComparison = EllipseSpec;
using Comparison = std::variant<std::monostate, ColumnComparison, CylinderComparison,
                                YieldingCylinderComparison, EllipseComparison, HenckyWallComparison>;

/// Error norms of the stress beside those of the particles' own.
struct MoreNorms {
  bool recovered = false;   ///< of the recovered stress (report/recovered_stress.hpp): e_rr_recovered
  bool cell_means = false;  ///< of the means over cells (report/cell_means.hpp): e_rr_cell_mean
};

/// Figures to print beside ours: error name -> what the source says.
struct Published {
  std::string source;
  std::map<std::string, double> errors;
};

/// Tractions a scene may declare; the capacity of the field the kernels get.
constexpr size_t max_tractions = 8;

/// What a scene takes where it does not say.
enum class Setting {
  paper,    ///< the linear basis, particles whole
  accurate  ///< quadratic B-splines, boundary boxes split and cut, 2 particles per cell and direction
};

/// Of a small disturbance of the state at the end; see run/growth.hpp.
struct GrowthSpec {
  double time = 0;     ///< for which it is followed, s
  double damping = 0;  ///< Cundall's alpha meanwhile
};

struct Scene {
  std::string name, title;
  Setting setting = Setting::paper;
  int dimension = 0;
  bool single_precision = false;
  GridSpec grid;
  FaceSpec faces;
  std::vector<BodySpec> bodies;
  std::vector<TractionSpec> tractions;
  Point gravity{};  ///< m/s^2, in full
  TimeFunction gravity_time;
  MethodSpec method;
  TimeSpec time;
  StaticSpec static_solution;
  std::optional<RemovalSpec> removal;
  std::optional<GrowthSpec> growth;
  OutputSpec output;
  Comparison compare;
  MoreNorms more_norms;
  std::vector<Published> published;

  std::string resolved;  ///< the scene with all defaults, as TOML
};

/// Whether there is gravity, at some time.
inline bool has_gravity(const Scene& scene) {
  return scene.gravity != Point{};
}

/// Whether particles may be removed on the way.
inline bool may_lose_particles(const Scene& scene) {
  return scene.removal.has_value() || scene.faces.any_outflow();
}

/// The names of the error norms that a scene's comparison yields.
std::vector<std::string> error_names(const Scene& scene);

/// Reads and checks a scene. `overrides` are key=value pairs of the command line (key.sub=value,
/// array[0].key=value). Throws SceneError, whose text names file, line, column, key, value and what is
/// allowed.
Scene read_scene(const std::string& path, const std::vector<std::string>& overrides);

}  // namespace vsb::app
