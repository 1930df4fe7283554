// SPDX-License-Identifier: BSD-3-Clause
#include "study/read_study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <set>

#include "engine/build_info.hpp"
#include "report/summary.hpp"
#include "scene/toml_reader.hpp"
#include "study/random_body.hpp"
#include "study/study_keys.hpp"

namespace vsb::app {

namespace fs = std::filesystem;

namespace {

/// What cases inherit from their series, and series from the study.
struct Inherited {
  std::string scene, source, sweep;
  std::vector<std::string> set;
  std::optional<double> tolerance;
  bool expect_static = true;
  Solution solution = Solution::steps;
};

std::vector<std::string> read_set(TableReader& r, const Key& key) {
  std::vector<std::string> set;
  const auto* node = r.node(key);
  if (!node) return set;
  const char* what = "must be an array of overrides such as \"time.kappa=0.1\"";
  if (!node->is_array()) r.fail(key, what);
  for (const auto& item : *node->as_array()) {
    if (!item.is_string()) r.fail(item, key.name, what);
    set.push_back(item.as_string()->get());
  }
  return set;
}

/// static = true or balance = true; the innermost counts.
Solution read_solution(TableReader& r, const InheritedKeys& keys, Solution outer) {
  const bool is_static = r.read(keys.static_solution, outer == Solution::static_state);
  const bool is_balance = r.read(keys.balance, outer == Solution::balance);
  if (is_static && is_balance && r.has(keys.static_solution) && r.has(keys.balance))
    r.fail(keys.balance, "give either static = true or balance = true, not both");
  if (is_static && is_balance)
    return r.has(keys.static_solution) ? Solution::static_state : Solution::balance;
  return is_static ? Solution::static_state : is_balance ? Solution::balance : Solution::steps;
}

/// Reads the keys that a table may change for everything inside it.
Inherited read_inherited(TableReader& r, const InheritedKeys& keys, Inherited outer, const fs::path& folder) {
  if (const auto* node = r.node(keys.scene)) {
    if (!node->is_string()) r.fail(keys.scene, "must be the path of a scene file");
    outer.scene = (folder / node->as_string()->get()).lexically_normal().string();
    if (!fs::exists(outer.scene)) r.fail(keys.scene, fmt::format("there is no file {}", outer.scene));
  }
  outer.source = r.read(keys.source, outer.source);
  outer.expect_static = r.read(keys.expect_static, outer.expect_static);
  outer.solution = read_solution(r, keys, outer.solution);
  if (r.has(keys.tolerance)) outer.tolerance = r.read(keys.tolerance);
  const auto set = read_set(r, keys.set);
  outer.set.insert(outer.set.end(), set.begin(), set.end());
  return outer;
}

void set_limits(Expectation& e, double value, double tolerance) {
  e.value = value;
  e.tolerance = tolerance;
  e.lowest = value - tolerance * std::abs(value);
  e.highest = value + tolerance * std::abs(value);
}

/// A number, or a table with either value and tolerance, or lowest and/or highest.
Expectation read_expectation(TableReader& parent, const ExpectationKey& key, const Inherited& inherited) {
  const auto& keys = expectation_keys;
  const char* zero = "a relative tolerance of zero means nothing; give lowest and highest";
  Expectation e;
  e.source = inherited.source;
  if (!parent.written(key)->is_table()) {
    const double value = parent.read(key);
    if (!inherited.tolerance)
      parent.fail(key, "needs a tolerance: write tolerance = ... here, in the series or in the study");
    if (value == 0 && *inherited.tolerance > 0) parent.fail(key, zero);
    set_limits(e, value, *inherited.tolerance);
    return e;
  }
  TableReader r = parent.table(key);
  e.source = r.read(keys.source, e.source);
  if (r.has(keys.lowest) || r.has(keys.highest)) {
    for (const Key* other : KeyList{&keys.value, &keys.tolerance})
      if (r.has(*other)) r.fail(*other, "give either value and tolerance, or lowest and highest");
    if (r.has(keys.lowest)) e.lowest = r.read(keys.lowest);
    if (r.has(keys.highest)) e.highest = r.read(keys.highest.within(Range::at_least(e.lowest)));
  } else {
    const double value = r.read(keys.value);
    const double tolerance = r.read(keys.tolerance, inherited.tolerance);
    if (value == 0 && tolerance > 0) r.fail(keys.value, zero);
    set_limits(e, value, tolerance);
  }
  r.finish();
  return e;
}

void check_figure(const TableReader& r, const toml::node& at, const std::string& name,
                  const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) == known.end())
    r.fail(at, name,
           fmt::format("the scene gives no such figure{} (it gives {})", did_you_mean(name, known),
                       fmt::join(known, ", ")));
}

