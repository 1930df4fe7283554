// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Reads the tables [[body]] of a scene.
#pragma once

#include "scene/read_affine.hpp"
#include "scene/read_lattice.hpp"
#include "scene/read_material.hpp"
#include "scene/read_region.hpp"
#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

struct BodyKeys : KeyTable {
  BodyKeys() : KeyTable("body", "A body: its shape, its particles and its material.") {}
  TextKey name{*this, "name", in_words("`\"body 1\"`, ..."), "for messages"};
  ShapeKey shape{*this, "shape", required,
                 "what it fills; what lies beyond a roller or a fixed face is cut off"};
  LatticeKeys lattice{*this};
  NumberKey density{*this, "density", Range::positive(), required, "kg/m^3", "of the undeformed body"};
  AffineKey stress{*this, "stress", initial_stress_keys, std::string("at the start, ") + stress_order};
  AffineKey velocity{*this, "velocity", initial_velocity_keys, "at the start"};
  SubtableKey material{*this, "material", material_keys, required, "how stress follows from deformation"};
};
inline const BodyKeys body_keys;

template <class Value>
bool is_zero(const Affine<Value>& field) {
  return field.value == Value{} && field.gradient == std::array<Value, 3>{};
}

/// Setting, dimension and grid must be known.
BodySpec read_body(TableReader r, const Scene& scene, size_t number);

}  // namespace vsb::app
