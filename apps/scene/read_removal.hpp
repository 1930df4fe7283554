// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Reads the table 'removal' of a scene.
#pragma once

#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

struct HoleKeys : KeyTable {
  HoleKeys()
      : KeyTable(
            "removal.hole",
            "The round hole from which failure spreads, for the rows of particles that a stage reports.") {}
  NumbersKey center{*this, "center", per_direction, Range::any(), required, "m", "a point of its axis"};
  ChoiceKey axis{*this, "axis", {"x", "y", "z"}, std::string("z"), "of a hole in dimension 3"};
  NumberKey radius{*this, "radius", Range::positive(), required, "m", "at the start"};
  NumberKey row{*this,
                "row",
                Range::positive(),
                in_words("the particles' spacing, where they lie on a square lattice"),
                "m",
                "between rows of particles"};
};
inline const HoleKeys hole_keys;

struct RemovalKeys : KeyTable {
  RemovalKeys()
      : KeyTable(
            "removal",
            "Failure in stages (Algorithm 2): particles that failed are taken out of the body at rest.") {}
  ChoiceKey measure{
      *this, "measure", {"equivalent_plastic_strain"}, first_word, "by which a particle fails, Eq. (34)"};
  NumberKey threshold{*this, "threshold", Range::positive(), required, "", "particles beyond it are removed"};
  BooleanKey remap{*this, "remap", true, "judges particles by the measure smoothed over the nodes"};
  ChoiceKeyOf<bool> next{*this,
                         "next",
                         {{"reset", true, "as it was at the start"}, {"continue", false, "as it is"}},
                         first_word,
                         "how the rest of the body begins the next stage"};
  NumberKey damping{*this,
                    "damping",
                    {0, 1, false, true},
                    in_words("`0.5`, for next = \"continue\" alone"),
                    "",
                    "of the stages after the first"};
  IntegerKey max_stages{*this, "max_stages", 1, 1000, 10, "", "the last stage in any case"};
  IntegerKey settled{*this,
                     "settled",
                     0,
                     1'000'000'000'000LL,
                     0,
                     "",
                     "steps under constant loads without another particle beyond the threshold after which a "
                     "stage is at its end, too; 0: when it is static alone"};
  NumberKey collapse{*this, "collapse", {0, 1, true, false},
                     0.9,   "",         "share of the particles beyond the threshold that ends the run"};
  SubtableKey hole{*this, "hole", hole_keys, in_words("none"), "for dimension 2 and 3"};
};
inline const RemovalKeys removal_keys;

/// The removal of failed particles in stages; none where the scene has no such table, `key` of the document.
/// Everything else of the scene must have been read.
std::optional<RemovalSpec> read_removal(TableReader& document, const SubtableKey& key, const Scene& scene);

}  // namespace vsb::app
