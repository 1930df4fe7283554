// SPDX-License-Identifier: BSD-3-Clause
#include "report/scene_advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/energy_advice.hpp"
#include "report/neighbour_advice.hpp"
#include "report/spline_rest.hpp"
#include "report/thin_bodies.hpp"
#include "scene/load_in_time.hpp"
#include "scene/read_body.hpp"
#include "scene/read_volumetric.hpp"
#include "scene/units.hpp"
#include "setup/region_size.hpp"

namespace vsb::app {

namespace {

/// Whether a face of the grid, of any direction, holds a component of the motion.
bool is_fixed(const Scene& scene, size_t component) {
  for (const auto& faces : scene.faces.fixed)
    for (const unsigned char fixed : faces)
      if (fixed >> component & 1) return true;
  return false;
}

/// Of the tractions where the bodies are, and of each body's weight where something holds it: what falls
/// freely is not strained by it.
double largest_load(const Scene& scene) {
  double load = 0;
  const auto grid = bounding_box(scene.grid, scene.dimension);
  for (const auto& body : scene.bodies) {
    const auto box = bounds_of(body.region, grid, scene.dimension);
    for (const auto& traction : scene.tractions)
      load = std::max(load, largest_stress(traction.field, box.lower, box.upper));
    for (size_t i = 0; i < 3; ++i)
      if (is_fixed(scene, i))
        load = std::max(load, body.density * std::abs(scene.gravity[i]) * (box.upper[i] - box.lower[i]));
  }
  return load;
}

double smallest_modulus(const Scene& scene) {
  double modulus = scene.bodies.front().material.youngs_modulus;
  for (const auto& body : scene.bodies) modulus = std::min(modulus, body.material.youngs_modulus);
  return modulus;
}

/// Of the softest body, about.
double strain_by(const Scene& scene, const TractionSpec& traction) {
  const auto box = bounding_box(scene.grid, scene.dimension);
  return largest_stress(traction.field, box.lower, box.upper) / smallest_modulus(scene);
}

/// Whether a body begins under stress.
bool begins_stressed(const BodySpec& body) {
  return !is_zero(body.stress);
}

/// By what the loads displace the softest body, about, in cells of a uniform grid; 0 where bodies begin under
/// stress, which the loads are then to balance.
double displacement_in_cells(const Scene& scene) {
  if (std::any_of(scene.bodies.begin(), scene.bodies.end(), begins_stressed)) return 0;
  double extent = 0;
  const auto grid = bounding_box(scene.grid, scene.dimension);
  for (const auto& body : scene.bodies) {
    const auto box = bounds_of(body.region, grid, scene.dimension);
    for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i)
      extent = std::max(extent, (box.upper[i] - box.lower[i]) / scene.grid.spacing[i]);
  }
  return largest_load(scene) / smallest_modulus(scene) * extent;
}

/// Displacements in cells below which single precision loses what a step adds to them: of a column under its
/// own weight 6e-5 cells came out 10 % (particle kernels 99 %) wrong, 6e-4 cells at most 2 %.
constexpr double least_float_displacement = 3e-4;

/// A strain by which a boundary moves through cells.
constexpr double large_strain = 0.05;

/// Whether the position of the boundary decides where a traction acts.
bool acts_on_nodes(const TractionSpec& t) {
  return t.imposition == Imposition::virtual_stress || t.imposition == Imposition::virtual_stress_original;
}

/// Whether a body moves as a whole, as far as a scene shows before it runs.
bool moves_as_a_whole(const Scene& scene) {
  for (const auto& body : scene.bodies)
    if (!is_zero(body.velocity)) return true;
  const auto floats = [](const TractionSpec& t) {
    return std::holds_alternative<HydrostaticSpec>(t.field) ||
           std::holds_alternative<Affine<Stress6>>(t.field);
  };
  if (std::any_of(scene.tractions.begin(), scene.tractions.end(), floats)) return false;
  for (size_t i = 0; i < 3; ++i)
    if (scene.gravity[i] != 0 && !is_fixed(scene, i)) return true;
  return false;
}

/// The fewest particles per cell and direction of a body, where its lattice follows the axes of the grid.
double fewest_per_cell(const Scene& scene, const BodySpec& body) {
  double fewest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i) {
    if (const auto* cells = std::get_if<CellLattice>(&body.lattice))
      fewest = std::min<double>(fewest, cells->particles_per_cell[i]);
    const auto* uniform = std::get_if<UniformLattice>(&body.lattice);
    if (uniform && !scene.grid.mapped())
      fewest = std::min(fewest, scene.grid.spacing[i] / uniform->spacing[i]);
  }
  return fewest;
}

