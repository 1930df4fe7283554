// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Reads the tables [compare] and [[published]] of a scene.
#pragma once

#include <deque>

#include "scene/read_stress_field.hpp"
#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

/// Which of them a scene has depends on the solution.
struct CompareKeys : KeyTable {
  CompareKeys()
      : KeyTable(
            "compare",
            "An exact solution of the scene, for error norms. The other keys are those of the solution.") {}
  ChoiceKey solution{
      *this,
      "solution",
      {{"column", "of length and traction"},
       {"cylinder", "of inner_radius, outer_radius, pressure, center and moved"},
       {"yielding_cylinder", "of inner_radius, outer_radius and pressure"},
       {"hencky_wall", "a cylinder, in 3D a sphere, of inner_radius, outer_radius, pressure and center"},
       {"ellipse", "of the keys of an elliptic hole"}},
      required,
      "with which the state is compared"};
  NumberKey length{*this, "length", Range::positive(), in_words("required by column"), "m", "L0 of Eq. (30)"};
  NumberKey traction{*this,
                     "traction",
                     Range::in_words("that the material bears"),
                     in_words("required by column"),
                     "Pa",
                     "positive in compression; not 0"};
  NumberKey inner_radius{*this,
                         "inner_radius",
                         Range::positive(),
                         in_words("required by cylinders and walls"),
                         "m",
                         "of the cylinder or the wall, undeformed"};
  NumberKey outer_radius{*this,
                         "outer_radius",
                         Range::in_words("> inner_radius"),
                         in_words("required by cylinders and walls"),
                         "m",
                         "of the cylinder or the wall, undeformed"};
  NumberKey pressure{*this,
                     "pressure",
                     Range::positive(),
                     in_words("required by cylinders and walls"),
                     "Pa",
                     "positive in compression"};
  NumbersKey center{*this, "center", 2, Range::any(), 0.0, "m", "before it moves; of a sphere 3 numbers"};
  NumbersKey moved{*this, "moved", 2, Range::any(), 0.0, "m", "carried as a whole at the end"};
  EllipseKeys ellipse{*this, "required by ellipse"};
  BooleanKey recovered{*this, "recovered", false,
                       "errors of the recovered stress, too; for linear functions"};
  BooleanKey cell_means{*this, "cell_means", false, "errors of the means over cells, too"};
};
inline const CompareKeys compare_keys;

struct PublishedKeys : KeyTable {
  PublishedKeys();
  TextKey source{*this, "source", required, "what is quoted"};
  std::deque<NumberKey> errors;  ///< every error of every solution

  const NumberKey& error(const std::string& name) const;
};
inline const PublishedKeys published_keys;

/// Dimension, bodies and basis must be known. `key` is that of the document.
Comparison read_comparison(TableReader& document, const SubtableKey& key, const Scene& scene,
                           MoreNorms& more);
/// The comparison must be known, and with it the names of the errors.
std::vector<Published> read_published(TableReader& document, const SubtablesKey& key, const Scene& scene);

}  // namespace vsb::app
