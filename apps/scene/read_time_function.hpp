// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Reads how a load varies in time.
#pragma once

#include <string>
#include <utility>

#include "scene/read_time.hpp"
#include "scene/time_function.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

struct SineKeys : KeyTable {
  explicit SineKeys(std::string path)
      : KeyTable(std::move(path),
                 "mean + amplitude sin(2 pi (t - start) / period + phase), and the mean before the start.") {}
  NumberKey period{*this, "period", Range::positive(), required, "s", "of one oscillation"};
  NumberKey amplitude{*this, "amplitude", Range::any(), 1.0, "", "share of the full load"};
  NumberKey mean{*this, "mean", Range::any(), 0.0, "", "share of the full load; the factor before 'start'"};
  NumberKey start{*this, "start", Range::at_least(0), 0.0, "s", "of the oscillation"};
  NumberKey phase{*this, "phase", Range::any(), 0.0, "degrees", "at 'start'"};
};
inline const SineKeys traction_sine_keys{"traction.time.sine"}, gravity_sine_keys{"gravity_time.sine"};

/// One of these.
struct LoadTimeKeys : KeyTable {
  LoadTimeKeys(std::string path, const SineKeys& its_sine)
      : KeyTable(std::move(path), "How the load varies in time: one of these keys."), sine_keys(its_sine) {}

  const SineKeys& sine_keys;
  NumberKey ramp{*this,
                 "ramp",
                 Range::at_least(0),
                 0.0,
                 "s",
                 "to full load; 0: full load from the start; or ramp_steps, smooth_ramp, smooth_ramp_steps, "
                 "step, table, sine"};
  IntegerKey ramp_steps{*this, "ramp_steps", 1, most_steps, in_words(""), "", "steps to full load"};
  NumberKey smooth_ramp{*this,        "smooth_ramp", Range::positive(),
                        in_words(""), "s",           "to full load, without a jump of slope"};
  IntegerKey smooth_ramp_steps{*this,
                               "smooth_ramp_steps",
                               1,
                               most_steps,
                               in_words(""),
                               "",
                               "steps to full load, without a jump of slope"};
  NumberKey step{*this, "step", Range::at_least(0), in_words(""), "s", "full load from here on"};
  OwnKey table{*this,
               "table",
               "array of [time, factor] pairs",
               in_words(""),
               "s, 1",
               "times not decreasing; straight between the pairs, a jump between two of the same time"};
  SubtableKey sine{*this, "sine", sine_keys, in_words(""), "an oscillation"};
};
inline const LoadTimeKeys traction_time_keys{"traction.time", traction_sine_keys},
    gravity_time_keys{"gravity_time", gravity_sine_keys};

/// dt is only known after the materials: a ramp given in steps is kept as such until then.
struct TimeShape {
  TimeFunction in_seconds;
  long long ramp_steps = 0;
  bool smooth = false;

  TimeFunction at(double dt) const;
};

TimeShape read_time_function(TableReader r, const LoadTimeKeys& keys);

}  // namespace vsb::app
