// SPDX-License-Identifier: BSD-3-Clause
#include "study/run_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "files/directory_lock.hpp"
#include "report/progress.hpp"
#include "run/interrupt.hpp"
#include "scene/toml_reader.hpp"
#include "study/case_record.hpp"
#include "study/draw_study.hpp"
#include "study/judge.hpp"
#include "study/study_files.hpp"

namespace vsb::app {

namespace {

using Clock = std::chrono::steady_clock;

/// Particles of a scene; 0 where it cannot be set up, which its run will tell.
int particles_of(const StudyCase& c) {
  if (!c.scene) return 0;
  try {
    return count_particles(*c.scene);
  } catch (const SetupError&) {
    return 0;
  }
}

std::string number(double x) {
  return x == std::floor(x) && std::abs(x) < 1e9 ? fmt::format("{:.0f}", x) : fmt::format("{:.4e}", x);
}

std::string expected_text(const Expectation& e) {
  if (e.value) {
    std::string text = "expected " + number(*e.value);
    if (*e.tolerance > 0) text += fmt::format(" +- {:.3g} %", 100 * *e.tolerance);
    return text;
  }
  if (std::isinf(e.lowest)) return "expected <= " + number(e.highest);
  if (std::isinf(e.highest)) return "expected >= " + number(e.lowest);
  return fmt::format("expected {} to {}", number(e.lowest), number(e.highest));
}

std::string line_text(const StudyLine& line, const std::string& published_source) {
  const char* verdict = !line.judged ? "" : line.passed ? "pass" : "FAIL";
  if (line.figure == "outcome") return fmt::format("  {:<5}outcome: {}\n", verdict, line.note);
  std::string text =
      fmt::format("  {:<5}{:<14}{:>12}", verdict, line.figure, line.value ? number(*line.value) : "-");
  const auto deviation = line.deviation();
  std::string beside = line.judged ? expected_text(line.expectation) : "";
  if (deviation) beside += fmt::format(" ({:+.2f} %)", percent_above(1 + *deviation));
  text += fmt::format("  {:<42}", beside);
  if (line.difference) text += fmt::format("  difference {:>11}", number(*line.difference));
  if (line.rate) text += fmt::format("  rate {:5.2f}", *line.rate);
  if (line.extrapolated) text += fmt::format("  extrapolated {}", number(*line.extrapolated));
  if (line.published) text += fmt::format("  {} {}", published_source, number(*line.published));
  if (!line.note.empty()) text += "  " + line.note;
  text.erase(text.find_last_not_of(' ') + 1);
  return text + "\n";
}

/// A case, and what is known of it.
struct Task {
  size_t series, index;
  int particles = 0;
  std::optional<CaseRecord> record;  ///< of an earlier call, or of this one

  bool done() const { return record && record->state != CaseRecord::State::running; }
};

class StudyRun {
 public:
  StudyRun(const Study& study, const StudyOptions& options) : study_(study), options_(options) {
    for (size_t s = 0; s < study.series.size(); ++s)
      for (size_t i = 0; i < study.series[s].cases.size(); ++i) {
        Task task{s, i, particles_of(study.series[s].cases[i]), {}};
        const auto& c = case_of(task);
        if (c.scene) task.record = read_case_record(directory_of(c), record_subject(*c.scene, c.solution));
        tasks_.push_back(std::move(task));
      }
  }

  ExitCode run() {
    const InterruptGuard guard;
    const DirectoryLock lock(options_.directory);
    say("{}: {} cases, results in {}\n", study_.title, tasks_.size(), options_.directory);
    for (size_t t = 0; t < tasks_.size(); ++t) {
      const bool earlier = tasks_[t].done();
      const bool drawn = study_.series[tasks_[t].series].drawn;
      if (!drawn) announce(t, earlier);
      if (drawn && tasks_[t].index == 0) announce_drawn(t);
      if (!earlier)
        if (const ExitCode code = make(tasks_[t]); code != exit_done)
          return code == exit_interrupted ? interrupted() : code;
      add_row(tasks_[t]);
      print_lines(rows_.back(), drawn);
      if (!earlier) write_study_files(options_.directory, study_, rows_);
      if (interrupt_requested()) return interrupted();
    }
    judge_relations();
    judge_statistics();
    add_target();
    write_study_files(options_.directory, study_, rows_);
    const std::string table = options_.directory + "/" + study_.name + ".csv";
    say("table {}\n", table);
    const std::string problem = study_.has_figures() ? draw_study(table, options_.quiet) : "";
    if (!problem.empty()) fmt::print(stderr, "vsb: no pictures: {}\n", problem);
    return conclude();
  }

 private:
  const StudyCase& case_of(const Task& t) const { return study_.series[t.series].cases[t.index]; }
  std::string directory_of(const StudyCase& c) const { return options_.directory + "/" + c.directory; }

  template <class... Arguments>
  void say(fmt::format_string<Arguments...> text, Arguments&&... arguments) const {
    if (!options_.quiet) fmt::print(text, std::forward<Arguments>(arguments)...);
  }

  std::string title_of(const Task& t) const {
    const auto& c = case_of(t);
    std::string case_text = c.text;
    if (!study_.axis.labels) case_text = fmt::format("{} = {}", study_.axis.name, c.text);
    if (!study_.axis.unit.empty()) case_text += " " + study_.axis.unit;
    return fmt::format("{}, {}", study_.series[t.series].name, case_text);
  }

  void announce(size_t t, bool earlier) const {
    std::string times = earlier ? "done before" : fmt::format("{} used", duration_text(seconds()));
    if (const auto left = earlier ? std::nullopt : seconds_left(t))
      times += ", about " + duration_text(*left) + " left";
    say("case {} of {}: {} ({} particles; {})\n", t + 1, tasks_.size(), title_of(tasks_[t]),
        tasks_[t].particles, times);
  }

