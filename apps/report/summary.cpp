// SPDX-License-Identifier: BSD-3-Clause
#include "report/summary.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numeric>
#include <sstream>

#include "engine/build_info.hpp"
#include "report/comparison.hpp"
#include "scene/toml_reader.hpp"
#include "setup/local_origin.hpp"

namespace vsb::app {

namespace {

/// Largest resident set of this process so far. What getrusage says counts that of whoever started it, too.
long long peak_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmHWM:", 0) == 0) return std::stoll(line.substr(6)) * 1024;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<long long>(usage.ru_maxrss) * 1024;
}

toml::array array(const Point& p) {
  return toml::array{p[0], p[1], p[2]};
}

std::string text(const Point& p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p[0], p[1], p[2]);
}

}  // namespace

double RunFigures::ns_per_particle_step() const {
  const double sweeps = particle_steps + static_cast<double>(particles) * static_cast<double>(iterations);
  return sweeps > 0 ? 1e9 * seconds / sweeps : 0;
}

std::vector<std::pair<std::string, double>> named_figures(const Scene& scene, const RunFigures& f) {
  auto named = f.errors;
  named.insert(named.end(), f.compared.begin(), f.compared.end());
  named.insert(named.end(), {{"particles", f.particles},
                             {"boundary_nodes", f.boundary_nodes},
                             {"steps", static_cast<double>(f.steps)},
                             {"iterations", f.iterations},
                             {"time", static_cast<double>(f.steps) * scene.time.dt},
                             {"force_ratio", f.balance.force_ratio},
                             {"energy_ratio", f.balance.energy_ratio}});
  if (scene.method.void_filter) {
    named.emplace_back("false_voids", f.void_filter.false_voids);
    named.emplace_back("dropped_nodes", f.void_filter.dropped_nodes);
  }
  if (scene.faces.any_outflow()) {
    named.emplace_back("outflow_particles", static_cast<double>(f.outflow.particles));
    named.emplace_back("outflow_mass", f.outflow.mass_gone);
  }
  if (scene.removal) {
    const auto staged = stage_figures(f.stages, scene.removal->max_stages, scene.removal->hole.has_value());
    named.insert(named.end(), staged.begin(), staged.end());
  }
  if (scene.growth) named.emplace_back("growth_rate", f.growth_rate);
  const auto d = static_cast<size_t>(scene.dimension);
  const auto add = [&](const std::string& name, const Point& vector, size_t first, size_t last) {
    for (size_t c = first; c < last; ++c) named.emplace_back(name + "_" + "xyz"[c], vector[c]);
  };
  add("net_force", f.balance.net_force, 0, d);
  add("exact_force", f.balance.exact_force, 0, d);
  add("net_torque", f.balance.net_torque, d == 3 ? 0 : 2, d == 1 ? 2 : 3);
  add("exact_torque", f.balance.exact_torque, d == 3 ? 0 : 2, d == 1 ? 2 : 3);
  for (const auto& figure : vsb::app::named(f.state, scene)) named.push_back(figure);
  if (f.solution == Solution::balance) {
    named.emplace_back("load", f.share.load);
    named.emplace_back("net_force_share", f.share.net_force);
    if (scene.dimension > 1) named.emplace_back("net_torque_share", f.share.net_torque);
  }
  return named;
}

std::vector<std::string> figure_names(const Scene& scene, Solution solution) {
  auto names = error_names(scene);
  for (const auto& name : comparison_figure_names(scene.compare)) names.push_back(name);
  RunFigures figures;
  figures.solution = solution;
  for (const auto& [name, value] : named_figures(scene, figures)) names.push_back(name);
  return names;
}

std::vector<std::string> default_figures(const Scene& scene, Solution solution) {
  auto names = error_names(scene);
  if (names.empty())
    names = solution == Solution::balance
                ? std::vector<std::string>{"net_force_share"}
                : std::vector<std::string>{"largest_displacement", "strain_energy", "largest_von_mises"};
  return names;
}

