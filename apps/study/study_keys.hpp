// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The keys of a study.
#pragma once

#include "scene/key.hpp"

namespace vsb::app {

/// What holds for every case inside the table that has them.
struct InheritedKeys {
  KeyTable& table;
  OwnKey scene{table,    "scene",
               "string", in_words("that of the table around"),
               "",       "path of the scene, from the study's file"};
  TextKey source{table, "source", in_words("that of the table around"), "of expected figures"};
  NumberKey tolerance{table,
                      "tolerance",
                      Range::at_least(0),
                      in_words("that of the table around"),
                      "",
                      "relative, of expected figures"};
  OwnKey set{table,
             "set",
             "array of strings `\"KEY=VALUE\"`",
             in_words("none"),
             "",
             "overrides of the scene, as --set of vsb run; added to those of the table around"};
  BooleanKey expect_static{table, "expect_static", in_words("that of the table around, at last `true`"),
                           "whether a run until static that does not get there fails"};
  BooleanKey static_solution{table, "static", in_words("that of the table around, at last `false`"),
                             "cases are solved as by vsb run --static"};
  BooleanKey balance{table, "balance", in_words("that of the table around, at last `false`"),
                     "cases are the balance of the initial state under the final loads, without a step"};
};

struct ExpectationKeys : KeyTable {
  ExpectationKeys()
      : KeyTable("expectation",
                 "What a figure should be: `value` and `tolerance`, or `lowest` and `highest`.") {}
  TextKey source{*this, "source", in_words("that of the table around"), "of the expected figure"};
  NumberKey value{*this, "value", Range::any(), required, "", "the expected figure"};
  NumberKey tolerance{*this, "tolerance", Range::at_least(0), in_words("that of the table around"),
                      "",    "relative"};
  NumberKey lowest{*this, "lowest", Range::any(), in_words("no limit"), "", "the least that passes"};
  NumberKey highest{
      *this, "highest", Range::in_words(">= lowest"), in_words("no limit"), "", "the most that passes"};
};
inline const ExpectationKeys expectation_keys;

/// A number with the tolerance that is inherited, or a table.
struct ExpectationKey : NumberKey {
  ExpectationKey(KeyTable& in, std::string key_name, const InWords& key_preset, std::string key_sentence)
      : NumberKey(in, std::move(key_name), Range::any(), key_preset, "", std::move(key_sentence)) {
    type += ", or a table";
    inside = &expectation_keys;
  }
};

struct AxisKeys : KeyTable {
  AxisKeys() : KeyTable("axis", "What the charts have on their x axis.") {}
  TextKey name{*this, "name", required, "of the axis"};
  BooleanKey labels{*this, "labels", false, "cases have names, not numbers"};
  TextKey unit{*this, "unit", std::string(), "of the numbers"};
  BooleanKey log{*this, "log", false, "a logarithmic axis"};
};
inline const AxisKeys axis_keys;

struct ExpectKeys : KeyTable {
  ExpectKeys()
      : KeyTable("series.case.expect", "What figures of the case should be. The keys are names of figures.") {
    leave_open();
  }
  ExpectationKey figure{*this, "FIGURE", in_words("none"), "any figure that the scene gives"};
};
inline const ExpectKeys expect_keys;

struct PublishedFigureKeys : KeyTable {
  PublishedFigureKeys()
      : KeyTable("series.case.published", "What others say, beside ours. The keys are names of figures.") {
    leave_open();
  }
  NumberKey figure{*this, "FIGURE", Range::any(), in_words("none"), "", "any figure that the scene gives"};
};
inline const PublishedFigureKeys published_figure_keys;

/// Where a case stands on the axis.
struct AxisValueKeys {
  KeyTable& table;
  NumberKey axis{table,        "axis",
                 Range::any(), in_words("required, unless axis.labels"),
                 "",           "the case's value on the axis; > 0 on a logarithmic one"};
  TextKey label{table, "label", in_words("required with axis.labels"), "the case's name"};
};

struct CaseKeys : KeyTable {
  CaseKeys() : KeyTable("series.case", "A run of the scene with overrides.") {}
  AxisValueKeys axis_value{*this};
  BooleanKey fine{*this, "fine", false, "run by --fine alone"};
  InheritedKeys inherited{*this};
  TextKey expect_failure{
      *this, "expect_failure", std::string(),
      "a text of the message with which the scene must be refused, diverge or not be static"};
  SubtableKey expect{*this, "expect", expect_keys, in_words("none"), "what figures should be"};
  SubtableKey published{*this, "published", published_figure_keys, in_words("none"), "figures of others"};
};
inline const CaseKeys case_keys;

struct RandomBodiesKeys : KeyTable {
  RandomBodiesKeys()
      : KeyTable("series.random_bodies",
                 "Cases of bodies drawn at random, each with a seed, which is its value on the axis.") {}
  IntegerKey count{*this, "count", 1, 10'000, required, "", "of the bodies"};
  IntegerKey first_seed{*this, "first_seed", 0, 1'000'000'000, 1, "", "of the first body"};
  NumberKey half_width{*this, "half_width", Range::positive(), required, "m", "of the box in which they lie"};
};
inline const RandomBodiesKeys random_bodies_keys;

struct SeriesKeys : KeyTable {
  SeriesKeys() : KeyTable("series", "Cases that a chart joins by a line.") {}
  TextKey name{*this, "name", required, "in the legend"};
  InheritedKeys inherited{*this};
  TextKey sweep{*this, "sweep", std::string(), "the key of the scene that takes the value on the axis"};
  SubtablesKey cases{*this, "case", case_keys, in_words("required, or `random_bodies`"), "at least one"};
  SubtableKey random_bodies{*this, "random_bodies", random_bodies_keys, in_words("none"),
                            "in place of cases and sweep"};
};
inline const SeriesKeys series_keys;

struct RelatedCaseKeys : KeyTable {
  RelatedCaseKeys() : KeyTable("relation.first", "Which case; the same for `second`.") {}
  TextKey series{*this, "series", required, "its name"};
  AxisValueKeys axis_value{*this};
};
inline const RelatedCaseKeys related_case_keys;

struct RelationKeys : KeyTable {
  RelationKeys()
      : KeyTable("relation",
                 "What a figure of two cases should be: one of `ratio`, `difference` and `rate`.") {}
  TextKey title{*this, "title", required, "in the report"};
  TextKey figure{*this, "figure", required, "of both cases"};
  SubtableKey first{*this, "first", related_case_keys, required, "a case"};
  SubtableKey second{*this, "second", related_case_keys, required, "another one"};
  TextKey source{*this, "source", in_words("that of the study"), "of the expectation"};
  ExpectationKey ratio{*this, "ratio", in_words("none"), "first / second"};
  ExpectationKey difference{*this, "difference", in_words("none"), "absolute"};
  ExpectationKey rate{*this, "rate", in_words("none"),
                      "log(first / second) over that of the values on the axis; for logarithmic axes"};
};
inline const RelationKeys relation_keys;

struct StatisticKeys : KeyTable {
  StatisticKeys()
      : KeyTable(
            "statistic",
            "What a figure of all cases of a series should be: one of `largest`, `smallest` and `median`.") {}
  TextKey title{*this, "title", required, "in the report"};
  TextKey figure{*this, "figure", required, "of every case"};
  TextKey series{*this, "series", required, "its name"};
  TextKey source{*this, "source", in_words("that of the study"), "of the expectation"};
  ExpectationKey largest{*this, "largest", in_words("none"), "of the cases"};
  ExpectationKey smallest{*this, "smallest", in_words("none"), "of the cases"};
  ExpectationKey median{*this, "median", in_words("none"), "of the cases"};
};
inline const StatisticKeys statistic_keys;

struct ChartKeys : KeyTable {
  ChartKeys() : KeyTable("chart", "What the chart shows, if not the errors of the scenes.") {}
  WordsKey figures{*this, "figures", "names of figures", required, "on the y axis"};
  BooleanKey distribution{*this, "distribution", false, "how many cases of a series have which value"};
  BooleanKey log{*this, "log", true, "a logarithmic scale of the figures"};
};
inline const ChartKeys chart_keys;

struct TargetKeys : KeyTable {
  TargetKeys()
      : KeyTable(
            "target",
            "Prints what every series needs for its errors to fall to a level: seconds and particle-steps.") {
  }
  WordsKey figures{*this, "figures", "names of errors", required, "of the scenes"};
  NumberKey level{*this, "level", Range::positive(), required, "", "of the errors"};
};
inline const TargetKeys target_keys;

struct StudyKeys : KeyTable {
  StudyKeys() : KeyTable("", "The keys at the top of the file, and its tables.") {}
  TextKey title{*this, "title", required, "of the charts"};
  InheritedKeys inherited{*this};
  TextKey published_source{*this, "published_source", std::string("published"), "of published figures"};
  BooleanKey rates{*this, "rates", in_words("where the axis is logarithmic"),
                   "prints rates between neighbours of a series; for logarithmic axes"};
  SubtableKey axis{*this, "axis", axis_keys, required, "what the charts have on their x axis"};
  SubtablesKey series{*this, "series", series_keys, required, "at least one"};
  SubtablesKey relation{*this, "relation", relation_keys, in_words("none"), "expectations on two cases"};
  SubtablesKey statistic{*this, "statistic", statistic_keys, in_words("none"),
                         "expectations on all cases of a series"};
  SubtableKey chart{*this, "chart", chart_keys, in_words("errors of the scenes"), "what the chart shows"};
  SubtableKey target{*this, "target", target_keys, in_words("none"), "what a level of the errors costs"};
};
inline const StudyKeys study_keys;

/// apps/studies/keys.md.
std::string study_key_reference();

}  // namespace vsb::app
