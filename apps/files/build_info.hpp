// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What this program was built from and for.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace vsb::app {

/// (name, value): version, commit, compiler, build type, kokkos, backend, instruction set.
const std::vector<std::pair<std::string, std::string>>& build_info();

}  // namespace vsb::app
