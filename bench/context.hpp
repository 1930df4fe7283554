// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What the benchmarks print, and write into their JSON, about where they ran.
#pragma once

#include <string>

namespace vsb::bench {

/// Adds version, commit, compiler, flags, processor and the given backend and threads to the context.
void add_context(const std::string& backend, int threads);

}  // namespace vsb::bench
