// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Reads the table [output] of a scene.
#pragma once

#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

struct OutputKeys : KeyTable {
  OutputKeys() : KeyTable("output", "What a run leaves beside its summary.") {}
  IntegerKey every{
      *this, "every", 0, 1'000'000'000'000LL, 0, "", "steps between frames; 0: first and last state only"};
  WordsKey fields{*this, "fields", field_names(), in_words("all but `recovered_stress`"),
                  "of the particles, in frames"};
  BooleanKey grid{*this, "grid", false, "frames of the nodes, too"};
  NumberKey checkpoint_minutes{
      *this,
      "checkpoint_minutes",
      Range::at_least(0),
      10.0,
      "",
      "wall time; the first after one minute at the latest; 0: at an interrupt and the end only"};

  static std::string field_names();
};
inline const OutputKeys output_keys;

/// Why a recovered stress is for linear functions.
extern const char* const recovery_is_linear;

/// Bodies and basis must be known.
OutputSpec read_output(TableReader r, const Scene& scene);

}  // namespace vsb::app
