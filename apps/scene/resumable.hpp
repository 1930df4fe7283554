// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What a resumed run may change in its scene: output, end, and what is said of the results.
#pragma once

#include <string>

namespace vsb::app {

/// The keys that may change, for messages.
std::string resumable_keys();

/// The first key that may not change and differs between the resolved scene of a checkpoint and that of the
/// run to go on, with both values; empty where there is none.
std::string obstacle_to_resume(const std::string& checkpoint, const std::string& run);

}  // namespace vsb::app
