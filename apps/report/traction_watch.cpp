// SPDX-License-Identifier: BSD-3-Clause
#include "report/traction_watch.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "scene/toml_reader.hpp"

namespace vsb::app {

namespace {

/// The share of a resultant, or of the loaded cells, that counts as lost.
constexpr double lost_share = 0.1;
/// Less than this of a resultant is no swing.
constexpr double swing_share = 0.5;

/// The resultant over the load of a closed surface, or nearly: it may grow as well as shrink by a loss.
constexpr double closed_share = 0.5;

/// The share of the load by which a resultant may differ from that of the exact surface.
constexpr double unlike_share = 0.05;

/// The share of the load below which nothing of it acts.
constexpr double no_share = 1e-6;

double length(const Point& v) {
  return std::hypot(v[0], v[1], v[2]);
}

std::string text(const Point& v, int dimension) {
  std::string list;
  const double round_off = 1e-12 * length(v);
  for (int i = 0; i < dimension; ++i) {
    const double x = v[static_cast<size_t>(i)];
    list += fmt::format("{}{:.4g}", i == 0 ? "" : ", ", std::abs(x) < round_off ? 0 : x);
  }
  return list;
}

toml::array array(const Point& p) {
  return toml::array{p[0], p[1], p[2]};
}

/// The values of a table that was saved.
class SavedTable {
 public:
  explicit SavedTable(const toml::node* node) : table_(node ? node->as_table() : nullptr) {
    if (!table_) damaged();
  }

  [[noreturn]] static void damaged() {
    throw SetupError("the checkpoint is damaged: what it says of the tractions does not fit this scene");
  }
  template <class T>
  T value(const char* key) const {
    return value<T>((*table_)[key].node());
  }
  long long count(const char* key, long long least, long long most) const {
    const auto n = value<std::int64_t>(key);
    if (n < least || n > most) damaged();
    return n;
  }
  int count(const char* key) const {
    return static_cast<int>(count(key, 0, std::numeric_limits<int>::max()));
  }
  Point point(const char* key) const {
    const auto* list = (*table_)[key].as_array();
    Point p{};
    if (!list || list->size() != p.size()) damaged();
    for (size_t i = 0; i < p.size(); ++i) p[i] = value<double>(list->get(i));
    return p;
  }

 private:
  template <class T>
  static T value(const toml::node* node) {
    const auto found = node ? node->value<T>() : std::nullopt;
    if (!found) damaged();
    return *found;
  }

