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

/// The folder apps of the sources, where shipped studies and the drawing scripts lie.
std::string apps_directory();

}  // namespace vsb::app
