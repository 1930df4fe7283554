// SPDX-License-Identifier: BSD-3-Clause
#include "report/stage_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <sstream>

#include "report/progress.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

namespace {

/// Calls visit(name, member) for all that a report has.
template <class Report, class Visit>
void for_each_member(Report& r, const Visit& visit) {
  visit("first_step", r.first_step);
  visit("last_step", r.last_step);
  visit("at_rest", r.at_rest);
  visit("force_ratio", r.force_ratio);
  visit("particles", r.particles);
  visit("failed", r.failed);
  visit("removed", r.removed);
  visit("largest", r.largest);
  visit("yielded", r.yielded);
  visit("seconds", r.seconds);
  visit("rows", r.zone.rows);
  visit("rows_axis", r.zone.rows_axis);
  visit("rows_diagonal", r.zone.rows_diagonal);
  visit("rows_mean", r.zone.rows_mean);
  visit("per_layer", r.zone.per_layer);
  visit("layer_spread", r.zone.layer_spread);
  visit("asymmetry", r.zone.asymmetry);
}

}  // namespace

std::string to_toml(const StagesReport& report) {
  std::string text =
      fmt::format("outcome = {}\nreason = {}\n", quoted(report.outcome), quoted(report.reason));
  for (const auto& stage : report.stages) {
    text += "\n[[stage]]\n";
    for_each_member(
        stage, [&](const char* name, const auto& value) { text += fmt::format("{} = {}\n", name, value); });
  }
  return text;
}

StagesReport stages_of_toml(const std::string& text) {
  const toml::table file = toml::parse(text);
  StagesReport report;
  report.outcome = file["outcome"].value_or(std::string());
  report.reason = file["reason"].value_or(std::string());
  if (const auto* stages = file["stage"].as_array())
    for (const auto& item : *stages)
      if (const auto* table = item.as_table()) {
        auto& stage = report.stages.emplace_back();
        for_each_member(stage,
                        [&](const char* name, auto& value) { value = (*table)[name].value_or(value); });
      }
  return report;
}

std::string stage_text(const StageReport& s, int number, bool with_hole) {
  std::string text =
      fmt::format("stage {}: {} of {} particles beyond the threshold", number, s.failed, s.particles);
  if (with_hole && s.failed > 0)
    text += fmt::format(", depth {:.2f} rows (axis {:.2f}, diagonal {:.2f}, mean {:.2f})", s.zone.rows,
                        s.zone.rows_axis, s.zone.rows_diagonal, s.zone.rows_mean);
  return text + fmt::format("; largest strain {:.3g}, yielded volume {:.4g}; {} {} steps, {}", s.largest,
                            s.yielded, s.at_rest ? "at rest after" : "not at rest after",
                            s.last_step - s.first_step, duration_text(s.seconds));
}

std::vector<std::pair<std::string, double>> stage_figures(const StagesReport& report, int max_stages,
                                                          bool with_hole) {
  const auto at_rest = std::count_if(report.stages.begin(), report.stages.end(),
                                     [](const StageReport& s) { return s.at_rest; });
  std::vector<std::pair<std::string, double>> figures = {
      {"particles_at_start", report.stages.empty() ? 0.0 : report.stages.front().particles},
      {"stages", static_cast<double>(report.stages.size())},
      {"stages_at_rest", static_cast<double>(at_rest)},
      {"collapsed", report.outcome == "collapse" ? 1.0 : 0.0}};
  for (int k = 1; k <= max_stages; ++k) {
    const bool reached = static_cast<size_t>(k) <= report.stages.size();
    const auto stage = reached ? report.stages[static_cast<size_t>(k) - 1] : StageReport{};
    const auto add = [&](const char* name, double value) {
      figures.emplace_back(fmt::format("{}_{}", name, k),
                           reached ? value : std::numeric_limits<double>::quiet_NaN());
    };
    add("failed", stage.failed);
    add("failed_share", stage.share());
    add("stage_steps", static_cast<double>(stage.last_step - stage.first_step));
    if (!with_hole) continue;
    add("rows", stage.zone.rows);
    add("rows_axis", stage.zone.rows_axis);
    add("rows_diagonal", stage.zone.rows_diagonal);
    add("rows_mean", stage.zone.rows_mean);
    add("failed_per_layer", stage.zone.per_layer);
    add("layer_spread", stage.zone.layer_spread);
    add("asymmetry", stage.zone.asymmetry);
  }
  return figures;
}

}  // namespace vsb::app