/// Letters, digits and dots of a text; everything else becomes one dash.
std::string slug(const std::string& text) {
  std::string out;
  for (const unsigned char c : text)
    if (std::isalnum(c) || c == '.')
      out += static_cast<char>(std::tolower(c));
    else if (!out.empty() && out.back() != '-')
      out += '-';
  while (!out.empty() && out.back() == '-') out.pop_back();
  return out;
}

class StudyReader {
 public:
  StudyReader(std::string path, bool fine) : path_(std::move(path)), fine_(fine) {}

  Study read() {
    const toml::table document = parse_scene_file(path_, {});
    ResolvedTable resolved;
    const auto& keys = study_keys;
    TableReader r(document, "", resolved, keys);
    study_.name = fs::path(path_).stem().string();
    study_.title = r.read(keys.title);
    study_.published_source = r.read(keys.published_source);
    read_axis(r);
    study_.rates = r.read(keys.rates, study_.axis.log);
    if (study_.rates && !study_.axis.log)
      r.fail(keys.rates, "rates need a logarithmic axis (axis.log = true)");
    const auto inherited = read_inherited(r, keys.inherited, {}, folder());
    auto series = r.tables(keys.series);
    if (series.empty()) r.missing(keys.series, "at least one table [[series]]");
    for (auto& table : series) read_series(table, inherited);
    for (auto& table : r.tables(keys.relation)) read_relation(table, inherited);
    for (auto& table : r.tables(keys.statistic)) read_statistic(table, inherited);
    if (r.has(keys.chart)) read_chart(r.table(keys.chart));
    if (r.has(keys.target)) read_target(r.table(keys.target));
    r.finish();
    leave_out_fine_cases();
    refuse_without_figures();
    return std::move(study_);
  }

 private:
  fs::path folder() const { return fs::path(path_).parent_path(); }

  void read_axis(TableReader& document) {
    const auto& keys = axis_keys;
    if (!document.has(study_keys.axis))
      document.missing(study_keys.axis, "a table with name, and unit, log or labels");
    TableReader r = document.table(study_keys.axis);
    study_.axis.name = r.read(keys.name);
    study_.axis.labels = r.read(keys.labels);
    if (!study_.axis.labels) {
      study_.axis.unit = r.read(keys.unit);
      study_.axis.log = r.read(keys.log);
    }
    r.finish();
  }

  void read_series(TableReader& r, const Inherited& study) {
    const auto& keys = series_keys;
    StudySeries series;
    series.name = r.read(keys.name);
    if (slug(series.name).empty()) r.fail(keys.name, "must have a letter or a digit");
    for (const auto& other : study_.series)
      if (slug(other.name) == slug(series.name))
        r.fail(keys.name, "another series has this name, or one whose directories would be the same");
    Inherited inherited = read_inherited(r, keys.inherited, study, folder());
    if (r.has(keys.random_bodies)) {
      draw_cases(r, series, inherited);
    } else {
      inherited.sweep = r.read(keys.sweep);
      auto cases = r.tables(keys.cases);
      if (cases.empty()) r.missing(keys.cases, "at least one table [[series.case]], or random_bodies");
      for (auto& table : cases) read_case(table, series, inherited);
    }
    r.finish();
    study_.series.push_back(std::move(series));
  }

  static RandomBodies read_random_bodies(TableReader r) {
    RandomBodies bodies;
    bodies.count = static_cast<int>(r.read(random_bodies_keys.count));
    bodies.first_seed = r.read(random_bodies_keys.first_seed);
    bodies.half_width = r.read(random_bodies_keys.half_width);
    r.finish();
    return bodies;
  }

