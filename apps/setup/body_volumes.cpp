// SPDX-License-Identifier: BSD-3-Clause
#include "setup/body_volumes.hpp"

#include <fmt/format.h>

#include <cmath>

#include "setup/shape_volume.hpp"

namespace vsb::app {

namespace {

constexpr double noteworthy = 0.01;  ///< of the shape's volume

/// A volume and the mass that goes with it, with their units in the scene's dimension.
std::string amount(const Scene& scene, const BodySpec& body, double volume) {
  static const char* const volumes[] = {"m", "m^2", "m^3"};
  static const char* const masses[] = {"kg/m^2", "kg/m", "kg"};
  const auto unit = static_cast<size_t>(scene.dimension) - 1;
  return fmt::format("{:.6g} {} and {:.6g} {}", volume, volumes[unit], body.density * volume, masses[unit]);
}

std::string percent(double share) {
  return fmt::format("{:+.2f} %", std::abs(share) < 5e-5 ? 0.0 : 100 * share);
}

/// What would bring the particles' volume nearer to the shape's.
std::string cure(const Scene& scene, const BodySpec& body) {
  if (body.boundary != BoundaryBoxes::keep)
    return "what is missing lies in slivers too small for a particle; choose a finer lattice, or one whose "
           "intervals end at the surface";
  if (scene.method.moment_fit && is_irregular(body))
    return "cells of the grid without a particle of it are left out; put its particles closer together";
  if (std::holds_alternative<ConcentricLattice>(body.lattice))
    return "let radii, angles and layers of the lattice end where the shape does";
  return fmt::format("choose a lattice whose intervals end at the surface, or a finer one{}",
                     scene.grid.mapped() || body.jitter.amount > 0 ? "" : ", or boundary = \"cut\"");
}

}  // namespace

std::vector<BodyVolume> body_volumes(const Scene& scene, const PlacedParticles& placed) {
  const auto shapes = shape_volumes(scene);
  std::vector<BodyVolume> volumes;
  for (size_t b = 0; b < shapes.size(); ++b) {
    BodyVolume volume{0, shapes[b].value, shapes[b].error};
    for (int p = placed.bodies[b].first; p < placed.bodies[b].last; ++p)
      volume.particles += placed.volume[static_cast<size_t>(p)];
    volumes.push_back(volume);
  }
  return volumes;
}

void print_body_volumes(const Scene& scene, const std::vector<BodyVolume>& volumes,
                        const std::string& prefix) {
  for (size_t b = 0; b < volumes.size(); ++b) {
    const auto& body = scene.bodies[b];
    fmt::print("{}body '{}': particles {}, shape {} ({})\n", prefix, body.name,
               amount(scene, body, volumes[b].particles), amount(scene, body, volumes[b].shape),
               percent(volumes[b].surplus()));
  }
}

std::vector<std::string> volume_advice(const Scene& scene, const std::vector<BodyVolume>& volumes) {
  std::vector<std::string> advice;
  for (size_t b = 0; b < volumes.size(); ++b) {
    const auto& body = scene.bodies[b];
    if (std::abs(volumes[b].surplus()) <= noteworthy + volumes[b].shape_error / volumes[b].shape) continue;
    advice.push_back(fmt::format("the particles of body '{}' have {}, its shape {} ({}): {}", body.name,
                                 amount(scene, body, volumes[b].particles),
                                 amount(scene, body, volumes[b].shape), percent(volumes[b].surplus()),
                                 cure(scene, body)));
  }
  return advice;
}

}  // namespace vsb::app
