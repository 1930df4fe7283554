// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The lines of a study: every figure of every case beside what is expected and what is published.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/case_record.hpp"
#include "study/study.hpp"

namespace vsb::app {

/// One line of a study's table.
struct StudyLine {
  std::string figure;  ///< its name; "outcome" where the case gave none, or should not
  std::optional<double> value;
  /// Of an error against the case before in the series; of another figure from the differences between this
  /// case and the two before it, see study/convergence.hpp.
  std::optional<double> rate;
  std::optional<double> difference;    ///< from the case before; of figures that are no errors
  std::optional<double> extrapolated;  ///< to h = 0, from the same three cases as the rate
  Expectation expectation;
  bool judged = false, passed = false;
  std::optional<double> published;
  std::string note;

  /// Relative deviation from the expected value; none where there is no such value, or it is zero.
  std::optional<double> deviation() const;
};

/// The lines of one case. `records` are those of the series' cases up to this one.
std::vector<StudyLine> judge_case(const Study& study, const StudySeries& series,
                                  const std::vector<const CaseRecord*>& records);

/// The line of a relation; figures that a case did not give make it fail.
StudyLine judge_relation(const Study& study, const Relation& relation, const CaseRecord& first,
                         const CaseRecord& second);

/// The line of a statistic of the cases of a series; a case without the figure makes it fail.
StudyLine judge_statistic(const Study& study, const Statistic& statistic,
                          const std::vector<const CaseRecord*>& records);

/// The seconds and the particle-steps that a series needs to bring the figures of study.target to their
/// level: interpolated between cases, error against cost on logarithmic scales, or extrapolated from the last
/// two. `records` are those of its cases. Lines without a value where the error does not fall.
std::vector<StudyLine> target_lines(const Target& target, const std::vector<const CaseRecord*>& records);

}  // namespace vsb::app