  /// A case for each seed, which is its value on the axis.
  void draw_cases(TableReader& r, StudySeries& series, const Inherited& inherited) const {
    const auto& keys = series_keys;
    const auto& at = *r.written(keys.random_bodies);
    for (const Key* key : KeyList{&keys.cases, &keys.sweep})
      if (r.has(*key)) r.fail(*key, "give either cases or random_bodies, not both");
    if (study_.axis.labels)
      r.fail(keys.random_bodies, "are numbered by their seeds: the axis must not have labels");
    if (inherited.scene.empty())
      r.missing(keys.inherited.scene, "the path of a scene file, here or in the study");
    const auto bodies = read_random_bodies(r.table(keys.random_bodies));
    series.drawn = true;
    StudyCase c;
    c.expect_static = inherited.expect_static;
    c.solution = inherited.solution;
    read_case_scene(at, c, inherited);
    const Scene base = *c.scene;
    if (const auto why = why_no_random_body(base); !why.empty()) r.fail(keys.random_bodies, why);
    for (int k = 0; k < bodies.count; ++k) {
      const long long seed = bodies.first_seed + k;
      c.text = std::to_string(seed);
      c.axis = static_cast<double>(seed);
      c.directory = fmt::format("cases/{}_{}", slug(series.name), seed);
      Inherited drawn = inherited;
      const auto overrides = random_body(base, seed, bodies.half_width);
      drawn.set.insert(drawn.set.end(), overrides.begin(), overrides.end());
      read_case_scene(at, c, drawn);
      series.cases.push_back(c);
    }
  }

  /// The key by which cases have their value on the axis.
  const Key& axis_key(const AxisValueKeys& keys) const {
    return study_.axis.labels ? static_cast<const Key&>(keys.label) : keys.axis;
  }

  /// The case's value on the axis, written axis = number or label = "text".
  const toml::node& read_axis_value(TableReader& r, const AxisValueKeys& keys, StudyCase& c,
                                    size_t label_count) const {
    if (study_.axis.labels) {
      c.text = r.read(keys.label);
      c.axis = static_cast<double>(label_count);
      if (slug(c.text).empty()) r.fail(keys.label, "must have a letter or a digit");
    } else {
      c.axis = r.read(study_.axis.log ? keys.axis.within(Range::positive()) : keys.axis);
      c.text = inline_toml(*r.written(keys.axis));
    }
    return *r.written(axis_key(keys));
  }

  void read_case(TableReader& r, StudySeries& series, const Inherited& outer) {
    const auto& keys = case_keys;
    StudyCase c;
    const auto& axis_value = read_axis_value(r, keys.axis_value, c, series.cases.size());
    const char* sign = !study_.axis.labels && c.axis < 0 ? "minus-" : "";  // which slug leaves out
    c.directory = fmt::format("cases/{}_{}{}", slug(series.name), sign, slug(c.text));
    for (const auto& other : series.cases)
      if (other.directory == c.directory || (!study_.axis.labels && other.axis == c.axis))
        r.fail(axis_key(keys.axis_value), "the series has this case already");
    c.fine = r.read(keys.fine);
    Inherited inherited = outer;
    if (!outer.sweep.empty()) inherited.set.push_back(outer.sweep + "=" + inline_toml(axis_value));
    inherited = read_inherited(r, keys.inherited, inherited, folder());
    if (inherited.scene.empty())
      r.missing(keys.inherited.scene, "the path of a scene file, here, in the series or in the study");
    c.expected_failure = r.read(keys.expect_failure);
    c.expect_static = inherited.expect_static;
    c.solution = inherited.solution;
    read_case_scene(axis_value, c, inherited);
    read_figures(r, c, inherited);
    r.finish();
    series.cases.push_back(std::move(c));
  }

  static void read_case_scene(const toml::node& axis_value, StudyCase& c, const Inherited& inherited) {
    try {
      c.scene = read_scene(inherited.scene, inherited.set);
    } catch (const SceneError& error) {
      if (c.expected_failure.empty())
        throw SceneError(
            fmt::format("{}: the scene of this case is refused:\n  {}", location(axis_value), error.what()));
      c.reading_failure = error.what();
    }
  }

  /// The figures of the table under a key: read(table, name) takes each.
  template <class Read>
  static void read_figures_of(TableReader& r, const Key& key, const StudyCase& c, const Read& read) {
    if (!r.has(key)) return;
    TableReader figures = r.table(key);
    figures.refuse_empty("a table of figures, such as { e_rr = 0.02 }");
    for (const auto& [name_key, value] : figures.source()) {
      const std::string name(name_key.str());
      if (c.scene) check_figure(figures, value, name, figure_names(*c.scene, c.solution));
      read(figures, name);
    }
    figures.finish();
  }

