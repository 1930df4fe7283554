// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Reads a scene as a whole: its own keys, its tables in order, and what they must be to each other.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "scene/check_magnitudes.hpp"
#include "scene/load_in_time.hpp"
#include "scene/read_body.hpp"
#include "scene/read_comparison.hpp"
#include "scene/read_grid.hpp"
#include "scene/read_growth.hpp"
#include "scene/read_method.hpp"
#include "scene/read_output.hpp"
#include "scene/read_removal.hpp"
#include "scene/read_time.hpp"
#include "scene/read_traction.hpp"
#include "scene/scene.hpp"
#include "scene/scene_keys.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

namespace {

struct SceneKeys : KeyTable {
  SceneKeys() : KeyTable("", "The keys at the top of the file, and its tables.") {}
  TextKey name{*this, "name", in_words("that of the file"), "with which the files of a run begin"};
  TextKey title{*this, "title", std::string(), "for pictures"};
  ChoiceKeyOf<Setting> setting{
      *this,
      "setting",
      {{"paper", Setting::paper, "linear functions, whole particles"},
       {"accurate", Setting::accurate,
        "quadratic B-splines, boundary boxes split and cut, 2 particles per cell and direction"}},
      first_word,
      "what the scene takes where it does not say"};
  IntegerKey dimension{
      *this, "dimension", 1, 3, required, "", "of space; in 2 plane strain, in 1 uniaxial strain"};
  ChoiceKeyOf<bool> single_precision{
      *this, "precision", {{"double", false}, {"float", true}}, first_word, "of the particles and nodes"};
  NumbersKey gravity{*this, "gravity", per_direction, Range::any(), 0.0, "m/s^2", "on all bodies"};
  SubtableKey gravity_time{*this, "gravity_time", gravity_time_keys, in_words("full load from the start"),
                           "how gravity varies in time"};
  SubtableKey grid{*this, "grid", grid_keys, required, "the background grid"};
  SubtableKey faces{*this, "faces", face_keys, in_words("all open"), "conditions at the faces of the grid"};
  SubtablesKey body{*this, "body", body_keys, required, "at least one"};
  SubtablesKey traction{*this, "traction", traction_keys, in_words("none"),
                        "at most " + std::to_string(max_tractions)};
  SubtableKey method{*this, "method", method_keys, in_words("all defaults"), "how a step is done"};
  SubtableKey time{*this, "time", time_keys, required, "the time step and the end of the run"};
  SubtableKey static_solution{*this, "static", static_keys, in_words("all defaults"), "for vsb run --static"};
  SubtableKey removal{*this, "removal", removal_keys, in_words("none"), "failure in stages"};
  SubtableKey growth{*this, "growth", growth_keys, in_words("none"),
                     "how fast a disturbance grows at the end"};
  SubtableKey output{*this, "output", output_keys, in_words("all defaults"), "what a run leaves"};
  SubtableKey compare{*this, "compare", compare_keys, in_words("none"), "an exact solution"};
  SubtablesKey published{*this, "published", published_keys, in_words("none"), "figures of others"};
};
const SceneKeys scene_table;

/// Whether anything strains or moves the bodies.
bool is_loaded(const Scene& scene) {
  const auto box = bounding_box(scene.grid, scene.dimension);
  const auto acts = [&](const TractionSpec& t) { return largest_stress(t.field, box.lower, box.upper) > 0; };
  const auto begins_loaded = [](const BodySpec& b) { return !is_zero(b.stress) || !is_zero(b.velocity); };
  return has_gravity(scene) || std::any_of(scene.tractions.begin(), scene.tractions.end(), acts) ||
         std::any_of(scene.bodies.begin(), scene.bodies.end(), begins_loaded);
}

/// Whether elastic bodies end without any force: the loads that they had are 0 from some time on.
bool ends_unloaded(const Scene& scene) {
  const auto elastic = [](const BodySpec& b) { return !is_plastic(b.material.law) && is_zero(b.stress); };
  const auto loads = loads_in_time(scene);
  const auto ends = [](const LoadInTime& load) { return load.time(load.time.settled_at()) == 0; };
  return !loads.empty() && std::all_of(scene.bodies.begin(), scene.bodies.end(), elastic) &&
         std::all_of(loads.begin(), loads.end(), ends);
}

/// Refuses a run until static without a static state to run to.
void refuse_restless(const TableReader& r, const Scene& scene) {
  const auto refuse = [&](const std::string& why) {
    r.fail(*r.source()["time"]["until_static"].node(), "time.until_static", why);
  };
  for (const auto& load : loads_in_time(scene))
    if (!std::isfinite(load.time.settled_at()))
      refuse(fmt::format("{} is a sine, which never settles; give time.steps instead", load.name));
  if (!is_loaded(scene))
    refuse(
        "nothing loads the bodies (no traction, gravity, initial stress or velocity), so there is no static "
        "state to run to");
  if (ends_unloaded(scene))
    refuse(
        "every load ends at 0, where elastic bodies have no force left by which rest could be judged; "
        "give time.steps instead");
}

/// Whether names of files may have it.
bool may_be_in_name(unsigned char c) {
  return c > ' ' && c != 127 && c != '/' && c != '\\';
}

/// The name of a scene that gives none: its file's, with a dash where a name of results may not have what is
/// there.
std::string name_of_file(const std::string& path) {
  std::string name = std::filesystem::path(path).stem().string();
  for (char& c : name)
    if (!may_be_in_name(static_cast<unsigned char>(c))) c = '-';
  name.erase(0, name.find_first_not_of('.'));
  return name.empty() ? "scene" : name.substr(0, 200);
}

/// Files get this name, and another word behind it.
std::string read_name(TableReader& r, const std::string& path) {
  const auto& key = scene_table.name;
  const std::string name = r.read(key, name_of_file(path));
  if (name.empty() || name.size() > 200 || name[0] == '.' ||
      !std::all_of(name.begin(), name.end(),
                   [](char c) { return may_be_in_name(static_cast<unsigned char>(c)); }))
    r.fail(key,
           "must be usable as a file name: 1 to 200 printable characters, no space or slash, no leading dot");
  return name;
}

/// Particles that go out of the grid take with them what else counts on them.
void refuse_outflow_beside(const TableReader& r, const Scene& scene) {
  if (!scene.faces.any_outflow()) return;
  const auto refuse = [&](const std::string& with) {
    r.fail(scene_table.faces, "\"outflow\" is not for scenes with " + with);
  };
  if (scene.removal) refuse("removal, whose stages count all particles that are gone as failed");
  for (const auto& traction : scene.tractions)
    if (traction.imposition == Imposition::boundary_particles ||
        traction.imposition == Imposition::material_points)
      refuse(fmt::format("surface points, which would leave the grid as well (imposition of traction '{}')",
                         traction.name));
}

}  // namespace

