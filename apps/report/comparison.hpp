// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Particles against an exact solution: the solution at the particles, and the error norms of Eq. (30) to Eq.
/// (33).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/particle_reader.hpp"
#include "scene/scene.hpp"

namespace vsb::app {

/// The exact solution at every particle; empty vectors where the solution does not say.
struct ExactFields {
  std::vector<double> displacement;   ///< [3 per particle], m
  std::vector<double> cauchy_stress;  ///< [6 per particle], Pa; components the solution leaves open are zero
};

/// What a scene's exact solution says, and the fields of the particles that it needs.
struct KnownExactly {
  bool displacement = false, cauchy_stress = false;
  unsigned needed = 0;
};
KnownExactly known_exactly(const Scene& scene);
/// At the particles' current positions (the column's at their initial ones).
ExactFields exact_at(const Scene& scene, const Snapshot& snapshot);

struct ComparisonResult {
  std::vector<std::pair<std::string, double>> errors;   ///< name -> norm; none without a comparison
  std::vector<std::pair<std::string, double>> figures;  ///< name -> what is compared but is no error
};

/// The names of the figures that a comparison yields beside its errors.
std::vector<std::string> comparison_figure_names(const Comparison& comparison);

/// Evaluates the scene's comparison in the same places. The norms of the recovered stress, where the scene
/// asks for them, need particles.recovered_stress.
ComparisonResult compare_with_exact(const Scene& scene, const ParticleReader& particles);

}  // namespace vsb::app
