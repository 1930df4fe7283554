// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Reads the table [method] of a scene.
#pragma once

#include "scene/read_basis.hpp"
#include "scene/read_moment_fit.hpp"
#include "scene/read_volumetric.hpp"
#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

struct MethodKeys : KeyTable {
  MethodKeys() : KeyTable("method", "How a step is done.") {}
  BasisKeys basis{*this};
  NumberKey damping{*this, "damping", {0, 1, false, true},
                    0.0,   "",        "Cundall's alpha; not for bodies that move as a whole"};
  ChoiceKey volume_update{*this,
                          "volume_update",
                          {{"determinant", "V det(I + L dt)"}, {"exponential", "V exp(dt tr L)"}},
                          first_word,
                          "of the particles"};
  ChoiceKey scatter{*this,
                    "scatter",
                    {{"gathered", "the same bits on any number of threads"}, "duplicated", "atomic"},
                    first_word,
                    "how particle kernels sum at nodes"};
  ChoiceKey engine{*this,
                   "engine",
                   {{"auto", "cell lanes where the scene can have them"}, "cell_lanes", "particles"},
                   first_word,
                   "cell lanes are ten times as fast, for the same particles"};
  IntegerKey cell_gauss_points{
      *this, "cell_gauss_points", 1, 4, 2, "", "per direction, for imposition = \"virtual_stress_original\""};
  NumberKey fill_criterion{
      *this,
      "fill_criterion",
      {0, 1, false, true},
      0.0,
      "",
      "tau: cells filled by less than 1 - tau count as boundary cells; 0: no such cells"};
  BooleanKey void_filter{*this, "void_filter", false,
                         "void cells inside a body, cut off from the outside, are no boundary"};
  BooleanKey moment_fit{
      *this, "moment_fit", false,
      "volumes of jittered particles, or of those on rings, with which sums over a cell are integrals"};
  ChoiceKeyOf<bool> volumetric{
      *this,
      "volumetric",
      {{"full", false}, {"averaged", true, "the mean over neighbours: no locking near incompressibility"}},
      in_words("`\"averaged\"` where a Poisson's ratio is 0.4 or more, or a body may yield (not with "
               "`setting = \"paper\"`)"),
      "the divergence by which particles strain"};
  ChoiceKeyOf<bool> position_velocity{*this,
                                      "position_velocity",
                                      {{"strain", false, "the re-mapped one, which strains them too"},
                                       {"grid", true, "that of the paper's step"}},
                                      in_words("`\"grid\"` with `setting = \"paper\"`, else `\"strain\"`"),
                                      "the nodal velocity that moves the particles"};
  NumberKey pic{
      *this,
      "pic",
      {0, 1, false, true},
      0.0,
      "",
      "share of PIC in the velocities of particles: takes away what the nodes do not see, such as the "
      "heat of particles that cross many cells; .01 kappa is usual; a wave of n cells loses pi^2 pic / "
      "(2 n kappa) of its amplitude a period, and bodies that turn are braked"};
  BooleanKey allow_particles_on_grid_lines{
      *this, "allow_particles_on_grid_lines", false,
      "takes particles that lie on the faces of cells, whose cell is a matter of round-off"};
};
inline const MethodKeys method_keys;

/// Everything before it in the scene must be known; as_in_paper: the scene says setting = "paper".
void read_method(TableReader r, bool as_in_paper, Scene& scene);

}  // namespace vsb::app
