// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The balance of a scene's initial state under its final loads: no steps are made.
#pragma once

#include "run/run_scene.hpp"

namespace vsb::app {

/// Leaves a summary and no frames. Throws SetupError and FileError.
RunResult run_balance(const Scene& scene, const RunOptions& options);

}  // namespace vsb::app
