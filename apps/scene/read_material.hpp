// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Reading of a body's material.
#pragma once

#include "scene/material_spec.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

struct MaterialKeys : KeyTable {
  MaterialKeys();
  ChoiceKeyOf<MaterialLaw> law{
      *this,
      "law",
      {{"linear_elastic", MaterialLaw::linear_elastic},
       {"hencky", MaterialLaw::hencky, "elastic, from the deformation gradient: for large strain"},
       {"mohr_coulomb", MaterialLaw::mohr_coulomb},
       {"tresca", MaterialLaw::tresca, "Mohr-Coulomb without friction"},
       {"drucker_prager", MaterialLaw::drucker_prager},
       {"von_mises", MaterialLaw::von_mises, "Drucker-Prager without friction"}},
      first_word,
      "all but the first two are plastic"};
  NumberKey youngs_modulus{*this, "youngs_modulus", Range::positive(), required, "Pa", "Young's modulus"};
  NumberKey poisson_ratio{*this, "poisson_ratio", Range::inside(-1, 0.5), required, "", "Poisson's ratio"};
  NumberKey cohesion{*this,    "cohesion", Range::at_least(0),
                     required, "Pa",       "shear strength without normal stress"};
  NumberKey friction_angle{*this,    "friction_angle", {0, 90, false, true},
                           required, "degrees",        "of internal friction"};
  NumberKey dilation_angle{*this, "dilation_angle", Range::in_words(">= 0 and <= friction_angle"),
                           0.0,   "degrees",        "of plastic flow; the friction angle: associated"};
  NumberKey tensile_strength{*this,
                             "tensile_strength",
                             Range::in_words(">= 0, at most the apex of the cone"),
                             in_words("no cut-off"),
                             "Pa",
                             "of the largest principal stress; the apex, or left out: no cut-off"};
  NumberKey yield_stress{*this, "yield_stress", Range::positive(), required, "Pa", "in uniaxial stress"};
  NumberKey hardening_modulus{
      *this,
      "hardening_modulus",
      Range::at_least(0),
      0.0,
      "Pa",
      "von Mises: of the yield stress with the equivalent plastic strain; Drucker-Prager: of the "
      "cohesion with xi times the plastic multiplier (physics/drucker_prager.hpp)"};
  ChoiceKeyOf<int> cone{*this,
                        "cone",
                        {{drucker_prager_cones[0], 0, "through its outer edges"},
                         {drucker_prager_cones[1], 1, "through its inner edges"},
                         {drucker_prager_cones[2], 2, "as strong as the pyramid in plane strain"}},
                        first_word,
                        "where the cone touches the pyramid of Mohr and Coulomb"};

  /// What a law takes beside Young's modulus and Poisson's ratio.
  KeyList of(MaterialLaw kind) const;
};
inline const MaterialKeys material_keys;

MaterialSpec read_material(TableReader r);

}  // namespace vsb::app
