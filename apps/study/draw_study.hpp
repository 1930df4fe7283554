// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Has a study's pictures drawn by apps/plot/plot_study.py.
#pragma once

#include <string>

namespace vsb::app {

/// Runs the script on a study's CSV file, with the first python3 that has matplotlib. Returns what went
/// wrong, or nothing: pictures are a convenience, and a study without them is still a result.
std::string draw_study(const std::string& csv_file, bool quiet);

}  // namespace vsb::app
