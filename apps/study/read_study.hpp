// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Reads studies, as strictly as scenes are read. The format is documented in apps/studies/README.md.
#pragma once

#include <string>

#include "study/study.hpp"

namespace vsb::app {

/// The file of a study given by name (one of apps/studies) or by path. Throws SceneError with the known
/// names.
std::string find_study(const std::string& name_or_path);

/// Reads the study with all its scenes; cases marked fine only where `fine` is set. Throws SceneError.
Study read_study(const std::string& path, bool fine);

}  // namespace vsb::app