/// Of a cell: displacements from which on the stress of linear functions shows that particles cross cells.
constexpr double crossing_displacement = 0.5;

/// Up to here (degrees) an angle of friction is rather one in radians: soils and rocks have 10 to 50 degrees.
constexpr double suspicious_angle = 1.5708;

std::string crossing_text(const std::string& moved) {
  return moved +
         ": particles under stress cross cells, at whose faces the gradients of linear functions jump (bars "
         "at 2 to 10 % strain had stresses 30 to 90 % off); method.basis = \"quadratic_bspline\" (setting = "
         "\"accurate\") does not jump";
}

/// Damping that lets a sudden load overshoot by little: with 0.8 a column under its weight did not yield that
/// yielded by 0.8 % with 0.1.
constexpr double strong_damping = 0.5;

/// The period of a body's slowest vibration along gravity, s, about: that of a column on its base.
double fall_period(const Scene& scene, const BodySpec& body) {
  const auto box = bounds_of(body.region, bounding_box(scene.grid, scene.dimension), scene.dimension);
  double height = 0;
  const double g = std::hypot(scene.gravity[0], scene.gravity[1], scene.gravity[2]);
  for (size_t i = 0; i < 3; ++i) height += std::abs(scene.gravity[i]) / g * (box.upper[i] - box.lower[i]);
  return 4 * height / std::sqrt(body.material.youngs_modulus / body.density);
}

/// Of a load, by which it may change within a period: a ramp over n periods overshoots by 1 / (pi n) at most,
/// so that this one does by 6 %.
constexpr double gentle_change = 0.2;

/// Whether a plastic body takes its weight, which acts all of a sudden, without a stress that carries it: it
/// may yield where it would not at rest.
bool takes_sudden_weight(const Scene& scene, const BodySpec& body) {
  if (!has_gravity(scene) || !is_plastic(body.material.law) || begins_stressed(body) ||
      scene.method.damping >= strong_damping)
    return false;
  const auto& time = scene.gravity_time;
  return std::max(std::abs(time(0)), time.steepest() * fall_period(scene, body)) > gentle_change;
}

std::string sudden_weight_text(const Scene& scene, const BodySpec& body) {
  const double period = fall_period(scene, body);
  const auto how = scene.gravity_time(0) == 1
                       ? std::string("acts in full from the first step on")
                       : fmt::format("changes faster than in five periods of {:.2g} s", period);
  return fmt::format(
      "gravity {}, which loads body '{}' with up to twice its weight and may make it yield where it would "
      "not at rest; let it grow slowly (gravity_time.smooth_ramp = {:.2g} s), or begin with the stress of "
      "its weight (body.stress), or with method.damping = 0.8",
      how, body.name, 10.5 * period);
}

/// What the cells of a body do that strains by the divergences of its particles; empty where they do not
/// lock.
std::string locking_text(const Scene& scene, const BodySpec& body) {
  const char* const cure = scene.method.basis == BasisKind::ugimp
                               ? "another basis can average (method.volumetric)"
                               : "\"averaged\" cures it";
  if (may_lock(body))
    return fmt::format(
        "body '{}' has poisson_ratio = {:g} and method.volumetric = \"full\": near 0.5 cells lock, and "
        "stresses are wrong by 5 % at 0.4, 40 % at 0.49 (linear functions; a tenth of it with B-splines); {}",
        body.name, body.material.poisson_ratio, cure);
  if (is_plastic(body.material.law) && scene.method.basis != BasisKind::quadratic_bspline)
    return fmt::format(
        "body '{}' may yield, and method.volumetric = \"full\": plastic flow keeps the volume, cells lock, "
        "and the body bears more than it can (a vertical cut stood at 1.3 times its critical height); {}",
        body.name, cure);
  return {};
}

