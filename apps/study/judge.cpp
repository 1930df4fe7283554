// SPDX-License-Identifier: BSD-3-Clause
#include "study/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/summary.hpp"
#include "study/convergence.hpp"

namespace vsb::app {

namespace {

/// log(f1/f2) / log(x1/x2): 1 for a figure that falls in proportion to x.
std::optional<double> rate_between(double f1, double f2, double x1, double x2) {
  if (!(f1 > 0 && f2 > 0) || x1 == x2) return {};
  return std::log(f1 / f2) / std::log(x1 / x2);
}

void judge(StudyLine& line, const Expectation& expectation) {
  line.expectation = expectation;
  line.judged = true;
  // Comparisons with NaN are false: a figure that is no number fails.
  line.passed = line.value && *line.value >= expectation.lowest && *line.value <= expectation.highest &&
                std::isfinite(*line.value);
}

/// Rate, difference and extrapolated value, as far as the cases before the last of the records have the
/// figure.
void compare_with_before(StudyLine& line, const StudySeries& series,
                         const std::vector<const CaseRecord*>& records) {
  const size_t last = records.size() - 1;
  const auto before = [&](size_t n) {
    return last >= n ? records[last - n]->figure(line.figure) : std::nullopt;
  };
  const auto axis_value = [&](size_t n) { return series.cases[last - n].axis; };
  const auto previous = before(1);
  const auto errors = error_names(*series.cases[last].scene);
  if (!previous || is_count(line.figure)) return;
  if (std::find(errors.begin(), errors.end(), line.figure) != errors.end()) {
    line.rate = rate_between(*previous, *line.value, axis_value(1), axis_value(0));
    return;
  }
  line.difference = *line.value - *previous;
  const auto first = before(2);
  if (!first) return;
  const auto found =
      convergence_of({axis_value(2), axis_value(1), axis_value(0)}, {*first, *previous, *line.value});
  line.rate = found.rate;
  line.extrapolated = found.extrapolated;
  if (!found.note.empty()) line.note += (line.note.empty() ? "" : "; ") + found.note;
}

/// Of a case that should have failed, or did though it should not.
StudyLine outcome_line(const StudyCase& c, const CaseRecord& record) {
  StudyLine line;
  line.figure = "outcome";
  line.judged = true;
  line.note = record.message;
  if (c.expected_failure.empty()) return line;
  line.passed = record.message.find(c.expected_failure) != std::string::npos;
  if (record.message.empty()) line.note = "ran without an error";
  if (!line.passed) line.note += fmt::format(" (expected: {})", c.expected_failure);
  return line;
}

}  // namespace

std::optional<double> StudyLine::deviation() const {
  if (!value || !expectation.value || *expectation.value == 0) return {};
  return *value / *expectation.value - 1;
}

std::vector<StudyLine> judge_case(const Study& study, const StudySeries& series,
                                  const std::vector<const CaseRecord*>& records) {
  const size_t index = records.size() - 1;
  const StudyCase& c = series.cases[index];
  const CaseRecord& record = *records.back();
  std::vector<StudyLine> lines;
  const bool failed = record.state == CaseRecord::State::failed;
  const bool not_static = !failed && !record.message.empty();  // the only message of a case that ended
  if (failed || (not_static && c.expect_static) || !c.expected_failure.empty())
    lines.push_back(outcome_line(c, record));
  if (!c.expected_failure.empty()) return lines;

  auto names = study.chart ? error_names(*c.scene) : default_figures(*c.scene, c.solution);
  const auto add = [&](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const auto& [name, expectation] : c.expect) add(name);
  for (const auto& [name, value] : c.published) add(name);
  if (study.chart)
    for (const auto& name : study.chart->figures)
      if (record.figure(name)) add(name);
  for (const auto& name : names) {
    StudyLine line;
    line.figure = name;
    line.value = record.figure(name);
    line.note = failed ? "" : record.message;
    const auto expected = c.expect.find(name);
    if (expected != c.expect.end()) judge(line, expected->second);
    const auto published = c.published.find(name);
    if (published != c.published.end()) line.published = published->second;
    if (study.rates && line.value) compare_with_before(line, series, records);
    lines.push_back(line);
  }
  return lines;
}

StudyLine judge_statistic(const Study& study, const Statistic& statistic,
                          const std::vector<const CaseRecord*>& records) {
  StudyLine line;
  std::vector<double> values;
  const auto& cases = study.series[statistic.series].cases;
  bool complete = true;
  for (size_t i = 0; i < cases.size(); ++i) {
    if (!cases[i].expected_failure.empty()) continue;
    const auto value = records[i]->figure(statistic.figure);
    complete = complete && value && std::isfinite(*value);
    if (value) values.push_back(*value);
  }
  std::sort(values.begin(), values.end());
  const size_t n = values.size();
  const char* kind = "largest";
  switch (statistic.kind) {
    case Statistic::Kind::largest:
      if (n > 0) line.value = values.back();
      break;
    case Statistic::Kind::smallest:
      kind = "smallest";
      if (n > 0) line.value = values.front();
      break;
    case Statistic::Kind::median:
      kind = "median";
      if (n > 0) line.value = 0.5 * (values[(n - 1) / 2] + values[n / 2]);
      break;
  }
  line.figure = fmt::format("{} {}", kind, statistic.figure);
  line.note = fmt::format("of {} cases", n);
  if (!complete) {
    line.value.reset();
    line.note = "not every case has the figure";
  }
  judge(line, statistic.expectation);
  return line;
}

std::vector<StudyLine> target_lines(const Target& target, const std::vector<const CaseRecord*>& records) {
  struct Case {
    double cost, error;
  };
  std::vector<StudyLine> lines;
  for (const auto& figure : target.figures)
    for (const bool in_seconds : {true, false}) {
      StudyLine line;
      line.figure =
          fmt::format("{} to {} = {:g}", in_seconds ? "seconds" : "particle-steps", figure, target.level);
      std::vector<Case> points;
      for (const auto* record : records) {
        const auto error = record->figure(figure);
        const double cost = in_seconds ? record->total_seconds() : record->particle_steps();
        if (error && *error > 0 && cost > 0) points.push_back({cost, *error});
      }
      std::sort(points.begin(), points.end(), [](const Case& a, const Case& b) { return a.cost < b.cost; });
      const auto enough =
          std::find_if(points.begin(), points.end(), [&](const Case& p) { return p.error <= target.level; });
      if (points.size() < 2) {
        line.note = "needs two cases at least";
      } else if (enough == points.begin()) {
        line.value = enough->cost;
        line.note = "at most: the cheapest case is better already";
      } else {
        const auto after = enough == points.end() ? enough - 1 : enough;
        const auto before = after - 1;
        const double slope = std::log(after->cost / before->cost) / std::log(before->error / after->error);
        if (after->error < before->error)
          line.value = before->cost * std::pow(before->error / target.level, slope);
        line.note = !line.value ? "does not fall" : enough == points.end() ? "extrapolated" : "";
      }
      lines.push_back(line);
    }
  return lines;
}

StudyLine judge_relation(const Study& study, const Relation& relation, const CaseRecord& first,
                         const CaseRecord& second) {
  StudyLine line;
  const auto a = first.figure(relation.figure), b = second.figure(relation.figure);
  const auto axis = [&](const Relation::CaseOf& p) { return study.series[p.series].cases[p.index].axis; };
  const char* kind = "ratio";
  switch (relation.kind) {
    case Relation::Kind::ratio:
      if (a && b) line.value = *a / *b;
      break;
    case Relation::Kind::difference:
      kind = "difference";
      if (a && b) line.value = std::abs(*a - *b);
      break;
    case Relation::Kind::rate:
      kind = "rate";
      if (a && b) line.value = rate_between(*a, *b, axis(relation.first), axis(relation.second));
      break;
  }
  line.figure = fmt::format("{} of {}", kind, relation.figure);
  judge(line, relation.expectation);
  return line;
}

}  // namespace vsb::app
