// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What a scene needs at least, found before anything of it is made.
#pragma once

#include "scene/scene.hpp"

namespace vsb::app {

/// Bytes that a process may have: what the machine has, or a limit that is set for this one.
double memory_at_hand();

/// Throws SetupError, with the figures, for a scene whose nodes and particles do not fit into
/// memory_at_hand(), or are more than can be numbered.
void refuse_what_does_not_fit(const Scene& scene);

}  // namespace vsb::app
