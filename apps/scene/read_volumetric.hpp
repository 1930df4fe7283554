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

bool may_lock(const BodySpec& body);

/// The key stands for whether particles strain by a mean. A scene that does not say averages where one of its
/// bodies may lock.
void read_volumetric(TableReader& method, const ChoiceKeyOf<bool>& key, Scene& scene);

}  // namespace vsb::app
