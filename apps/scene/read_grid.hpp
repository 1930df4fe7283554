// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Reads the tables [grid] and [faces] of a scene.
#pragma once

#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

struct PolarKeys : KeyTable {
  PolarKeys()
      : KeyTable("grid.polar",
                 "Nodes at given radii and angles, joined by straight edges; for dimension 2 and 3.") {}
  NumbersKey center{*this, "center", 2, Range::any(), 0.0, "m", "of the circles"};
  NumbersKey radii{*this, "radii", 2, Range::positive(), required, "m", "of the first and the last circle"};
  IntegerKey radial_cells{
      *this, "radial_cells", 1, 1'000'000, required, "", "equal intervals between the radii"};
  NumbersKey angles{*this,
                    "angles",
                    2,
                    Range::between(-360, 360),
                    required,
                    "degrees",
                    "from x towards y; less than 360 apart"};
  IntegerKey angular_cells{*this,
                           "angular_cells",
                           1,
                           1'000'000,
                           required,
                           "",
                           "equal intervals between the angles, of at most 90 degrees"};
  IncreasingKey z{*this, "z", in_words("required in dimension 3"), "m", "nodes"};
};
inline const PolarKeys polar_keys;

struct GridKeys : KeyTable {
  GridKeys()
      : KeyTable("grid",
                 "The background grid. It is uniform (`lower`, `upper`, `spacing`), rectilinear (`x`, `y`, "
                 "`z`) or `polar`. Leave at "
                 "least one empty cell beyond every loaded or free boundary.") {}
  NumbersKey lower{*this,
                   "lower",
                   per_direction,
                   Range::any(),
                   in_words("required of a uniform grid"),
                   "m",
                   "corner of the grid"};
  NumbersKey upper{
      *this, "upper",          per_direction, Range::any(), in_words("required of a uniform grid"),
      "m",   "opposite corner"};
  NumberOrNumbersKey spacing{*this, "spacing",  Range::positive(), in_words("required of a uniform grid"),
                             "m",   "cell size"};
  IncreasingKey x{*this, "x", in_words("required of a rectilinear grid"), "m", "nodes"};
  IncreasingKey y{*this, "y", in_words("required of a rectilinear grid"), "m", "nodes"};
  IncreasingKey z{*this, "z", in_words("required of a rectilinear grid"), "m", "nodes"};
  SubtableKey polar{*this, "polar", polar_keys, in_words("none"), "in place of the keys above"};

  const IncreasingKey& axis(size_t i) const { return i == 0 ? x : i == 1 ? y : z; }
  KeyList beyond(int dimension) const {
    KeyList keys{&x, &y, &z};
    keys.erase(keys.begin(), keys.begin() + dimension);
    return keys;
  }
};
inline const GridKeys grid_keys;

struct FaceKey : ChoiceKey {
  FaceKey(KeyTable& in, std::string key_name)
      : ChoiceKey(in, std::move(key_name),
                  {"open",
                   {"outflow", "open, and particles that pass it are removed"},
                   {"roller", "no normal velocity; not for faces of constant r or theta"},
                   {"fixed", "no velocity"}},
                  first_word, "an array names the components fixed at zero, such as [\"x\", \"y\"]") {
    type += ", or an array of components";
  }
};

struct FaceKeys : KeyTable {
  FaceKeys() : KeyTable("faces", "Conditions at the faces of the grid.") {}
  FaceKey x_min{*this, "x_min"}, x_max{*this, "x_max"};
  FaceKey y_min{*this, "y_min"}, y_max{*this, "y_max"};
  FaceKey z_min{*this, "z_min"}, z_max{*this, "z_max"};
  FaceKey r_min{*this, "r_min"}, r_max{*this, "r_max"};
  FaceKey theta_min{*this, "theta_min"}, theta_max{*this, "theta_max"};

  /// Side 0: the lower one.
  const FaceKey& face(const GridSpec& grid, size_t axis, size_t side) const;
  KeyList others(const GridSpec& grid, int dimension) const;
};
inline const FaceKeys face_keys;

GridSpec read_grid(TableReader r, int dimension);
FaceSpec read_faces(TableReader r, int dimension, const GridSpec& grid);

}  // namespace vsb::app