/// Whether a traction is hydrostatic, and its `up` not the direction against gravity.
bool has_level_across_gravity(const Scene& scene, const TractionSpec& traction) {
  const auto* water = std::get_if<HydrostaticSpec>(&traction.field);
  if (!water || !has_gravity(scene)) return false;
  double along = 0, size = 0;
  for (size_t i = 0; i < 3; ++i) {
    along -= water->up[i] * scene.gravity[i];
    size += scene.gravity[i] * scene.gravity[i];
  }
  return along < 0.999 * std::sqrt(size);
}

/// The force ratio below which runs with B-splines hardly get.
constexpr double least_spline_ratio = 3e-6;

/// By which a load may miss its final value in the last step.
constexpr double round_off = 1e-9;

/// Of kappa with the re-map of the velocity (MUSL), however little of a cell is filled.
double largest_stable_kappa(const Scene& scene) {
  return scene.method.basis == BasisKind::quadratic_bspline ? 1.5 : 1.3;
}

}  // namespace

std::string units_hint(const Scene& scene) {
  const double modulus = smallest_modulus(scene);
  const double load = largest_load(scene), ratio = load / modulus;
  if (!(ratio > 0.1)) return "";
  return fmt::format(
      "largest load / smallest Young's modulus = {:.3g} Pa / {:.3g} Pa = {:.2g}: check the units", load,
      modulus, ratio);
}

std::vector<std::string> scene_advice(const Scene& scene) {
  std::vector<std::string> advice;
  if (const auto hint = units_hint(scene); !hint.empty()) advice.push_back(hint);
  if (scene.single_precision)
    if (const double moved = displacement_in_cells(scene); moved > 0 && moved < least_float_displacement)
      advice.push_back(fmt::format(
          "the loads displace the bodies by some {:.1g} of a cell, of which precision = \"float\" "
          "loses a good part: stresses are right, displacements are not; take \"double\"",
          moved));
  if (scene.method.basis == BasisKind::linear && !scene.grid.mapped() && !scene.removal)
    if (const double moved = displacement_in_cells(scene); moved > crossing_displacement)
      advice.push_back(
          crossing_text(fmt::format("the loads displace the bodies by some {:.2g} cells", moved)));
  for (const auto& body : scene.bodies)
    if (const double angle = degrees(body.material.friction_angle); angle > 0 && angle < suspicious_angle)
      advice.push_back(fmt::format(
          "body '{}' has friction_angle = {:g} degrees, hardly any: were radians meant, give {:.4g}",
          body.name, angle, degrees(angle)));
  for (auto& text : gap_advice(scene)) advice.push_back(std::move(text));
  for (auto& text : interface_advice(scene)) advice.push_back(std::move(text));
  for (const auto& body : scene.bodies)
    if (scene.time.until_static && takes_sudden_weight(scene, body))
      advice.push_back(sudden_weight_text(scene, body));
  for (const auto& traction : scene.tractions)
    if (has_level_across_gravity(scene, traction))
      advice.push_back(fmt::format("traction '{}': 'up' of its hydrostatic pressure is not against gravity",
                                   traction.name));
  for (const auto& traction : scene.tractions)
    if (const double strain = strain_by(scene, traction);
        traction.has_surface && !traction.carried && acts_on_nodes(traction) && strain > large_strain)
      advice.push_back(fmt::format(
          "traction '{}' may strain a body by {:.2g}, and its 'surface' is fixed in space: the loaded "
          "boundary may move out of it; with configuration = \"initial\" it moves with the material",
          traction.name, strain));
  if (scene.time.until_static && scene.method.damping == 0)
    advice.emplace_back(
        "method.damping = 0: nothing takes the oscillation away, so the run may never become static; 0.05 to "
        "0.3 is usual");
  if (scene.method.damping > 0 && moves_as_a_whole(scene))
    advice.push_back(
        fmt::format("method.damping = {:g} on a body that moves as a whole (an initial velocity, or gravity "
                    "that no face holds) brakes that motion too: set it to 0",
                    scene.method.damping));
  for (const auto& body : scene.bodies)
    if (const double n = fewest_per_cell(scene, body); n < 2 - 1e-9)
      advice.push_back(
          fmt::format("body '{}' has {:.3g} < 2 particles per cell in a direction: cells open up where it "
                      "stretches, and motions "
                      "that such particles do not resist remain; give particles_per_cell = 2 or more",
                      body.name, n));
  for (auto& text : spline_rest_advice(scene)) advice.push_back(std::move(text));
  for (auto& text : thin_body_advice(scene)) advice.push_back(std::move(text));
  if (!scene.method.averaged && scene.dimension > 1)
    for (const auto& body : scene.bodies)
      if (const auto text = locking_text(scene, body); !text.empty()) advice.push_back(text);
  if (scene.method.basis == BasisKind::quadratic_bspline && scene.time.until_static &&
      scene.time.until_static->force_ratio < least_spline_ratio)
    advice.push_back(fmt::format(
        "time.until_static.force_ratio = {:g}: with B-splines, nodes that hold on to a corner of one "
        "particle "
        "hardly come to rest, so the run may never become static; {:g}, stronger damping (0.4), or --static",
        scene.time.until_static->force_ratio, static_spline_ratio));
  if (const auto text = energy_advice(scene); !text.empty()) advice.push_back(text);
  if (scene.time.kappa > largest_stable_kappa(scene))
    advice.push_back(
        fmt::format("time.kappa = {:.4g} is above the stability limit of about {:g}; give a smaller one",
                    scene.time.kappa, largest_stable_kappa(scene)));
  return advice;
}

