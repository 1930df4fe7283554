// SPDX-License-Identifier: BSD-3-Clause
#include "scene/read_material.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "scene/limits.hpp"
#include "scene/units.hpp"

namespace vsb::app {

namespace {

/// Refuses keys that belong to other laws.
MaterialLaw read_law(TableReader& r) {
  const auto& keys = material_keys;
  const auto law = r.read(keys.law);
  const auto own = keys.of(law);
  for (const auto* key : keys.keys()) {
    if (!r.has(*key) || key == &keys.law || key == &keys.youngs_modulus || key == &keys.poisson_ratio ||
        std::find(own.begin(), own.end(), key) != own.end())
      continue;
    r.fail(*key, fmt::format("is not for law = \"{}\", which takes {}", keys.law.word(law),
                             own.empty() ? "youngs_modulus and poisson_ratio alone"
                                         : fmt::format("{}", fmt::join(names_of(own), ", "))));
  }
  return law;
}

/// The cohesion and, where the law has them, the angles.
void read_strength(TableReader& r, bool friction, MaterialSpec& m) {
  const auto& keys = material_keys;
  m.cohesion = r.read(friction ? keys.cohesion : keys.cohesion.within(Range::positive()));
  if (!friction) return;
  const double angle = r.read(keys.friction_angle);
  m.friction_angle = radians(angle);
  m.dilation_angle = radians(r.read(keys.dilation_angle.within(Range::between(0, angle))));
  if (m.cohesion == 0 && angle == 0) r.fail(keys.cohesion, "must not be 0 where friction_angle is, too");
}

void read_tensile_strength(TableReader& r, MaterialSpec& m) {
  const auto& keys = material_keys;
  if (m.friction_angle > 0) {
    const double most = apex(m);
    if (!std::isfinite(most))
      r.fail(keys.friction_angle,
             "is too small for the cohesion: their cone has no apex below the largest number; give 0");
    m.tensile_strength = r.read(keys.tensile_strength.within(Range::between(0, most)), most);
  } else if (r.has(keys.tensile_strength)) {  // there is no apex, and no number that says so
    m.tensile_strength = r.read(keys.tensile_strength.within(Range::at_least(0)));
  }
}

}  // namespace

MaterialKeys::MaterialKeys() : KeyTable("body.material", "How stress follows from deformation.") {
  for (size_t i = 0; i < law.words.size(); ++i)
    if (const auto own = of(law.values[i]); !own.empty())
      tell(fmt::format("`\"{}\"` takes `{}`.", law.words[i], fmt::join(names_of(own), "`, `")));
}

KeyList MaterialKeys::of(MaterialLaw kind) const {
  switch (kind) {
    case MaterialLaw::linear_elastic:
    case MaterialLaw::hencky:
      return {};
    case MaterialLaw::mohr_coulomb:
      return {&cohesion, &friction_angle, &dilation_angle, &tensile_strength};
    case MaterialLaw::tresca:
      return {&cohesion, &tensile_strength};
    case MaterialLaw::drucker_prager:
      return {&cohesion, &friction_angle, &dilation_angle, &hardening_modulus, &cone};
    case MaterialLaw::von_mises:
      return {&yield_stress, &hardening_modulus};
  }
  return {};
}

MaterialSpec read_material(TableReader r) {
  const auto& keys = material_keys;
  MaterialSpec m{};
  m.law = read_law(r);
  m.youngs_modulus = r.read(keys.youngs_modulus);
  m.poisson_ratio = r.read(keys.poisson_ratio);
  const auto read_hardening = [&](const char* what) {
    m.hardening_modulus = r.read(remarked(keys.hardening_modulus, what));
  };
  if (m.law == MaterialLaw::mohr_coulomb || m.law == MaterialLaw::tresca) {
    read_strength(r, m.law == MaterialLaw::mohr_coulomb, m);
    read_tensile_strength(r, m);
  } else if (m.law == MaterialLaw::drucker_prager) {
    read_strength(r, true, m);
    read_hardening("of the cohesion with its conjugate strain, xi times the plastic multiplier");
    m.cone = r.read(keys.cone);
  } else if (m.law == MaterialLaw::von_mises) {
    m.yield_stress = r.read(keys.yield_stress);
    read_hardening("of the yield stress with the equivalent plastic strain");
  }
  r.finish();
  return m;
}

}  // namespace vsb::app