bool is_count(const std::string& figure) {
  static const char* const beginnings[] = {"particles", "boundary_nodes", "steps",        "iterations",
                                           "time",      "force_ratio",    "energy_ratio", "false_voids",
                                           "collapsed", "dropped_nodes",  "stage",        "failed",
                                           "rows_",     "layer_spread_",  "asymmetry_"};
  return std::any_of(std::begin(beginnings), std::end(beginnings),
                     [&](const char* beginning) { return figure.rfind(beginning, 0) == 0; });
}

namespace {

toml::array bodies_of(const Scene& scene, const std::vector<BodyVolume>& volumes) {
  toml::array bodies;
  for (size_t b = 0; b < volumes.size(); ++b) {
    const auto& [particles, shape, shape_error] = volumes[b];
    const double density = scene.bodies[b].density;
    bodies.push_back(toml::table{{"name", scene.bodies[b].name},
                                 {"particle_volume", particles},
                                 {"particle_mass", density * particles},
                                 {"shape_volume", shape},
                                 {"shape_mass", density * shape}});
  }
  return bodies;
}

/// Numbers of cells with all moments, with fewer, and of those left alone.
std::array<int, 3> moment_cells(const Scene& scene, const MomentFit& fit) {
  const auto all = static_cast<size_t>(scene.dimension) + 1;
  return {fit.cells[all], std::accumulate(&fit.cells[1], &fit.cells[all], 0), fit.cells[0]};
}

}  // namespace

namespace {

toml::array traction_reports(const RunFigures& f) {
  toml::array reports;
  for (const auto& t : f.tractions) {
    toml::table report{{"name", t.name},
                       {"full_force_at_start", array(t.force_at_start)},
                       {"full_force", array(t.force)},
                       {"cells_loaded_in_part_at_start", t.part_cells_at_start},
                       {"cells_loaded_in_part", t.part_cells}};
    if (t.lost_at >= 0) {
      report.insert("lost_at_step", t.lost_at);
      report.insert("loss", t.loss);
    }
    reports.push_back(report);
  }
  return reports;
}

bool is_not_finite(const toml::node& node) {
  const auto* number = node.as_floating_point();
  return number && !std::isfinite(number->get());
}

/// Takes what is not finite out of a table, and gives its names: JSON has no number for it.
void take_out_not_finite(toml::table& table, const std::string& path, std::vector<std::string>& names) {
  std::vector<std::string> gone;
  for (auto&& [key, node] : table) {
    const std::string name(key.str());
    if (auto* inner = node.as_table()) take_out_not_finite(*inner, path + name + ".", names);
    bool taken = is_not_finite(node);
    if (auto* list = node.as_array())
      for (size_t i = 0; i < list->size(); ++i) {
        taken = taken || is_not_finite(*list->get(i));
        if (auto* inner = list->get(i)->as_table())
          take_out_not_finite(*inner, fmt::format("{}{}[{}].", path, name, i), names);
      }
    if (taken) gone.push_back(name);
  }
  for (const auto& name : gone) {
    table.erase(name);
    names.push_back(path + name);
  }
}

}  // namespace

