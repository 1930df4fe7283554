// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Reads the tables [[traction]] of a scene.
#pragma once

#include "scene/read_region.hpp"
#include "scene/read_stress_field.hpp"
#include "scene/read_time_function.hpp"
#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

struct TractionKeys : KeyTable {
  TractionKeys()
      : KeyTable("traction",
                 "A load on a boundary: a stress field, of which `physics/fields.md` tells how to choose "
                 "one, and where it acts. Several of them add up.") {}
  TextKey name{*this, "name", in_words("`\"traction 1\"`, ..."), "for messages"};
  ChoiceKeyOf<Imposition> imposition{
      *this,
      "imposition",
      {{"virtual_stress", Imposition::virtual_stress, "the modified method, Eq. (27), Eq. (28)"},
       {"virtual_stress_original", Imposition::virtual_stress_original, "Eq. (21), Eq. (22)"},
       {"boundary_particles", Imposition::boundary_particles, "massless particles on the surface, Eq. (13)"},
       {"material_points", Imposition::material_points, "the outermost layer of particles, Eq. (12)"},
       {"nodal", Imposition::nodal, "the nodes of a boundary that the grid follows"}},
      first_word,
      "how the traction becomes nodal forces"};
  StressFieldKeys field{*this};
  ChoiceKeyOf<bool> nodes{*this,
                          "nodes",
                          {{"boundary", false, "those of Algorithm 1 in the surface"},
                           {"all", true, "all surfaces at once: the resultant is exact"}},
                          first_word,
                          "at which nodes it acts"};
  BooleanKey self_balanced{*this, "self_balanced", false,
                           "takes its resultant out by a rigid body force; needs nodes = \"all\""};
  ShapeKey surface{*this, "surface", in_words("everywhere"),
                   "the nodes at which it may act: one or two cells beyond the loaded edge on either side, "
                   "and no other edge"};
  ChoiceKeyOf<bool> configuration{*this,
                                  "configuration",
                                  {{"current", false, "stays where it is in space"},
                                   {"initial", true, "a part of the undeformed body, with which it moves"}},
                                  first_word,
                                  "what the surface is a part of"};
  ShapeKey layer{*this, "layer", in_words("everywhere"),
                 "of imposition = \"material_points\": which particles may carry the load"};
  IntegerKey points_per_cell{*this, "points_per_cell",        1, 64, in_words("`8`, in dimension 3 `4`"),
                             "",    "sampling of the surface"};
  SubtableKey time{*this, "time", traction_time_keys, in_words("full load from the start"),
                   "how it varies in time"};
};
inline const TractionKeys traction_keys;

/// Grid, faces and bodies must be known. `time`: of the traction, whose own is set when dt is known.
TractionSpec read_traction(TableReader r, const Scene& scene, size_t number, TimeShape& time);

}  // namespace vsb::app
