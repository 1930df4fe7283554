// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Reads method.volumetric of a scene whose bodies and basis are known.
#pragma once

#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

/// The Poisson ratio from which on particles that strain by their own divergence lock: the error of the
/// stress is twice that at 0.2 there, and grows without end.
constexpr double locking_poisson_ratio = 0.4;

/// Whether its elastic strain may: by its Poisson ratio.
bool may_lock(const BodySpec& body);

/// The key stands for whether particles strain by a mean. A scene that does not say averages where one of its
/// bodies may lock, or yield: plastic flow keeps the volume, so that cells lock at any Poisson ratio.
/// as_in_paper: bodies that yield are left as they are.
void read_volumetric(TableReader& method, const ChoiceKeyOf<bool>& key, bool as_in_paper, Scene& scene);

}  // namespace vsb::app
