// SPDX-License-Identifier: BSD-3-Clause
#include "scene/read_time_function.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "scene/units.hpp"

namespace vsb::app {

namespace {

TimeFunction read_table(TableReader& r, const Key& key) {
  const toml::node& node = *r.node(key);
  const char* what = "must be an array of [time in s, factor] pairs, times not decreasing";
  TimeFunction::Table points;
  const auto* rows = node.as_array();
  if (!rows || rows->empty()) r.fail(key, what);
  for (const auto& row : *rows) {
    const auto* pair = row.as_array();
    if (!pair || pair->size() != 2) r.fail(row, key.name, what);
    points.emplace_back(checked_number(r, *pair->get(0), key.name, Range::at_least(0)),
                        checked_number(r, *pair->get(1), key.name, Range::any()));
    if (points.size() > 1 && points.back().first < points[points.size() - 2].first)
      r.fail(row, key.name, what);
  }
  return points;
}

TimeFunction read_sine(TableReader r, const SineKeys& keys) {
  TimeFunction::Sine sine{};
  sine.period = r.read(keys.period);
  sine.amplitude = r.read(keys.amplitude);
  sine.mean = r.read(keys.mean);
  sine.start = r.read(keys.start);
  sine.phase = radians(r.read(keys.phase));
  r.finish();
  return sine;
}

}  // namespace

TimeFunction TimeShape::at(double dt) const {
  if (ramp_steps == 0) return in_seconds;
  const double duration = static_cast<double>(ramp_steps) * dt;
  return smooth ? TimeFunction(TimeFunction::SmoothRamp{duration}) : TimeFunction::ramp(duration);
}

TimeShape read_time_function(TableReader r, const LoadTimeKeys& keys) {
  const auto& forms = keys.keys();
  const auto names = fmt::format("{}", fmt::join(names_of(forms), ", "));
  r.refuse_empty("a table with one of " + names);
  if (std::count_if(forms.begin(), forms.end(), [&](const Key* key) { return r.has(*key); }) > 1) {
    const auto first = r.source().begin();
    r.fail(first->second, std::string(first->first.str()), "give one of " + names);
  }
  TimeShape shape;
  if (r.has(keys.ramp_steps)) {
    shape.ramp_steps = r.read(keys.ramp_steps);
  } else if (r.has(keys.smooth_ramp_steps)) {
    shape.ramp_steps = r.read(keys.smooth_ramp_steps);
    shape.smooth = true;
  } else if (r.has(keys.smooth_ramp)) {
    shape.in_seconds = TimeFunction::SmoothRamp{r.read(keys.smooth_ramp)};
  } else if (r.has(keys.step)) {
    shape.in_seconds = TimeFunction::step(r.read(keys.step));
  } else if (r.has(keys.table)) {
    shape.in_seconds = read_table(r, keys.table);
  } else if (r.has(keys.sine)) {
    shape.in_seconds = read_sine(r.table(keys.sine), keys.sine_keys);
  } else {
    const double duration = r.read(keys.ramp);
    if (duration > 0) shape.in_seconds = TimeFunction::ramp(duration);
  }
  r.finish();
  return shape;
}

}  // namespace vsb::app
