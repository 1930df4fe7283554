// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What other work leaves of the machine.
#pragma once

#include <optional>

namespace vsb::app {

/// Of the cores that this process may use, how many are idle at present: measured over a tenth of a second.
/// Nothing where the system does not tell.
std::optional<double> idle_cores();

}  // namespace vsb::app
