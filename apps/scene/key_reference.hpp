// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The reference of the keys, as `vsb keys` prints it: Markdown, made of their declarations.
#pragma once

#include <string>

#include "scene/key.hpp"

namespace vsb::app {

/// Every table that a document may have, and every key of each, in the order in which an author meets them.
/// `introduction` stands above, with the title.
std::string key_reference(const KeyTable& document, const std::string& introduction);

/// The tables and the keys of a name: "body.material", "material", "friction_angle" or
/// "body.material.friction_angle". Throws SceneError with similar names where there are none.
std::string key_reference_of(const KeyTable& document, const std::string& name);

/// apps/scenes/keys.md.
std::string scene_key_reference();

}  // namespace vsb::app
