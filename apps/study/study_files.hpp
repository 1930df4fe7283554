// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What a study leaves behind beside its cases' directories: NAME.csv, one line per case and figure, and
/// NAME.json, what a drawing needs to know of it. Both are documented in apps/studies/README.md.
#pragma once

#include <string>
#include <vector>

#include "study/judge.hpp"

namespace vsb::app {

/// A case that has been run, or a relation (record.state is of no meaning then).
struct StudyRow {
  std::string series, text;
  std::string directory;  ///< empty for relations
  CaseRecord record;
  std::vector<StudyLine> lines;
};

/// Writes DIRECTORY/NAME.csv and NAME.json. Throws FileError.
void write_study_files(const std::string& directory, const Study& study, const std::vector<StudyRow>& rows);

}  // namespace vsb::app
