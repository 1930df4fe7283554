// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Regions written in TOML: { box = { lower = [0, 0], upper = [1, 2] } }, { difference = [ {...}, {...} ] },
/// ...
#pragma once

#include "scene/region.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

/// So that squares, and products of two, are finite.
inline const Range shape_coordinates = Range::between(-1e150, 1e150), shape_lengths{0, 1e150, true, false};

struct BoxKeys : KeyTable {
  BoxKeys() : KeyTable("shape.box", "What lies between two corners.") {}
  NumbersKey lower{
      *this, "lower", per_direction, shape_coordinates, required, "m", "the corner of the least coordinates"};
  NumbersKey upper{*this, "upper", per_direction, shape_coordinates, required, "m", "the opposite corner"};
};

struct BallKeys : KeyTable {
  using KeyTable::KeyTable;
  NumbersKey center{*this, "center", per_direction, shape_coordinates, required, "m", "the middle"};
  NumberKey radius{*this, "radius", shape_lengths, required, "m", "from the center to the surface"};
};

struct CylinderKeys : KeyTable {
  CylinderKeys() : KeyTable("shape.cylinder", "A round cylinder, infinite or cut off at one end or both.") {}
  ChoiceKey axis{*this, "axis", {"x", "y", "z"}, std::string("z"), "or a direction such as [1.0, 0.0, 1.0]"};
  NumbersKey direction{*this,
                       "axis",
                       per_direction,
                       shape_coordinates,
                       in_words("`\"z\"`"),
                       "",
                       "direction of the axis, of any length"};
  NumbersKey center{*this, "center", per_direction, shape_coordinates, required, "m", "a point of the axis"};
  NumberKey radius{*this, "radius", shape_lengths, required, "m", "from the axis to the surface"};
  NumberKey lower{*this,        "lower",
                  Range::any(), in_words("no end"),
                  "m",          "where it begins: x . axis, for an axis of length 1"};
  NumberKey upper{*this, "upper", Range::any(), in_words("no end"), "m", "where it ends"};
};

struct EllipsoidKeys : KeyTable {
  using KeyTable::KeyTable;
  NumbersKey center{*this, "center", per_direction, shape_coordinates, required, "m", "the middle"};
  NumbersKey semi_axes{
      *this, "semi_axes", per_direction, shape_lengths, required, "m", "half the extent along each axis"};
};

struct HalfSpaceKeys : KeyTable {
  HalfSpaceKeys() : KeyTable("shape.half_space", "What lies on one side of a plane.") {}
  NumbersKey point{*this, "point", per_direction, shape_coordinates, required, "m", "of the plane"};
  NumbersKey normal{*this,
                    "normal",
                    per_direction,
                    shape_coordinates,
                    required,
                    "",
                    "out of the half space, of any length"};
};

inline const BoxKeys box_keys;
inline const BallKeys ball_keys{"shape.ball", "What is no farther from a point than a radius."};
inline const BallKeys disc_keys{"shape.disc", "The ball of dimension 2."};
inline const CylinderKeys cylinder_keys;
inline const EllipsoidKeys ellipse_shape_keys{"shape.ellipse", "The ellipsoid of dimension 2."};
inline const EllipsoidKeys ellipsoid_keys{"shape.ellipsoid", "An ellipsoid along the axes of coordinates."};
inline const HalfSpaceKeys half_space_keys;

/// Exactly one of these keys makes a shape.
struct ShapeKeys : KeyTable {
  ShapeKeys()
      : KeyTable("shape",
                 "A region of space: what a body fills, or where a traction acts. It has exactly one of "
                 "these keys, such as "
                 "`shape = { box = { lower = [0.0, 0.0], upper = [4.0, 3.0] } }`.") {}
  SubtableKey box{*this, "box", box_keys, in_words(""), "a box along the axes of coordinates"};
  SubtableKey ball{*this, "ball", ball_keys, in_words(""), "in any dimension"};
  SubtableKey disc{*this, "disc", disc_keys, in_words(""), "for dimension 2"};
  SubtableKey cylinder{*this, "cylinder", cylinder_keys, in_words(""), "for dimension 3"};
  SubtableKey ellipse{*this, "ellipse", ellipse_shape_keys, in_words(""), "for dimension 2"};
  SubtableKey ellipsoid{*this, "ellipsoid", ellipsoid_keys, in_words(""), "in any dimension"};
  SubtableKey half_space{*this, "half_space", half_space_keys, in_words(""), "in any dimension"};
  OwnKey all_of{*this, "union", "array of shapes", in_words(""), "", "what lies in one of them"};
  OwnKey common{*this, "intersection", "array of shapes", in_words(""), "", "what lies in all of them"};
  OwnKey difference{*this,        "difference", "array of at least two shapes",
                    in_words(""), "",           "what lies in the first one and in no other"};
};
inline const ShapeKeys shape_keys;

/// A shape as the value of a key.
struct ShapeKey : OwnKey {
  ShapeKey(KeyTable& in, std::string key_name, const InWords& key_preset, std::string key_sentence)
      : OwnKey(in, std::move(key_name), "table", key_preset, "", std::move(key_sentence), &shape_keys) {}
};

/// Reads the region under `key`; an absent key is an error, or `everywhere` where it is optional.
Region read_region(TableReader& reader, const ShapeKey& key, int dimension, bool optional);

}  // namespace vsb::app
