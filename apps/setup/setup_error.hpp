// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What is thrown of scenes that cannot be set up.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace vsb::app {

/// A scene that is well written but cannot be run as it stands.
struct SetupError : std::runtime_error {
  using std::runtime_error::runtime_error;
  SetupError(std::string at, const std::string& text) : std::runtime_error(text), where(std::move(at)) {}
  std::string where;  ///< file:line:column of the table that is at fault; empty: the scene as a whole
};

}  // namespace vsb::app