std::vector<std::string> crossing_advice(const Scene& scene, double largest_displacement) {
  if (scene.method.basis == BasisKind::quadratic_bspline || scene.grid.mapped() || !scene.time.until_static)
    return {};
  const double h =
      *std::min_element(scene.grid.spacing.begin(), scene.grid.spacing.begin() + scene.dimension);
  const bool plastic = std::any_of(scene.bodies.begin(), scene.bodies.end(),
                                   [](const BodySpec& b) { return is_plastic(b.material.law); });
  // Collapsing bodies come to a false rest earlier: vertical cuts beyond their limit stood at 0.38 cells.
  if (!(largest_displacement > (plastic ? 0.5 : 1) * crossing_displacement * h)) return {};
  auto text = crossing_text(fmt::format("particles came to rest up to {:.2g} cells from where they began",
                                        largest_displacement / h));
  if (plastic) text += "; a body that fails may come to a false rest at such faces";
  return {text};
}

std::vector<std::string> short_run_advice(const Scene& scene) {
  std::vector<std::string> advice;
  const double end = scene.time.dt * static_cast<double>(scene.time.steps);
  for (const auto& load : loads_in_time(scene)) {
    const double settled = load.time.settled_at();
    if (!std::isfinite(settled)) continue;
    const double last = load.time(end), final = load.time(settled);
    if (std::abs(last - final) < round_off * std::abs(final)) continue;
    const std::string share =
        final == 0 ? fmt::format("{:.3g} times its full value, where its final value is 0", last)
                   : fmt::format("{:.3g} % of its final value", 100 * last / final);
    advice.push_back(fmt::format(
        "{} is at {} at the last possible step: {} = {} ends {} at {:.6g} s, and {} is constant from {:.6g} "
        "s on",
        load.name, share, scene.time.until_static ? "time.until_static.max_steps" : "time.steps",
        scene.time.steps, scene.removal ? "a stage" : "the run", end, load.key, settled));
  }
  return advice;
}

}  // namespace vsb::app