  static void read_figures(TableReader& r, StudyCase& c, const Inherited& inherited) {
    if (r.has(case_keys.expect) && !c.expected_failure.empty())
      r.fail(case_keys.expect, "a case that is expected to fail has no figures");
    read_figures_of(r, case_keys.expect, c, [&](TableReader& figures, const std::string& name) {
      c.expect[name] = read_expectation(figures, called(expect_keys.figure, name), inherited);
    });
    read_figures_of(r, case_keys.published, c, [&](TableReader& figures, const std::string& name) {
      c.published[name] = figures.read(called(published_figure_keys.figure, name));
    });
  }

  size_t read_series_name(TableReader& r, const TextKey& key) const {
    const auto name = r.read(key);
    for (size_t s = 0; s < study_.series.size(); ++s)
      if (study_.series[s].name == name) return s;
    r.fail(key, "there is no series of this name");
  }

  Relation::CaseOf read_case_of(TableReader& relation, const SubtableKey& key,
                                const std::string& figure) const {
    const auto& keys = related_case_keys;
    if (!relation.has(key)) relation.missing(key, "a case: { series = ..., axis = ... (or label) }");
    TableReader r = relation.table(key);
    Relation::CaseOf reference;
    reference.series = read_series_name(r, keys.series);
    StudyCase wanted;
    read_axis_value(r, keys.axis_value, wanted, 0);
    r.finish();
    const auto& cases = study_.series[reference.series].cases;
    const auto same = [&](const StudyCase& c) {
      return study_.axis.labels ? c.text == wanted.text : c.axis == wanted.axis;
    };
    reference.index = static_cast<size_t>(std::find_if(cases.begin(), cases.end(), same) - cases.begin());
    const auto& where = axis_key(keys.axis_value);
    if (reference.index == cases.size()) r.fail(where, "the series has no such case");
    if (!cases[reference.index].expected_failure.empty()) r.fail(where, "this case is expected to fail");
    const auto& c = cases[reference.index];
    check_figure(relation, *relation.written(relation_keys.figure), figure,
                 figure_names(*c.scene, c.solution));
    return reference;
  }

  /// The expectation under the only one of three keys that is there; returns which.
  static size_t read_one_of(TableReader& r, const std::array<const ExpectationKey*, 3>& kinds,
                            const TextKey& source, Inherited inherited, Expectation& expectation) {
    inherited.source = r.read(source, inherited.source);
    size_t which = 0, found = 0;
    for (size_t k = 0; k < kinds.size(); ++k) {
      if (!r.has(*kinds[k])) continue;
      ++found;
      which = k;
      expectation = read_expectation(r, *kinds[k], inherited);
    }
    if (found != 1)
      r.missing(*kinds[0],
                fmt::format("exactly one of {}, {} and {}", kinds[0]->name, kinds[1]->name, kinds[2]->name));
    return which;
  }

  void read_relation(TableReader& r, const Inherited& study) {
    const auto& keys = relation_keys;
    Relation relation;
    relation.title = r.read(keys.title);
    relation.figure = r.read(keys.figure);
    relation.first = read_case_of(r, keys.first, relation.figure);
    relation.second = read_case_of(r, keys.second, relation.figure);
    relation.kind = static_cast<Relation::Kind>(read_one_of(r, {&keys.ratio, &keys.difference, &keys.rate},
                                                            keys.source, study, relation.expectation));
    if (relation.kind == Relation::Kind::rate && !study_.axis.log)
      r.fail(keys.rate, "rates need a logarithmic axis (axis.log = true)");
    r.finish();
    study_.relations.push_back(std::move(relation));
  }

  void read_statistic(TableReader& r, const Inherited& study) {
    const auto& keys = statistic_keys;
    Statistic statistic;
    statistic.title = r.read(keys.title);
    statistic.figure = r.read(keys.figure);
    statistic.series = read_series_name(r, keys.series);
    for (const auto& c : study_.series[statistic.series].cases)
      if (c.expected_failure.empty())
        check_figure(r, *r.written(keys.figure), statistic.figure, figure_names(*c.scene, c.solution));
    statistic.kind = static_cast<Statistic::Kind>(read_one_of(
        r, {&keys.largest, &keys.smallest, &keys.median}, keys.source, study, statistic.expectation));
    r.finish();
    study_.statistics.push_back(std::move(statistic));
  }