std::string summary_json(const Scene& scene, const RunFigures& f) {
  toml::table errors, compared, provenance;
  for (const auto& [name, value] : f.errors) errors.insert(name, value);
  for (const auto& [name, value] : f.compared) compared.insert(name, value);
  for (const auto& [name, value] : build_info()) provenance.insert(name, value);
  provenance.insert("scene", scene.resolved);
  toml::table summary{
      {"name", scene.name},
      {"dimension", scene.dimension},
      {"errors", errors},
      {"compared", compared},
      {"particles", f.particles},
      {"boundary_nodes", f.boundary_nodes},
      {"solution", f.solution == Solution::static_state ? "static"
                   : f.solution == Solution::balance    ? "balance"
                                                        : "explicit"},
      {"steps", f.steps},
      {"iterations", f.iterations},
      {"dt", scene.time.dt},
      {"time", static_cast<double>(f.steps) * scene.time.dt},
      {"static", f.found_static},
      {"force_ratio", f.balance.force_ratio},
      {"energy_ratio", f.balance.energy_ratio},
      {"net_force", array(f.balance.net_force)},
      {"net_torque", array(f.balance.net_torque)},
      {"exact_force", array(f.balance.exact_force)},
      {"exact_torque", array(f.balance.exact_torque)},
      {"torque_about", array(f.balance.torque_about)},
      {"state_hash", f.state_hash},
      {"seconds", f.seconds},
      {"ns_per_particle_step", f.ns_per_particle_step()},
      {"state_bytes", static_cast<long long>(f.state_bytes)},
      {"peak_bytes", peak_bytes()},
      {"provenance", provenance},
  };
  if (!f.tractions.empty()) summary.insert("tractions", traction_reports(f));
  if (!f.state_hash.empty() && f.particles > 0)  // the state has been looked at
    for (const auto& [name, value] : named(f.state, scene)) summary.insert(name, value);
  if (f.solution == Solution::balance)
    summary.insert("resultant", toml::table{{"load", f.share.load},
                                            {"net_force_share", f.share.net_force},
                                            {"net_torque_share", f.share.net_torque}});
  summary.insert("bodies", bodies_of(scene, f.volumes));
  if (!f.left_grid.empty()) summary.insert("left_grid", f.left_grid);
  if (scene.faces.any_outflow()) {
    const auto& out = f.outflow;
    toml::table faces;
    for (size_t face = 0; face < 6; ++face)
      if (scene.faces.outflow[face / 2][face % 2])
        faces.insert(face_name(scene, {face / 2, face % 2}), out.by_face[face / 2][face % 2]);
    summary.insert("outflow", toml::table{{"particles", out.particles},
                                          {"first_step", out.first_step},
                                          {"last_step", out.last_step},
                                          {"faces", faces},
                                          {"mass_at_start", out.mass_at_start},
                                          {"mass", out.mass_gone},
                                          {"mass_in_grid", f.mass}});
  }
  if (scene.growth) summary.insert("growth_rate", f.growth_rate);
  if (scene.removal) summary.insert("removal", toml::table(toml::parse(to_toml(f.stages))));
  if (f.cut.particles > 0)
    summary.insert("cut_bodies", toml::table{{"volume", f.cut.particles + f.cut.dropped},
                                             {"particle_volume", f.cut.particles}});
  if (scene.method.moment_fit) {
    const auto [all, fewer, none] = moment_cells(scene, f.moment_fit);
    summary.insert("moment_fit", toml::table{{"cells_of_all_moments", all},
                                             {"cells_of_fewer", fewer},
                                             {"cells_not_fitted", none},
                                             {"volume", f.moment_fit.volume_after},
                                             {"volume_without", f.moment_fit.volume_before}});
  }
  if (scene.method.void_filter)
    summary.insert("void_filter", toml::table{{"false_voids", f.void_filter.false_voids},
                                              {"dropped_nodes", f.void_filter.dropped_nodes}});
  std::vector<std::string> not_finite;
  take_out_not_finite(summary, "", not_finite);
  if (!not_finite.empty()) {
    fmt::print(stderr, "vsb: warning: not finite, and left out of summary.json: {}\n",
               fmt::join(not_finite, ", "));
    toml::array names;
    for (const auto& name : not_finite) names.push_back(name);
    summary.insert("not_finite", names);
  }
  std::ostringstream out;
  out << toml::json_formatter{summary} << "\n";
  return out.str();
}

void print_resultant(const Scene& scene, const BalanceReport& balance, const std::string& prefix) {
  if (scene.tractions.empty()) return;
  fmt::print("{}resultant of the tractions {} N, on the exact surface {} N\n", prefix,
             text(balance.net_force), text(balance.exact_force));
  if (scene.dimension > 1)
    fmt::print(
        "{}their torque about {}, the centre of mass at the start, {} N m, on the exact surface {} N m\n",
        prefix, position_text(scene, balance.torque_about), text(balance.net_torque),
        text(balance.exact_torque));
}

