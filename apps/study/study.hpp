// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A study: series of cases, each a scene with overrides, and what every case is expected to give. Plain
/// data.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "report/solution.hpp"
#include "scene/scene.hpp"

namespace vsb::app {

/// What a figure should be: any finite number in [lowest, highest].
struct Expectation {
  std::optional<double> value;      ///< the expected figure, where the limits come from value and tolerance
  std::optional<double> tolerance;  ///< relative
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
  std::string source;
};

struct StudyCase {
  std::string text;       ///< the value on the axis as written, or the label
  double axis = 0;        ///< the value on the axis; of labels the number
  std::string directory;  ///< of its results, relative to the study's
  bool fine = false;
  std::string
      expected_failure;  ///< text of the message with which the scene must be refused; empty: it must run
  Solution solution = Solution::steps;
  bool expect_static = true;                  ///< whether a run until static that does not get there fails
  std::map<std::string, Expectation> expect;  ///< by figure
  std::map<std::string, double> published;    ///< by figure
  std::optional<Scene> scene;                 ///< none where reading it failed as expected
  std::string reading_failure;                ///< the message of that failure
};

struct StudySeries {
  std::string name;
  std::vector<StudyCase> cases;
  bool drawn = false;  ///< of random bodies: many cases, of which nobody wants to read the lines one by one
};

struct StudyAxis {
  std::string name, unit;
  bool log = false;
  bool labels = false;  ///< the cases have labels, not numbers
};

/// An expectation on two cases: on f1/f2, on |f1 - f2|, or on log(f1/f2)/log(axis1/axis2).
struct Relation {
  enum class Kind { ratio, difference, rate };
  std::string title, figure;
  Kind kind = Kind::ratio;
  struct CaseOf {
    size_t series = 0, index = 0;
  } first, second;
  Expectation expectation;
};

/// An expectation on a figure of all cases of a series.
struct Statistic {
  enum class Kind { largest, smallest, median };
  std::string title, figure;
  Kind kind = Kind::largest;
  size_t series = 0;
  Expectation expectation;
};

/// What the charts show, where it is not the errors of the scenes.
struct Chart {
  std::vector<std::string> figures;
  bool distribution = false;  ///< how often which value occurs in a series, in place of values over the axis
  bool log = true;            ///< whether the figures have a logarithmic scale
};

/// What every series needs for its errors to fall to a level, the target.
struct Target {
  std::vector<std::string> figures;
  double level = 0;
};

struct Study {
  std::string name, title, published_source;
  StudyAxis axis;
  bool rates = false;
  std::vector<StudySeries> series;
  std::vector<Relation> relations;
  std::vector<Statistic> statistics;
  std::optional<Chart> chart;
  std::optional<Target> target;

  /// What its charts show: as the study says; else the errors of its scenes; else what scenes without an
  /// exact solution are judged by (report/summary.hpp). Cases that are expected to fail have none.
  std::vector<std::string> figures() const;
  bool has_figures() const { return !figures().empty(); }
};

}  // namespace vsb::app
