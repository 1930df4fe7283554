// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What the benchmarks print, and write into their JSON, about where they ran.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace vsb::bench {

/// Version, commit, compiler, flags, processor and the given backend and threads, each with its name.
std::vector<std::pair<std::string, std::string>> describe_build(const std::string& backend, int threads);

}  // namespace vsb::bench