double percent_above(double ratio) {
  const double percent = 100 * (ratio - 1);
  return std::abs(percent) < 0.005 ? 0 : percent;
}

void print_cut_volume(const CutVolume& volume, const std::string& prefix) {
  if (volume.particles == 0) return;
  const double bodies = volume.particles + volume.dropped;
  fmt::print(
      "{}volume of bodies with cut lattices {:.9g}, of their particles {:.9g}: {:.2e} of it in slivers "
      "too small for a particle\n",
      prefix, bodies, volume.particles, volume.dropped / bodies);
}

void print_moment_fit(const Scene& scene, const MomentFit& fit, const std::string& prefix) {
  if (!scene.method.moment_fit) return;
  const auto [all, fewer, none] = moment_cells(scene, fit);
  fmt::print(
      "{}volumes fitted to all moments in {} cells, to fewer in {}, not in {}; volume of the particles "
      "{:.9g}, "
      "without the fit {:.9g}\n",
      prefix, all, fewer, none, fit.volume_after, fit.volume_before);
}

void print_report(const Scene& scene, const RunFigures& f) {
  if (!f.errors.empty()) {
    size_t width = 12;
    for (const auto& [name, value] : f.errors) width = std::max(width, name.size() + 2);
    std::string head = fmt::format("{:<{}}{:>12}", "error", width, "this run");
    for (const auto& p : scene.published) head += fmt::format("  {:>24}", p.source);
    fmt::print("{}\n", head);
    for (const auto& [name, value] : f.errors) {
      std::string line = fmt::format("{:<{}}{:>12.4e}", name, width, value);
      for (const auto& p : scene.published) {
        const auto published = p.errors.find(name);
        line += published == p.errors.end() ? fmt::format("  {:>24}", "-")
                                            : fmt::format("  {:>12.4e} ({:>+7.2f} %)", published->second,
                                                          percent_above(value / published->second));
      }
      fmt::print("{}\n", line);
    }
  }
  for (const auto& [name, value] : f.compared) fmt::print("{:<12}{:>12.4f}\n", name, value);
  const char* sweep = f.solution == Solution::static_state ? "iteration" : "step";
  fmt::print("{} {}s in {:.3g} s: {:.4g} ns per particle and {}; peak memory {:.4g} MB\n",
             f.steps_timed + f.iterations, sweep, f.seconds, f.ns_per_particle_step(), sweep,
             static_cast<double>(peak_bytes()) / 1e6);
  print_body_volumes(scene, f.volumes, "");
  print_cut_volume(f.cut, "");
  print_moment_fit(scene, f.moment_fit, "");
  if (scene.faces.any_outflow())
    fmt::print(
        "left the grid: {}; mass {:.6g} kg at the start, {:.6g} kg in the grid, {:.2e} of it unaccounted "
        "for\n",
        outflow_text(scene, f.outflow), f.outflow.mass_at_start, f.mass,
        std::abs(f.outflow.mass_at_start - f.mass - f.outflow.mass_gone) / f.outflow.mass_at_start);
  if (f.particles == 0) {
    fmt::print("no particle is left in the grid: there are no stresses, energies and resultants to tell\n");
    return;
  }
  const auto& b = f.balance;
  fmt::print("of the nodes: force ratio {:.2e}, energy ratio (kinetic to strain energy) {:.2e}\n",
             b.force_ratio, b.energy_ratio);
  if (std::isfinite(f.state.kinetic_energy)) print_state_figures(f.state, b.energy_ratio);
  if (scene.growth) fmt::print("a small disturbance of this state grows at {:.3g} 1/s\n", f.growth_rate);
  if (!scene.removal) print_resultant(scene, b, "");  // the surface of the start is there no longer
  for (const auto& t : f.tractions)
    if (t.lost_at >= 0) fmt::print("lost load: {}\n", t.loss);
  if (scene.method.void_filter)
    fmt::print("void filter: {} false voids inside the bodies, {} boundary nodes dropped, {} left\n",
               f.void_filter.false_voids, f.void_filter.dropped_nodes, f.boundary_nodes);
}

}  // namespace vsb::app
