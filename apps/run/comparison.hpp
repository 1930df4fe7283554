// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A snapshot against an exact solution: the solution at the particles, and the error norms of Eqs.
/// (30)-(33).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "run/simulation.hpp"
#include "scene/scene.hpp"

namespace vsb::app {

/// The exact solution at every particle; empty vectors where the solution does not say.
struct ExactFields {
  std::vector<double> displacement;   ///< [3 per particle], m
  std::vector<double> cauchy_stress;  ///< [6 per particle], Pa; components the solution leaves open are zero
};

struct ComparisonResult {
  std::vector<std::pair<std::string, double>> errors;  ///< name -> norm; none without a comparison
  ExactFields exact;
  std::vector<std::pair<std::string, double>> figures;  ///< name -> what is compared but is no error
};

/// The names of the figures that a comparison yields beside its errors.
std::vector<std::string> comparison_figure_names(const Comparison& comparison);

/// Evaluates the scene's comparison at the particles' current positions (the column's at their initial ones).
/// The norms of the recovered stress, where the scene asks for them, need snapshot.recovered_stress.
ComparisonResult compare_with_exact(const Scene& scene, const Snapshot& snapshot);

}  // namespace vsb::app