  /// All cases of a series at once: there are many, and each is short.
  void announce_drawn(size_t first) const {
    const auto count = study_.series[tasks_[first].series].cases.size();
    const auto done = std::count_if(tasks_.begin() + static_cast<std::ptrdiff_t>(first),
                                    tasks_.begin() + static_cast<std::ptrdiff_t>(first + count),
                                    [](const Task& task) { return task.done(); });
    say("cases {} to {} of {}: {} ({} done before; {} used)\n", first + 1, first + count, tasks_.size(),
        study_.series[tasks_[first].series].name, done, duration_text(seconds()));
  }

  double seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

  /// Foreseen from the cases done: their time per particle and step, and the physical time at which runs
  /// until static ended.
  std::optional<double> seconds_left(size_t first) const {
    double cost = 0, work = 0, end_time = 0;
    int ended = 0;
    for (const auto& task : tasks_) {
      if (!task.done() || task.record->state != CaseRecord::State::finished) continue;
      if (case_of(task).solution != Solution::steps) continue;  // next to nothing
      cost += task.record->total_seconds();
      work += task.record->particle_steps();
      if (!case_of(task).scene->time.until_static) continue;
      end_time += task.record->end_time;
      ++ended;
    }
    if (work <= 0) return {};
    double left = 0;
    for (size_t t = first; t < tasks_.size(); ++t) {
      const auto& c = case_of(tasks_[t]);
      if (tasks_[t].done() || !c.scene || c.solution != Solution::steps) continue;
      const auto& time = c.scene->time;
      auto steps = static_cast<double>(time.steps);
      if (time.until_static) {
        if (ended == 0) return {};
        steps = std::min(steps, end_time / ended / time.dt);
      }
      left += steps * tasks_[t].particles * cost / work;
    }
    return left;
  }

  /// Runs a case that is not done.
  ExitCode make(Task& task) {
    const auto& c = case_of(task);
    if (!c.scene) {
      task.record = CaseRecord{CaseRecord::State::failed, c.reading_failure, 0, 0, 0, 0, 0, 0, "", {}};
      return exit_done;
    }
    RunOptions run;
    run.directory = directory_of(c);
    run.quiet = options_.quiet;
    run.progress_only = true;
    run.solution = c.solution;
    run.resume = c.solution == Solution::steps &&
                 task.record.has_value();  // it was begun by this program, on this scene
    CaseRecord record = run.resume ? *task.record : CaseRecord{};
    record.particles = task.particles;
    const auto result = run_case(*c.scene, run, record, options_.run);
    task.record = result.record;
    return result.code;
  }

  void add_row(const Task& task) {
    const auto& series = study_.series[task.series];
    std::vector<const CaseRecord*> records;
    for (size_t i = 0; i <= task.index; ++i) records.push_back(&*find(task.series, i).record);
    rows_.push_back({series.name, case_of(task).text, case_of(task).directory, *task.record,
                     judge_case(study_, series, records)});
  }

  const Task& find(size_t series, size_t index) const {
    return *std::find_if(tasks_.begin(), tasks_.end(),
                         [&](const Task& t) { return t.series == series && t.index == index; });
  }

  void judge_relations() {
    for (const auto& relation : study_.relations) {
      const auto& first = *find(relation.first.series, relation.first.index).record;
      const auto& second = *find(relation.second.series, relation.second.index).record;
      rows_.push_back(
          {"relation", relation.title, "", {}, {judge_relation(study_, relation, first, second)}});
      say("{}\n", relation.title);
      print_lines(rows_.back());
    }
  }

  std::vector<const CaseRecord*> records_of(size_t series) const {
    std::vector<const CaseRecord*> records;
    for (const auto& task : tasks_)
      if (task.series == series) records.push_back(&*task.record);
    return records;
  }

  void judge_statistics() {
    for (const auto& statistic : study_.statistics) {
      rows_.push_back({"statistic",
                       statistic.title,
                       "",
                       {},
                       {judge_statistic(study_, statistic, records_of(statistic.series))}});
      say("{}\n", statistic.title);
      print_lines(rows_.back());
    }
  }

  void add_target() {
    if (!study_.target) return;
    for (size_t s = 0; s < study_.series.size(); ++s) {
      rows_.push_back({"target", study_.series[s].name, "", {}, target_lines(*study_.target, records_of(s))});
      say("{}\n", study_.series[s].name);
      print_lines(rows_.back());
    }
  }

  void print_lines(const StudyRow& row, bool only_failures = false) const {
    for (const auto& line : row.lines)
      if (!only_failures || (line.judged && !line.passed))
        say("{}", line_text(line, study_.published_source));
  }

  /// The failing lines once more, and the count.
  ExitCode conclude() const {
    int passed = 0, failed = 0;
    for (const auto& row : rows_)
      for (const auto& line : row.lines) {
        passed += line.judged && line.passed;
        if (!line.judged || line.passed) continue;
        ++failed;
        fmt::print("{}, {}:{}", row.series, row.text, line_text(line, study_.published_source));
      }
    say("{}: {} pass, {} fail; {} used\n", study_.name, passed, failed, duration_text(seconds()));
    return failed == 0 ? exit_done : exit_study_failed;
  }

  ExitCode interrupted() const {
    fmt::print("interrupted; the same command goes on from here\n");
    return exit_interrupted;
  }

  const Study& study_;
  const StudyOptions& options_;
  std::vector<Task> tasks_;
  std::vector<StudyRow> rows_;
  Clock::time_point begin_ = Clock::now();
};

}  // namespace

ExitCode run_study(const Study& study, const StudyOptions& options) {
  return StudyRun(study, options).run();
}

}  // namespace vsb::app
