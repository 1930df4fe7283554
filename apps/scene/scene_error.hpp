// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The exception of everything that reads input.
#pragma once

#include <stdexcept>

namespace vsb::app {

/// A mistake in a scene; the text is complete: file:line:column, key, value, what is allowed.
struct SceneError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace vsb::app
