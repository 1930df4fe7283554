// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Reads the stress field of a traction.
#pragma once

#include "scene/read_affine.hpp"
#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

/// A uniform stress: one of these.
struct StressKeys {
  KeyTable& table;
  NumberKey pressure{table,        "pressure",
                     Range::any(), in_words("one of them"),
                     "Pa",         "positive in compression; or stress (xx yy zz xy yz xz)"};
  NumbersKey stress{table,
                    "stress",
                    6,
                    Range::any(),
                    in_words("one of them"),
                    "Pa",
                    std::string("virtual stress, ") + stress_order + "; or pressure"};
};

struct HydrostaticKeys : KeyTable {
  HydrostaticKeys() : KeyTable("traction.hydrostatic", "The pressure of a fluid at rest.") {}
  NumberKey unit_weight{*this, "unit_weight", Range::positive(), required, "N/m^3", "of the fluid"};
  NumberKey level{*this, "level", Range::any(), required, "m", "of the free surface along 'up'"};
  NumbersKey up{*this,
                "up",
                per_direction,
                Range::any(),
                in_words("the last axis"),
                "",
                "direction against gravity, of any length"};
  NumberKey width{*this,
                  "width",
                  Range::at_least(0),
                  in_words("the particles' spacing"),
                  "m",
                  "over which the kink at the free surface is averaged: the particles' spacing"};
};
inline const HydrostaticKeys hydrostatic_keys;

/// One of the two surfaces between which a stress is blended.
struct BlendRadiusKeys : KeyTable {
  BlendRadiusKeys(std::string path, std::string purpose, const Range& range)
      : KeyTable(std::move(path), std::move(purpose)), radius{*this,    "radius", range,
                                                              required, "m",      "of the surface"} {}
  NumberKey radius;
  StressKeys uniform{*this};
};
inline const BlendRadiusKeys blend_inner_keys{"traction.radial_blend.inner",
                                              "The inner surface and the stress there.", Range::at_least(0)};
inline const BlendRadiusKeys blend_outer_keys{"traction.radial_blend.outer",
                                              "The outer surface and the stress there.",
                                              Range::in_words("> inner.radius")};

struct RadialBlendKeys : KeyTable {
  RadialBlendKeys()
      : KeyTable("traction.radial_blend",
                 "A stress that goes over from one to another between two spheres or cylinders.") {}
  NumbersKey center{*this, "center", per_direction, Range::any(), required, "m", "of both surfaces"};
  ChoiceKey axis{*this,
                 "axis",
                 {"none", "x", "y", "z"},
                 in_words("required, for dimension 3 alone"),
                 "of cylinders; none: spheres"};
  SubtableKey inner{*this, "inner", blend_inner_keys, required, "with radius, and pressure or stress"};
  SubtableKey outer{*this, "outer", blend_outer_keys, required, "with radius, and pressure or stress"};
};
inline const RadialBlendKeys radial_blend_keys;

struct BlendPointKeys : KeyTable {
  using KeyTable::KeyTable;
  NumbersKey point{*this,
                   "point",
                   per_direction,
                   Range::any(),
                   required,
                   "m",
                   "the planes are normal to the line between the two points"};
  StressKeys uniform{*this};
};
inline const BlendPointKeys blend_start_keys{"traction.planar_blend.start",
                                             "The first plane and the stress there."};
inline const BlendPointKeys blend_end_keys{"traction.planar_blend.end",
                                           "The second plane and the stress there."};

struct PlanarBlendKeys : KeyTable {
  PlanarBlendKeys()
      : KeyTable("traction.planar_blend",
                 "A stress that goes over from one to another between two parallel planes.") {}
  SubtableKey start{*this, "start", blend_start_keys, required, "with point, and pressure or stress"};
  SubtableKey end{*this, "end", blend_end_keys, required, "with point, and pressure or stress"};
};
inline const PlanarBlendKeys planar_blend_keys;

/// An infinite plate with a pressurised elliptic hole.
struct EllipseKeys {
  KeyTable& table;
  const char* preset;  ///< of a table whose other keys decide whether these are needed
  NumberKey semi_major{
      table, "semi_major", Range::positive(), in_words(preset), "m", "of the elliptic hole, along x"};
  NumberKey semi_minor{
      table, "semi_minor", Range::positive(), in_words(preset), "m", "of the elliptic hole, along y"};
  NumberKey pressure{table,
                     "pressure",
                     Range::positive(),
                     in_words(preset),
                     "Pa",
                     "in the elliptic hole, positive in compression"};
  NumberKey far_stress{table, "far_stress", Range::any(), in_words(preset), "Pa", "-sigma_yy far away"};
  NumberKey far_ratio{
      table, "far_ratio", Range::any(), in_words(preset), "", "K = sigma_xx / sigma_yy far away"};
};
EllipseSpec read_ellipse(TableReader& r, const EllipseKeys& keys);

struct ExactEllipseKeys : KeyTable {
  ExactEllipseKeys()
      : KeyTable("traction.exact_ellipse",
                 "The exact stress of an infinite plate with a pressurised elliptic hole.") {}
  EllipseKeys ellipse{*this, "required"};
};
inline const ExactEllipseKeys exact_ellipse_keys;

/// The keys of a traction of which one says what its stress is.
struct StressFieldKeys {
  KeyTable& traction;
  size_t first = traction.keys().size();
  StressKeys uniform{traction};
  SubtableKey affine{traction, "affine", affine_stress_keys, in_words("one of them"),
                     "a stress that is affine in x"};
  SubtableKey hydrostatic{traction, "hydrostatic", hydrostatic_keys, in_words("one of them"), "water or mud"};
  SubtableKey radial_blend{traction, "radial_blend", radial_blend_keys, in_words("one of them"),
                           "one stress inside, another one outside"};
  SubtableKey planar_blend{traction, "planar_blend", planar_blend_keys, in_words("one of them"),
                           "one stress at a plane, another one at a second plane"};
  SubtableKey exact_ellipse{traction, "exact_ellipse", exact_ellipse_keys, in_words("one of them"),
                            "for dimension 2: the far field around an elliptic hole"};
  size_t last = traction.keys().size();

  KeyList all() const {
    const auto begin = traction.keys().begin();
    return {begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(last)};
  }
};

/// The one stress field that a traction has. `scene` has its grid and bodies already.
StressFieldSpec read_stress_field(TableReader& traction, const StressFieldKeys& keys, const Scene& scene);

}  // namespace vsb::app