const KeyTable& scene_keys() {
  return scene_table;
}

Scene read_scene(const std::string& path, const std::vector<std::string>& overrides) {
  const auto& keys = scene_table;
  const toml::table document = parse_scene_file(path, overrides);
  ResolvedTable resolved;
  TableReader r(document, "", resolved, keys);
  Scene scene;
  scene.name = read_name(r, path);
  scene.title = r.read(keys.title);
  scene.setting = r.read<Setting>(keys.setting);
  scene.dimension = static_cast<int>(r.read(keys.dimension));
  scene.single_precision = r.read<bool>(keys.single_precision);
  const auto gravity = r.read(keys.gravity.of(static_cast<size_t>(scene.dimension)));
  std::copy(gravity.begin(), gravity.end(), scene.gravity.begin());
  if (r.has(keys.gravity_time) && !has_gravity(scene))
    r.fail(keys.gravity_time, "varies a gravity of 0: give 'gravity', or leave it out");
  TimeShape gravity_shape;
  if (has_gravity(scene)) gravity_shape = read_time_function(r.table(keys.gravity_time), gravity_time_keys);
  if (!r.has(keys.grid)) r.missing(keys.grid, "a table with lower, upper and spacing");
  scene.grid = read_grid(r.table(keys.grid, grid_keys.beyond(scene.dimension)), scene.dimension);
  if (scene.grid.mapped() && scene.single_precision)
    r.fail(keys.single_precision, "rectilinear and polar grids are for double precision");
  const auto other_faces = face_keys.others(scene.grid, scene.dimension);
  scene.faces = read_faces(r.table(keys.faces, other_faces), scene.dimension, scene.grid);
  for (auto& table : r.tables(keys.body))
    scene.bodies.push_back(read_body(table, scene, scene.bodies.size()));
  if (scene.bodies.empty()) r.missing(keys.body, "at least one table [[body]]");
  std::vector<TimeShape> time_shapes;
  for (auto& table : r.tables(keys.traction)) {
    if (scene.tractions.size() == max_tractions)
      r.fail(keys.traction, fmt::format("at most {} tractions", max_tractions));
    time_shapes.emplace_back();
    scene.tractions.push_back(read_traction(table, scene, scene.tractions.size(), time_shapes.back()));
  }
  if (!document["method"]["basis"])
    if (const auto why = unfit_setting(scene); !why.empty()) r.fail(keys.setting, why);
  read_method(r.table(keys.method), r.has(keys.setting) && scene.setting == Setting::paper, scene);
  const auto keeps_gradient = [](const BodySpec& b) { return b.material.law == MaterialLaw::hencky; };
  if (scene.method.volume_update != "determinant" &&
      std::any_of(scene.bodies.begin(), scene.bodies.end(), keeps_gradient))
    r.fail(*document["method"]["volume_update"].node(), "method.volume_update",
           "must be \"determinant\" with law = \"hencky\", whose stress is that of J = det F");
  if (!r.has(keys.time)) r.missing(keys.time, "a table with dt or kappa, and steps or until_static");
  scene.time = read_time(r.table(keys.time), scene);
  check_magnitudes(scene, r);
  scene.gravity_time = gravity_shape.at(scene.time.dt);
  for (size_t k = 0; k < time_shapes.size(); ++k) scene.tractions[k].time = time_shapes[k].at(scene.time.dt);
  if (scene.time.until_static) refuse_restless(r, scene);
  scene.static_solution = read_static(r.table(keys.static_solution));
  scene.removal = read_removal(r, keys.removal, scene);
  refuse_outflow_beside(r, scene);
  scene.growth = read_growth(r, keys.growth, scene);
  scene.output = read_output(r.table(keys.output), scene);
  scene.compare = read_comparison(r, keys.compare, scene, scene.more_norms);
  check_comparison(scene, r);
  scene.published = read_published(r, keys.published, scene);
  r.finish();
  scene.resolved = resolved.toml();
  return scene;
}

}  // namespace vsb::app
