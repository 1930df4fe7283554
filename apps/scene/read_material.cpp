// SPDX-License-Identifier: BSD-3-Clause
#include "scene/read_material.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "scene/limits.hpp"
#include "scene/units.hpp"

namespace vsb::app {

namespace {

struct Law {
  const char* name;
  std::vector<std::string> keys;  ///< beside law, youngs_modulus and poisson_ratio
};

/// In the order of MaterialLaw.
const std::vector<Law>& laws() {
  static const std::vector<Law> all = {
      {"linear_elastic", {}},
      {"hencky", {}},
      {"mohr_coulomb", {"cohesion", "friction_angle", "dilation_angle", "tensile_strength"}},
      {"tresca", {"cohesion", "tensile_strength"}},
      {"drucker_prager", {"cohesion", "friction_angle", "dilation_angle", "hardening_modulus", "cone"}},
      {"von_mises", {"yield_stress", "hardening_modulus"}}};
  return all;
}

const std::vector<std::string> elastic_keys = {"law", "youngs_modulus", "poisson_ratio"};

const Law& read_law(TableReader& r) {
  std::vector<std::string> names, keys = elastic_keys;
  for (const auto& law : laws()) {
    names.emplace_back(law.name);
    for (const auto& key : law.keys)
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  }
  r.allow_only(keys);
  const std::string name = r.choice("law", names, names[0]);
  const auto& law = *std::find_if(laws().begin(), laws().end(), [&](const Law& l) { return l.name == name; });
  for (const auto& key : keys) {
    const auto of_law = [&](const std::vector<std::string>& list) {
      return std::find(list.begin(), list.end(), key) != list.end();
    };
    if (!r.has(key) || of_law(elastic_keys) || of_law(law.keys)) continue;
    r.fail(*r.source().get(key), key,
           fmt::format("is not for law = \"{}\", which takes {}", name,
                       law.keys.empty() ? "youngs_modulus and poisson_ratio alone"
                                        : fmt::format("{}", fmt::join(law.keys, ", "))));
  }
  return law;
}

/// The cohesion and, where the law has them, the angles.
void read_strength(TableReader& r, bool friction, MaterialSpec& m) {
  m.cohesion = r.number("cohesion", friction ? Range::at_least(0) : Range::positive(), {}, "Pa");
  if (!friction) return;
  const double angle = r.number("friction_angle", {0, 90, false, true}, {}, "degrees");
  m.friction_angle = radians(angle);
  m.dilation_angle = radians(
      r.number("dilation_angle", Range::between(0, angle), 0.0, "degrees; the friction angle: associated"));
  if (m.cohesion == 0 && angle == 0)
    r.fail(*r.source().get("cohesion"), "cohesion", "must not be 0 where friction_angle is, too");
}

void read_tensile_strength(TableReader& r, MaterialSpec& m) {
  if (m.friction_angle > 0) {
    const double most = apex(m);
    if (!std::isfinite(most))
      r.fail(*r.source().get("friction_angle"), "friction_angle",
             "is too small for the cohesion: their cone has no apex below the largest number; give 0");
    m.tensile_strength = r.number("tensile_strength", Range::between(0, most), most,
                                  "Pa, of the largest principal stress; the apex: no cut-off");
  } else if (r.has("tensile_strength")) {  // there is no apex, and no number that says so
    m.tensile_strength = r.number("tensile_strength", Range::at_least(0), {},
                                  "Pa, of the largest principal stress; left out: no cut-off");
  }
}

}  // namespace

MaterialSpec read_material(TableReader r) {
  MaterialSpec m{};
  m.law = static_cast<MaterialLaw>(&read_law(r) - laws().data());
  m.youngs_modulus = r.number("youngs_modulus", Range::positive(), {}, "Pa");
  m.poisson_ratio = r.number("poisson_ratio", Range::inside(-1, 0.5));
  const auto read_hardening = [&](const char* what) {
    m.hardening_modulus = r.number("hardening_modulus", Range::at_least(0), 0.0, what);
  };
  if (m.law == MaterialLaw::mohr_coulomb || m.law == MaterialLaw::tresca) {
    read_strength(r, m.law == MaterialLaw::mohr_coulomb, m);
    read_tensile_strength(r, m);
  } else if (m.law == MaterialLaw::drucker_prager) {
    read_strength(r, true, m);
    read_hardening("Pa; growth of the cohesion with its conjugate strain, xi times the plastic multiplier");
    const std::vector<std::string> cones(std::begin(drucker_prager_cones), std::end(drucker_prager_cones));
    const auto cone = r.choice("cone", cones, cones[0]);
    m.cone = static_cast<int>(std::find(cones.begin(), cones.end(), cone) - cones.begin());
  } else if (m.law == MaterialLaw::von_mises) {
    m.yield_stress = r.number("yield_stress", Range::positive(), {}, "Pa, in uniaxial stress");
    read_hardening("Pa; growth of the yield stress with the equivalent plastic strain");
  }
  r.finish();
  return m;
}

}  // namespace vsb::app
