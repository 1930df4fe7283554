// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The basis of a scene, out of its table `method`.
#pragma once

#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

struct BasisKeys {
  KeyTable& method;
  ChoiceKeyOf<BasisKind> basis{method,
                               "basis",
                               {{"linear", BasisKind::linear, "the paper's"},
                                {"ugimp", BasisKind::ugimp},
                                {"quadratic_bspline", BasisKind::quadratic_bspline,
                                 "smooth: for accuracy, and where particles cross cells"}},
                               in_words("`\"linear\"`; `\"quadratic_bspline\"` with setting = \"accurate\""),
                               "the functions between particles and nodes"};
  NumberOrNumbersKey gimp_half_width{method,
                                     "gimp_half_width",
                                     {0, 0.5, true, false},
                                     in_words("half the particles' spacing"),
                                     "",
                                     "of ugimp: half the size of a particle, in cells"};
};

/// Why a scene cannot have the basis of setting = "accurate", where that is its setting, and what to do;
/// empty where it can. The scene must be known as for read_basis.
std::string unfit_setting(const Scene& scene);

/// Follows what is for the linear basis alone: how a scene has it whose setting takes another; empty for
/// others.
std::string linear_beside_setting(const Scene& scene);

/// Reads them into scene.method, whose other keys need not be known; grid, bodies and tractions must. Refuses
/// what the basis cannot do.
void read_basis(TableReader& method_table, const BasisKeys& keys, Scene& scene);

}  // namespace vsb::app
