// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The static state of a scene under its final loads, by conjugate gradients in place of time steps.
#pragma once

#include "run/run_scene.hpp"

namespace vsb::app {

/// Solves and writes what a run writes at its end. Throws SetupError, before anything is written, for a scene
/// that has no static state or whose static state this solver cannot find; NotStatic where it does not find
/// it within static.max_iterations; Diverged; FileError. An interrupt leaves nothing behind.
RunResult run_static(const Scene& scene, const RunOptions& options);

}  // namespace vsb::app
