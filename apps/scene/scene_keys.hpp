// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The keys of a scene.
#pragma once

#include "scene/key.hpp"

namespace vsb::app {

/// Those of the document, and through them all others.
const KeyTable& scene_keys();

}  // namespace vsb::app
