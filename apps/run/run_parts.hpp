// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What explicit runs and static solutions have in common.
#pragma once

#include "engine/simulation.hpp"
#include "files/results.hpp"
#include "report/summary.hpp"
#include "scene/load_in_time.hpp"

namespace vsb::app {

/// Throws SetupError, which begins with `who`, for a load that never settles.
void refuse_unsettled_loads(const Scene& scene, const std::string& who);

/// Prints warnings on standard error.
void print_warnings(const std::vector<std::string>& warnings);

/// Prints the advice about a scene and its simulation as warnings.
void print_advice(const Scene& scene, Simulation& simulation);

/// Writes the frames of the present state. Throws Diverged for one that is not healthy.
void write_frames(Results& results, const Scene& scene, Simulation& simulation);

/// Enters errors, counts, memory and hash of the present state into the figures of a run.
void take_state(RunFigures& figures, const Scene& scene, Simulation& simulation);

}  // namespace vsb::app
