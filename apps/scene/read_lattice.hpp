// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Lattices written in TOML: particles_per_cell = 4, lattice.uniform = { spacing = 0.1 },
/// lattice.concentric = { ... }.
#pragma once

#include <limits>

#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

struct UniformLatticeKeys : KeyTable {
  UniformLatticeKeys()
      : KeyTable("body.lattice.uniform", "Particles at equal distances, whatever the grid.") {}
  NumberOrNumbersKey spacing{*this, "spacing", Range::positive(), required, "m", "between particles"};
  NumbersKey origin{*this,
                    "origin",
                    per_direction,
                    Range::any(),
                    in_words("the grid's lower corner"),
                    "m",
                    "particles at origin + (k + 1/2) spacing"};
};
inline const UniformLatticeKeys uniform_lattice_keys;

struct LayersKeys : KeyTable {
  LayersKeys() : KeyTable("body.lattice.concentric.layers", "Where the rings are repeated along z.") {}
  NumberKey lower{*this, "lower", Range::any(), required, "m", "along z"};
  NumberKey upper{*this, "upper", Range::in_words("> lower"), required, "m", "along z"};
  IntegerKey count{*this, "count", 1, 1'000'000, required, "", "layers of equal height"};
};
inline const LayersKeys layers_keys;

struct ConcentricLatticeKeys : KeyTable {
  ConcentricLatticeKeys()
      : KeyTable("body.lattice.concentric", "Particles on rings; for dimension 2 and 3.") {}
  NumbersKey center{*this, "center", 2, Range::any(), required, "m", "x and y"};
  NumbersKey radii{*this, "radii", 2, Range::at_least(0), required, "m", "inner and outer"};
  IntegerKey rings{*this, "rings", 1, 1'000'000, required, "", "of equal width between the radii"};
  IntegerKey per_ring{*this, "per_ring", 1, 10'000'000, required, "", "particles between the angles"};
  NumbersKey angles{*this,
                    "angles",
                    2,
                    Range::any(),
                    in_words("`[0.0, 360.0]`"),
                    "degrees",
                    "from the x axis; at most 360 apart"};
  SubtableKey layers{*this, "layers", layers_keys, in_words("required in dimension 3"),
                     "with lower, upper and count, along z"};
};
inline const ConcentricLatticeKeys concentric_lattice_keys;

struct LatticeTableKeys : KeyTable {
  LatticeTableKeys()
      : KeyTable("body.lattice", "Particles that do not follow the cells: one of these keys.") {}
  SubtableKey uniform{*this, "uniform", uniform_lattice_keys, in_words(""), "a square lattice of its own"};
  SubtableKey concentric{*this, "concentric", concentric_lattice_keys, in_words(""), "rings"};
};
inline const LatticeTableKeys lattice_keys;

/// The keys of a body that say where its particles lie.
struct LatticeKeys {
  KeyTable& body;
  IntegerOrIntegersKey particles_per_cell{
      body, "particles_per_cell", 1, 64, in_words("required, or `lattice`; 2 with setting = \"accurate\""),
      "",   "in each direction"};
  SubtableKey lattice{body, "lattice", lattice_keys, in_words("none"), "in place of particles_per_cell"};
  ChoiceKeyOf<BoundaryBoxes> boundary{
      body,
      "boundary",
      {{"keep", BoundaryBoxes::keep, "whole if their centre lies in the body: the paper's way"},
       {"cut", BoundaryBoxes::cut, "volume and centroid of what lies in the body"},
       {"cut2x2", BoundaryBoxes::cut2x2, "in two per direction first"}},
      in_words("`\"keep\"`; `\"cut2x2\"` with setting = \"accurate\""),
      "what becomes of the lattice boxes that the surface cuts"};
  NumberKey jitter{body, "jitter", {0, 0.5, false, true},
                   0.0,  "",       "random shift of every particle, in spacings: at most this either way"};
  IntegerKey seed{body, "seed", 0, std::numeric_limits<long long>::max(), 1, "", "of the random shifts"};
};

/// Reads them. Grid, dimension and setting of the scene must be known.
void read_lattice(TableReader& body_table, const LatticeKeys& keys, const Scene& scene, BodySpec& body);

}  // namespace vsb::app
