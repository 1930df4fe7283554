// SPDX-License-Identifier: BSD-3-Clause
#include "setup/initial_stress.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "setup/local_origin.hpp"
#include "setup/material_of.hpp"
#include "setup/setup_error.hpp"

namespace vsb::app {

namespace {

/// Of the largest stress component: what a stress on the yield surface may be off by, in single precision
/// too.
constexpr double round_off = 1e-6;

/// The stress to which a material without plastic strain returns a trial stress; this one, where it may be.
Stress6 returned(const Material<double>& material, const Stress6& trial) {
  SymmetricTensor<3, double> stress;
  std::copy(trial.begin(), trial.end(), stress.data);
  std::visit(
      [&](const auto& law) {
        using Law = std::decay_t<decltype(law)>;
        if constexpr (Law::plastic) {
          auto state = Vector<Law::template state_size<3>(), double>::zero();
          law.template return_stress<3>(stress, state);
        }
      },
      material);
  Stress6 values;
  std::copy(stress.data, stress.data + stress.size, values.begin());
  return values;
}

/// The criterion of a law, in terms of its keys.
const char* criterion(MaterialLaw law) {
  switch (law) {
    case MaterialLaw::mohr_coulomb:
      return "(s1 - s3) + (s1 + s3) sin(friction_angle) <= 2 cohesion cos(friction_angle) and s1 <= "
             "tensile_strength, s1 and s3 being the largest and the smallest principal stress";
    case MaterialLaw::tresca:
      return "s1 - s3 <= 2 cohesion and s1 <= tensile_strength, s1 and s3 being the largest and the smallest "
             "principal stress";
    case MaterialLaw::drucker_prager:
      return "a point on or within the cone of cohesion and friction_angle";
    case MaterialLaw::von_mises:
      return "an equivalent stress sqrt(3 J2) <= yield_stress";
    default:
      return "";
  }
}

/// The stress of a body that is farthest beyond the yield surface.
struct Excess {
  double share = 0;  ///< of its largest component
  Stress6 stress{}, returned{};
  Point at{};
};

Excess largest_excess(const Scene& scene, size_t b, const PlacedParticles& placed) {
  const auto& body = scene.bodies[b];
  const auto material = material_of<double>(body.material);
  const bool uniform = body.stress.gradient == std::array<Stress6, 3>{};
  const auto stored = static_cast<std::ptrdiff_t>(symmetric_components(scene.dimension));
  Excess worst;
  const int first = placed.bodies[b].first, last = uniform ? first + 1 : placed.bodies[b].last;
  for (int p = first; p < last; ++p) {
    const auto& x = placed.position[static_cast<size_t>(p)];
    auto stress = body.stress.at(x);
    std::fill(stress.begin() + stored, stress.end(), 0.0);
    const auto allowed = returned(material, stress);
    double size = 0, beyond = 0;
    for (size_t c = 0; c < stress.size(); ++c) {
      size = std::max(size, std::abs(stress[c]));
      beyond = std::max(beyond, std::abs(stress[c] - allowed[c]));
    }
    if (beyond > std::max(worst.share, round_off) * size) worst = {beyond / size, stress, allowed, x};
  }
  return worst;
}

std::string text(const Stress6& stress) {
  Stress6 values = stress;
  double size = 0;
  for (const double s : values) size = std::max(size, std::abs(s));
  for (double& s : values)
    if (std::abs(s) < 1e-12 * size) s = 0;
  return fmt::format("({:.6g}) Pa", fmt::join(values, ", "));
}

}  // namespace

void refuse_stress_beyond_yield(const Scene& scene, const PlacedParticles& placed) {
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    const auto& body = scene.bodies[b];
    if (!is_plastic(body.material.law) || body.stress_where.empty()) continue;
    const auto worst = largest_excess(scene, b, placed);
    if (worst.share == 0) continue;
    throw SetupError(
        body.stress_where,
        fmt::format("body[{}].stress = {} at {}: is beyond the yield surface of the material, which would "
                    "return it to {} in the first step; allowed is {}",
                    b, text(worst.stress), position_text(scene, worst.at, 4), text(worst.returned),
                    criterion(body.material.law)));
  }
}

}  // namespace vsb::app