  const toml::table* table_;
};

}  // namespace

TractionWatch::TractionWatch(const Scene& scene, Simulation& simulation)
    : scene_(scene), simulation_(simulation) {
  begin();
}

std::vector<std::string> TractionWatch::begin() {
  auto losses = look();
  start_ = simulation_.traction_states();
  reports_.resize(start_.size());
  for (size_t n = 0; n < start_.size(); ++n) {
    auto& report = reports_[n];
    report.name = scene_.tractions[start_[n].traction].name;
    report.force_at_start = report.force = start_[n].force;
    report.part_cells_at_start = report.part_cells = start_[n].part_cells;
  }
  return losses;
}

std::string TractionWatch::saved() const {
  toml::array list;
  for (size_t n = 0; n < start_.size(); ++n) {
    const auto& start = start_[n];
    const auto& report = reports_[n];
    list.push_back(toml::table{{"traction", static_cast<std::int64_t>(start.traction)},
                               {"load", start.load},
                               {"force_at_start", array(start.force)},
                               {"force", array(report.force)},
                               {"whole_cells_at_start", start.whole_cells},
                               {"part_cells_at_start", start.part_cells},
                               {"part_cells", report.part_cells},
                               {"lost_at", report.lost_at},
                               {"loss", report.loss}});
  }
  return inline_toml(toml::table{{"tractions", list}});
}

void TractionWatch::restore(const std::string& saved) {
  toml::table parsed;
  try {
    parsed = toml::parse("saved = " + saved);
  } catch (const toml::parse_error&) {
    SavedTable::damaged();
  }
  const auto* list = parsed["saved"]["tractions"].as_array();
  if (!list || list->size() != start_.size()) SavedTable::damaged();
  for (size_t n = 0; n < start_.size(); ++n) {
    const SavedTable table(list->get(n));
    auto& start = start_[n];
    auto& report = reports_[n];
    const auto traction = static_cast<long long>(start.traction);
    table.count("traction", traction, traction);
    start.load = table.value<double>("load");
    start.force = report.force_at_start = table.point("force_at_start");
    start.whole_cells = table.count("whole_cells_at_start");
    start.part_cells = report.part_cells_at_start = table.count("part_cells_at_start");
    report.force = table.point("force");
    report.part_cells = table.count("part_cells");
    report.lost_at = table.count("lost_at", -1, simulation_.step());
    report.loss = table.value<std::string>("loss");
    if ((report.lost_at < 0) != report.loss.empty()) SavedTable::damaged();
  }
}

std::vector<std::string> TractionWatch::look(bool at_rest) {
  std::vector<std::string> losses;
  if (start_.empty()) return losses;
  const auto now = simulation_.traction_states();
  for (size_t n = 0; n < now.size(); ++n) {
    auto& report = reports_[n];
    report.force = now[n].force;
    report.part_cells = now[n].part_cells;
    if (report.lost_at >= 0) continue;
    report.loss = loss_of(now[n], start_[n], at_rest);
    if (report.loss.empty()) continue;
    report.lost_at = simulation_.step();
    losses.push_back(report.loss);
  }
  return losses;
}

std::string TractionWatch::loss_of(const TractionState& now, const TractionState& start, bool at_rest) const {
  const auto& traction = scene_.tractions[start.traction];
  const double before = length(start.force), after = length(now.force);
  const bool closed = before < closed_share * start.load;
  // Of particles that cross cells, a resultant swings by itself: until rest it is lost where less of the
  // boundary is loaded, or half of it is gone.
  const int cells = now.whole_cells + now.part_cells, cells_before = start.whole_cells + start.part_cells;
  const bool fewer = now.part_cells > start.part_cells || cells < (1 - lost_share) * cells_before;
  std::string what;
  if (cells == 0 && cells_before > 0)
    what = "has no boundary node left and loads nothing";
  else if (!closed && (fewer || at_rest || after < swing_share * before) && after < (1 - lost_share) * before)
    what = fmt::format("has lost {:.0f} % of its resultant: at full load ({}) N act, at the start ({}) N did",
                       100 * (1 - after / before), text(now.force, scene_.dimension),
                       text(start.force, scene_.dimension));
  else if (closed && fewer && std::abs(after - before) > lost_share * start.load)
    what = fmt::format(
        "has lost a part of its surface: its resultant at full load is ({}) N, at the start it was ({}) N",
        text(now.force, scene_.dimension), text(start.force, scene_.dimension));
  else if (!traction.carried && now.part_cells > start.part_cells + lost_share * cells_before)
    what = fmt::format(
        "ends within the boundary: {} cells beside its surface have nodes that carry nothing, {} had at the "
        "start",
        now.part_cells, start.part_cells);
  if (what.empty()) return {};
  const char* why = "";
  if (traction.has_surface && scene_.removal)
    why = "; let its 'surface' reach as far into the body as particles may be removed";
  else if (traction.has_surface && !traction.carried)
    why =
        "; its 'surface' is fixed in space and the boundary moves out of it: with configuration = "
        "\"initial\" it moves with the material";
  else if (traction.carried && scene_.method.basis == BasisKind::linear)
    why =
        "; with linear functions a stretched body tears, and particles that cross cells carry the load "
        "unevenly: take method.basis = \"quadratic_bspline\", or nodes = \"all\"";
  return fmt::format("at step {}, time {:.6g} s: traction '{}' {}{}", simulation_.step(), simulation_.time(),
                     traction.name, what, why);
}

std::string idle_tractions(const Scene& scene, const std::vector<TractionState>& states) {
  const auto box = bounding_box(scene.grid, scene.dimension);
  std::string idle;
  for (const auto& state : states) {
    const auto& traction = scene.tractions[state.traction];
    const double settled = traction.time.settled_at();
    const bool wanted = largest_stress(traction.field, box.lower, box.upper) > 0 &&
                        !(std::isfinite(settled) && traction.time(settled) == 0);
    // The forces on a closed surface cancel.
    const bool closed = length(state.exact_force) < closed_share * state.load;
    const bool acts =
        state.whole_cells + state.part_cells > 0 && (closed || length(state.force) > no_share * state.load);
    if (!wanted || acts) continue;
    idle += fmt::format(
        "{}nothing acts of traction '{}', whose resultant at full load is ({}) N on the bodies' "
        "surface at the start",
        idle.empty() ? "" : "; ", traction.name, text(state.exact_force, scene.dimension));
  }
  if (idle.empty()) return idle;
  return idle +
         ": let its 'surface' reach the loaded edge, a cell beyond it on either side, or move with the "
         "material (configuration = \"initial\")";
}

std::vector<std::string> resultant_advice(const Scene& scene, Simulation& simulation) {
  std::vector<std::string> advice;
  for (const auto& state : simulation.traction_states()) {
    Point difference;
    for (size_t i = 0; i < 3; ++i) difference[i] = state.force[i] - state.exact_force[i];
    const auto& traction = scene.tractions[state.traction];
    if (state.load == 0 && length(state.force) == 0)
      advice.push_back(fmt::format(
          "traction '{}' loads nothing: its 'surface' has nodes of cells at the boundary, but no "
          "surface of a body lies in it; let it reach a cell beyond the loaded edge on either side",
          traction.name));
    if (length(difference) <= unlike_share * state.load) continue;
    advice.push_back(fmt::format(
        "traction '{}' has the resultant ({}) N at full load, but ({}) N on the bodies' surface where it is "
        "declared: nodes are loaded as a whole, so its 'surface' is to reach a cell beyond the loaded edge, "
        "and where it ends within an edge, or meets another traction, half a cell more or less is loaded; "
        "finer cells or imposition = \"boundary_particles\" end it more sharply",
        traction.name, text(state.force, scene.dimension), text(state.exact_force, scene.dimension)));
  }
  return advice;
}

}  // namespace vsb::app