  /// What names_of(case) gives for all cases with a scene, each name once.
  template <class NamesOf>
  std::vector<std::string> names_of_cases(const NamesOf& names_of) const {
    std::vector<std::string> names;
    for (const auto& series : study_.series)
      for (const auto& c : series.cases)
        if (c.scene)
          for (const auto& name : names_of(c))
            if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    return names;
  }

  static std::vector<std::string> figures_of(TableReader& r, const WordsKey& key,
                                             const std::vector<std::string>& known) {
    auto figures = r.words(key, known);
    if (figures.empty()) r.fail(key, fmt::format("must name a figure: one of {}", fmt::join(known, ", ")));
    return figures;
  }

  void read_chart(TableReader r) {
    const auto known = names_of_cases([](const StudyCase& c) { return figure_names(*c.scene, c.solution); });
    Chart chart;
    chart.figures = figures_of(r, chart_keys.figures, known);
    chart.distribution = r.read(chart_keys.distribution);
    chart.log = r.read(chart_keys.log);
    r.finish();
    study_.chart = chart;
  }

  void read_target(TableReader r) {
    const auto known = names_of_cases([](const StudyCase& c) { return error_names(*c.scene); });
    Target target;
    if (known.empty())
      r.missing(target_keys.figures,
                "errors of a scene: no scene of this study is compared with an exact solution");
    target.figures = figures_of(r, target_keys.figures, known);
    target.level = r.read(target_keys.level);
    r.finish();
    study_.target = target;
  }

  /// Takes out what only --fine runs. Relations refer to the same cases afterwards, so these move first.
  void leave_out_fine_cases() {
    if (fine_) return;
    auto& relations = study_.relations;
    const auto of = [&](const Relation::CaseOf& p) { return study_.series[p.series].cases[p.index]; };
    relations.erase(std::remove_if(relations.begin(), relations.end(),
                                   [&](const Relation& r) { return of(r.first).fine || of(r.second).fine; }),
                    relations.end());
    for (auto& relation : relations)
      for (auto* reference : {&relation.first, &relation.second}) {
        const auto& cases = study_.series[reference->series].cases;
        reference->index -= static_cast<size_t>(
            std::count_if(cases.begin(), cases.begin() + static_cast<std::ptrdiff_t>(reference->index),
                          [](const StudyCase& c) { return c.fine; }));
      }
    for (auto& series : study_.series)
      series.cases.erase(
          std::remove_if(series.cases.begin(), series.cases.end(), [](const StudyCase& c) { return c.fine; }),
          series.cases.end());
    auto& statistics = study_.statistics;
    statistics.erase(
        std::remove_if(statistics.begin(), statistics.end(),
                       [&](const Statistic& s) { return study_.series[s.series].cases.empty(); }),
        statistics.end());
  }

  /// Refuses a study without a case to run, and a chart of which no case that runs has the figures.
  void refuse_without_figures() const {
    const auto runs = [](const StudySeries& s) { return !s.cases.empty(); };
    if (std::none_of(study_.series.begin(), study_.series.end(), runs))
      throw SceneError(fmt::format("{}: every case is marked fine; give --fine", path_));
    if (!study_.chart) return;
    const auto known = names_of_cases([](const StudyCase& c) {
      return c.expected_failure.empty() ? figure_names(*c.scene, c.solution) : std::vector<std::string>();
    });
    for (const auto& figure : study_.chart->figures)
      if (std::find(known.begin(), known.end(), figure) != known.end()) return;
    throw SceneError(
        fmt::format("{}: chart.figures = [{}]: no case that is run, and not expected to fail, gives "
                    "one of them",
                    path_, fmt::join(study_.chart->figures, ", ")));
  }

  std::string path_;
  bool fine_;
  Study study_;
};

}  // namespace

std::string find_study(const std::string& name_or_path) {
  if (name_or_path.find('/') != std::string::npos || fs::path(name_or_path).extension() == ".toml")
    return name_or_path;
  const fs::path folder = fs::path(apps_directory()) / "studies";
  const fs::path file = folder / (name_or_path + ".toml");
  if (fs::exists(file)) return file.string();
  std::set<std::string> known;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == ".toml") known.insert(entry.path().stem().string());
  throw SceneError(fmt::format(
      "there is no study '{}' in {}{} (there are {}); a file is given with its path", name_or_path,
      folder.string(), did_you_mean(name_or_path, {known.begin(), known.end()}), fmt::join(known, ", ")));
}

Study read_study(const std::string& path, bool fine) {
  return StudyReader(path, fine).read();
}

}  // namespace vsb::app
