// SPDX-License-Identifier: BSD-3-Clause
#include "study/study_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "engine/build_info.hpp"
#include "files/hdf5_file.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

namespace {

/// A field of RFC 4180: quoted where it has to be.
std::string csv(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

/// A number with all its digits; nothing where there is none, or no limit.
std::string csv(const std::optional<double>& x) {
  return x && !std::isinf(*x) ? fmt::format("{}", *x) : "";
}

std::string csv_table(const Study& study, const std::vector<StudyRow>& rows) {
  std::string text =
      "study,series,case,figure,value,rate,difference,extrapolated,expected,lowest,highest,deviation,source,"
      "published,verdict,"
      "particles,steps,seconds,particle_steps,ns_per_particle_step,directory,state_hash,note\n";
  for (const auto& row : rows)
    for (const auto& line : row.lines) {
      const auto& e = line.expectation;
      std::vector<std::string> cells = {csv(study.name), csv(row.series), csv(row.text), csv(line.figure),
                                        // unlike elsewhere, infinity is a value here
                                        line.value ? fmt::format("{}", *line.value) : "", csv(line.rate),
                                        csv(line.difference), csv(line.extrapolated), csv(e.value),
                                        line.judged ? csv(e.lowest) : "", line.judged ? csv(e.highest) : "",
                                        csv(line.deviation()), line.judged ? csv(e.source) : "",
                                        csv(line.published),
                                        !line.judged  ? ""
                                        : line.passed ? "pass"
                                                      : "fail"};
      const auto& r = row.record;
      if (r.state == CaseRecord::State::finished)
        cells.insert(
            cells.end(),
            {fmt::format("{}", r.particles), fmt::format("{}", r.steps), fmt::format("{}", r.total_seconds()),
             fmt::format("{}", r.particle_steps()), fmt::format("{}", r.ns_per_particle_step())});
      else
        cells.resize(cells.size() + 5);
      cells.insert(cells.end(), {csv(row.directory), csv(r.state_hash), csv(line.note)});
      text += fmt::format("{}\n", fmt::join(cells, ","));
    }
  return text;
}

std::string json_description(const Study& study) {
  toml::array series, errors;
  std::vector<std::string> names;
  for (const auto& s : study.series) {
    series.push_back(s.name);
    for (const auto& c : s.cases)
      if (c.scene)
        for (const auto& name : error_names(*c.scene))
          if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  for (const auto& name : names) errors.push_back(name);
  // What a scene without an exact solution gives goes to a value of its own, not to zero.
  const Chart chart = study.chart.value_or(Chart{study.figures(), false, !names.empty()});
  toml::array figures;
  for (const auto& name : chart.figures) figures.push_back(name);
  toml::table provenance;
  for (const auto& [name, value] : build_info()) provenance.insert(name, value);
  const toml::table description{
      {"study", study.name},
      {"title", study.title},
      {"axis", toml::table{{"name", study.axis.name},
                           {"unit", study.axis.unit},
                           {"log", study.axis.log},
                           {"labels", study.axis.labels}}},
      {"series", series},
      {"errors", errors},
      {"chart", toml::table{{"figures", figures},
                            {"distribution", chart.distribution},
                            {"log", chart.log},
                            {"cost", !study.chart && !names.empty()}}},
      {"published_source", study.published_source},
      {"provenance", provenance},
  };
  std::ostringstream out;
  out << toml::json_formatter{description} << "\n";
  return out.str();
}

}  // namespace

void write_study_files(const std::string& directory, const Study& study, const std::vector<StudyRow>& rows) {
  write_text_file(directory + "/" + study.name + ".csv", csv_table(study, rows));
  write_text_file(directory + "/" + study.name + ".json", json_description(study));
}

}  // namespace vsb::app
