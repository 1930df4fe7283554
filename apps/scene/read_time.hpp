// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Reads the tables [time] and [static] of a scene.
#pragma once

#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

constexpr long long most_steps = 1'000'000'000'000LL;

struct UntilStaticKeys : KeyTable {
  UntilStaticKeys()
      : KeyTable("time.until_static", "The run ends at rest: when both ratios are below their limits.") {}
  NumberKey force_ratio{*this,
                        "force_ratio",
                        {0, 1, true, true},
                        in_words("`2e-5` with B-splines, else `1e-6`"),
                        "",
                        "unbalanced force / internal force"};
  NumberKey energy_ratio{*this,
                         "energy_ratio",
                         {0, 1, true, true},
                         in_words("`1e-6` with B-splines, else `1e-9`"),
                         "",
                         "kinetic energy of the nodes / strain energy"};
  IntegerKey check_every{
      *this, "check_every", 1, most_steps, 100, "steps", "between two looks at the ratios"};
  IntegerKey max_steps{*this,
                       "max_steps",
                       1,
                       most_steps,
                       1'000'000,
                       "",
                       "the last step in any case; or, in place of until_static, steps"};
};
inline const UntilStaticKeys until_static_keys;

struct TimeKeys : KeyTable {
  TimeKeys()
      : KeyTable(
            "time",
            "The time step and the end of the run. It has `dt` or `kappa`, and `steps` or `until_static`.") {}
  NumberKey dt{*this,
               "dt",
               Range::in_words("> 0, at most twice the critical one"),
               in_words("or `kappa`"),
               "s",
               "the time step; or kappa"};
  NumberKey kappa{*this,
                  "kappa",
                  {0, 2, true, false},
                  in_words("or `dt`"),
                  "",
                  "share of the critical time step, Eq. (29); or dt"};
  IntegerKey steps{
      *this, "steps", 1, most_steps, in_words("or `until_static`"), "", "to run; or a table until_static"};
  SubtableKey until_static{*this, "until_static", until_static_keys, in_words("or `steps`"),
                           "run until nothing moves; `{}` takes the defaults"};
};
inline const TimeKeys time_keys;

struct StaticKeys : KeyTable {
  StaticKeys() : KeyTable("static", "When the conjugate gradients of `vsb run --static` end.") {}
  NumberKey residual{*this, "residual", {0, 1, true, true}, 1e-10, "", "relative, for vsb run --static"};
  IntegerKey max_iterations{*this, "max_iterations", 1, 100'000'000, 20'000, "", "for vsb run --static"};
};
inline const StaticKeys static_keys;

/// Grid, bodies and basis must be known.
TimeSpec read_time(TableReader r, const Scene& scene);
StaticSpec read_static(TableReader r);

}  // namespace vsb::app
