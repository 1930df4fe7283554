// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "scene/check_magnitudes.hpp"
#include "scene/limits.hpp"
#include "scene/read_affine.hpp"
#include "scene/read_basis.hpp"
#include "scene/read_grid.hpp"
#include "scene/read_lattice.hpp"
#include "scene/read_material.hpp"
#include "scene/read_moment_fit.hpp"
#include "scene/read_region.hpp"
#include "scene/read_removal.hpp"
#include "scene/read_stress_field.hpp"
#include "scene/read_volumetric.hpp"
#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"
#include "scene/units.hpp"

namespace vsb::app {

namespace {

template <class Value>
bool is_zero(const Affine<Value>& field) {
  return field.value == Value{} && field.gradient == std::array<Value, 3>{};
}

BodySpec read_body(TableReader r, const Scene& scene, size_t number) {
  const int dimension = scene.dimension;
  const auto d = static_cast<size_t>(dimension);
  BodySpec body;
  r.allow_only({"name", "shape", "particles_per_cell", "lattice", "boundary", "jitter", "seed", "density",
                "stress", "velocity", "material"});
  body.where = location(r.source());
  body.name = r.text("name", fmt::format("body {}", number + 1));
  body.region = read_region(r, "shape", dimension, false);
  read_lattice(r, scene, body);
  body.density = r.number("density", Range::positive(), {}, "kg/m^3");
  body.stress = read_affine<6>(r, "stress", 6, dimension, "Pa, tension positive: xx yy zz xy yz xz");
  body.velocity = read_affine<3>(r, "velocity", d, dimension, "m/s");
  body.material = read_material(r.table("material"));
  if (body.material.law == MaterialLaw::hencky && r.has("stress") && !is_zero(body.stress))
    r.fail(*r.source().get("stress"), "stress",
           "a body with law = \"hencky\" starts without stress: its stress follows from its deformation, and "
           "it starts undeformed");
  r.finish();
  return body;
}

/// dt is only known after the materials: a ramp given in steps is kept as such until then.
struct TimeShape {
  TimeFunction in_seconds;
  long long ramp_steps = 0;
  bool smooth = false;

  TimeFunction at(double dt) const {
    if (ramp_steps == 0) return in_seconds;
    const double duration = static_cast<double>(ramp_steps) * dt;
    return smooth ? TimeFunction(TimeFunction::SmoothRamp{duration}) : TimeFunction::ramp(duration);
  }
};

TimeFunction read_table(TableReader& r) {
  const toml::node& node = *r.node("table");
  const char* what = "must be an array of [time in s, factor] pairs, times not decreasing";
  TimeFunction::Table points;
  const auto* rows = node.as_array();
  if (!rows || rows->empty()) r.fail(node, "table", what);
  for (const auto& row : *rows) {
    const auto* pair = row.as_array();
    if (!pair || pair->size() != 2) r.fail(row, "table", what);
    points.emplace_back(checked_number(r, *pair->get(0), "table", Range::at_least(0)),
                        checked_number(r, *pair->get(1), "table", Range::any()));
    if (points.size() > 1 && points.back().first < points[points.size() - 2].first)
      r.fail(row, "table", what);
  }
  return points;
}

TimeFunction read_sine(TableReader r) {
  TimeFunction::Sine sine{};
  r.allow_only({"period", "amplitude", "mean", "start", "phase"});
  sine.period = r.number("period", Range::positive(), {}, "s");
  sine.amplitude = r.number("amplitude", Range::any(), 1.0, "share of the full load");
  sine.mean = r.number("mean", Range::any(), 0.0, "share of the full load; the factor before 'start'");
  sine.start = r.number("start", Range::at_least(0), 0.0, "s");
  sine.phase = radians(r.number("phase", Range::any(), 0.0, "degrees, at 'start'"));
  r.finish();
  return sine;
}

TimeShape read_time_function(TableReader r) {
  static const std::vector<std::string> forms = {"ramp", "ramp_steps", "smooth_ramp", "smooth_ramp_steps",
                                                 "step", "table",      "sine"};
  r.allow_only(forms);
  r.refuse_empty(fmt::format("a table with one of {}", fmt::join(forms, ", ")));
  if (std::count_if(forms.begin(), forms.end(), [&](const auto& key) { return r.has(key); }) > 1) {
    const auto first = r.source().begin();
    r.fail(first->second, std::string(first->first.str()),
           fmt::format("give one of {}", fmt::join(forms, ", ")));
  }
  TimeShape shape;
  const auto steps = [&](const char* key) {
    return r.integer(key, 1, 1'000'000'000'000LL, {}, "steps to full load");
  };
  if (r.has("ramp_steps")) {
    shape.ramp_steps = steps("ramp_steps");
  } else if (r.has("smooth_ramp_steps")) {
    shape.ramp_steps = steps("smooth_ramp_steps");
    shape.smooth = true;
  } else if (r.has("smooth_ramp")) {
    shape.in_seconds = TimeFunction::SmoothRamp{
        r.number("smooth_ramp", Range::positive(), {}, "s to full load, without a jump of slope")};
  } else if (r.has("step")) {
    shape.in_seconds =
        TimeFunction::step(r.number("step", Range::at_least(0), {}, "s, full load from here on"));
  } else if (r.has("table")) {
    shape.in_seconds = read_table(r);
  } else if (r.has("sine")) {
    shape.in_seconds = read_sine(r.table("sine"));
  } else {
    const double duration =
        r.number("ramp", Range::at_least(0), 0.0,
                 "s to full load; 0: full load from the start; or ramp_steps, smooth_ramp, "
                 "smooth_ramp_steps, step, table, sine");
    if (duration > 0) shape.in_seconds = TimeFunction::ramp(duration);
  }
  r.finish();
  return shape;
}

Imposition read_imposition(TableReader& r) {
  static const std::vector<std::string> names = {"virtual_stress", "virtual_stress_original",
                                                 "boundary_particles", "material_points", "nodal"};
  const std::string name = r.choice("imposition", names, names[0]);
  return static_cast<Imposition>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// At which nodes a traction acts, and whether it is in balance with itself.
void read_nodes(TableReader& r, const Scene& scene, TractionSpec& traction) {
  traction.all_nodes = r.choice("nodes", {"boundary", "all"}, "boundary") == "all";
  traction.self_balanced = r.boolean("self_balanced", false);
  if (traction.all_nodes && traction.imposition != Imposition::virtual_stress)
    r.fail(*r.source().get("nodes"), "nodes", "'all' is for imposition = \"virtual_stress\"");
  if (traction.all_nodes && r.has("surface"))
    r.fail(*r.source().get("surface"), "surface",
           "with nodes = \"all\" the traction loads all surfaces at once, by the values of its field there; "
           "leave "
           "'surface' out");
  if (!traction.self_balanced) return;
  if (!traction.all_nodes) r.fail(*r.source().get("self_balanced"), "self_balanced", "needs nodes = \"all\"");
  for (const auto& sides : scene.faces.fixed)
    if (sides[0] != 0 || sides[1] != 0)
      r.fail(*r.source().get("self_balanced"), "self_balanced",
             "is for free bodies: a part that ends at a symmetry plane or a support has a resultant");
}

/// Whether a surface is one of places, or of the material that was there at the start; points and loaded
/// faces of cells belong to the surface of the start.
void read_configuration(TableReader& r, TractionSpec& traction) {
  static const char* key = "configuration";
  if (traction.all_nodes) {
    if (r.has(key))
      r.fail(
          *r.source().get(key), key,
          "is for a traction with a 'surface'; with nodes = \"all\" leave it out, the traction follows the "
          "material all the same");
    return;
  }
  const bool on_nodes = traction.imposition == Imposition::virtual_stress ||
                        traction.imposition == Imposition::virtual_stress_original;
  if (on_nodes)
    traction.carried = r.choice(key, {"current", "initial"}, "current") == "initial";
  else if (r.has(key))
    r.choice(key, {"initial"});
}

TractionSpec read_traction(TableReader r, const Scene& scene, size_t number, TimeShape& time) {
  const int dimension = scene.dimension;
  TractionSpec traction;
  std::vector<std::string> keys = {"name",          "imposition",      "nodes",
                                   "self_balanced", "surface",         "configuration",
                                   "layer",         "points_per_cell", "time"};
  keys.insert(keys.end(), stress_field_keys.begin(), stress_field_keys.end());
  r.allow_only(keys);
  traction.where = location(r.source());
  traction.name = r.text("name", fmt::format("traction {}", number + 1));
  traction.imposition = read_imposition(r);
  traction.field = read_stress_field(r, scene);
  read_nodes(r, scene, traction);
  traction.has_surface = r.has("surface");
  traction.surface = read_region(r, "surface", dimension, true);
  read_configuration(r, traction);
  traction.layer = everywhere();
  if (traction.imposition == Imposition::material_points)
    traction.layer = read_region(r, "layer", dimension, true);
  traction.points_per_cell = static_cast<int>(
      r.integer("points_per_cell", 1, 64, dimension == 3 ? 4 : 8, "sampling of the surface"));
  time = read_time_function(r.table("time"));
  r.finish();
  return traction;
}

void read_method(TableReader r, Scene& scene) {
  MethodSpec& m = scene.method;
  read_basis(r, scene);
  m.damping =
      r.number("damping", {0, 1, false, true}, 0.0, "Cundall's alpha; not for bodies that move as a whole");
  m.volume_update = r.choice("volume_update", {"determinant", "exponential"}, "determinant");
  m.scatter = r.choice("scatter", {"gathered", "duplicated", "atomic"}, "gathered");
  m.engine = r.choice("engine", {"auto", "cell_lanes", "particles"}, "auto");
  m.cell_gauss_points = static_cast<int>(
      r.integer("cell_gauss_points", 1, 4, 2, "per direction, for imposition = \"virtual_stress_original\""));
  m.fill_criterion =
      r.number("fill_criterion", {0, 1, false, true}, 0.0,
               "tau: cells filled by less than 1 - tau count as boundary cells; 0: no such cells");
  m.void_filter = r.boolean("void_filter", false);
  read_moment_fit(r, scene);
  read_volumetric(r, scene);
  m.allow_particles_on_grid_lines = r.boolean("allow_particles_on_grid_lines", false);
  r.finish();
}

TimeSpec read_time(TableReader r, const Scene& scene) {
  TimeSpec t;
  r.allow_only({"dt", "kappa", "steps", "until_static"});
  const double critical = critical_time(scene);
  if (r.has("dt") && r.has("kappa"))
    r.fail(*r.source().get("kappa"), "kappa", "give either dt or kappa, not both");
  if (r.has("dt")) {
    t.dt = r.number("dt", {0, 2 * critical, true, false}, {},
                    fmt::format("s; a compression wave crosses a cell in {:.6g} s; or kappa", critical));
    t.kappa = t.dt / critical;
  } else {
    t.kappa = r.number("kappa", {0, 2, true, false}, {}, "share of the critical time step, Eq. (29); or dt");
    t.dt = t.kappa * critical;
  }
  const long long most = 1'000'000'000'000LL;
  if (r.has("until_static")) {
    if (r.has("steps"))
      r.fail(*r.source().get("steps"), "steps",
             "give either steps or until_static (with max_steps), not both");
    TableReader s = r.table("until_static");
    StaticCriterion c{};
    const bool splines = scene.method.basis == BasisKind::quadratic_bspline;
    c.force_ratio = s.number("force_ratio", {0, 1, true, true}, splines ? static_spline_ratio : 1e-6,
                             "unbalanced force / internal force");
    c.energy_ratio = s.number("energy_ratio", {0, 1, true, true}, splines ? 1e-6 : 1e-9,
                              "kinetic energy of the nodes / strain energy");
    c.check_every = s.integer("check_every", 1, most, 100, "steps");
    t.steps = s.integer("max_steps", 1, most, 1'000'000LL,
                        "the last step in any case; or, in place of until_static, steps");
    s.finish();
    t.until_static = c;
  } else {
    if (!r.has("steps")) r.missing("steps", "an integer >= 1, or a table until_static = {}");
    t.steps = r.integer("steps", 1, most, {}, "or a table until_static");
  }
  r.finish();
  return t;
}

StaticSpec read_static(TableReader r) {
  StaticSpec s;
  r.allow_only({"residual", "max_iterations"});
  s.residual = r.number("residual", {0, 1, true, true}, 1e-10, "relative, for vsb run --static");
  s.max_iterations = static_cast<int>(r.integer("max_iterations", 1, 100'000'000LL, 20'000LL));
  r.finish();
  return s;
}

constexpr const char* recovery_is_linear =
    "is for method.basis = \"linear\": it projects on the linear functions of the grid, and would take away "
    "what "
    "a smoother basis gains";

OutputSpec read_output(TableReader r, const Scene& scene) {
  std::vector<std::string> fields = {"id",     "displacement", "velocity",   "cauchy_stress",
                                     "volume", "mass",         "in_boundary"};
  const bool plastic = std::any_of(scene.bodies.begin(), scene.bodies.end(),
                                   [](const BodySpec& b) { return is_plastic(b.material.law); });
  if (plastic) fields.insert(fields.end(), {"plastic_strain", "equivalent_plastic_strain"});
  auto allowed = fields;
  allowed.emplace_back("recovered_stress");
  OutputSpec o;
  o.every =
      r.integer("every", 0, 1'000'000'000'000LL, 0, "steps between frames; 0: first and last state only");
  o.fields = r.texts("fields", allowed, fields);
  if (scene.method.basis != BasisKind::linear &&
      std::find(o.fields.begin(), o.fields.end(), allowed.back()) != o.fields.end())
    r.fail(*r.source().get("fields"), "fields", fmt::format("'{}' {}", allowed.back(), recovery_is_linear));
  o.grid = r.boolean("grid", false);
  o.checkpoint_minutes =
      r.number("checkpoint_minutes", Range::at_least(0), 10.0,
               "wall time; the first after one minute at the latest; 0: at an interrupt and the end only");
  r.finish();
  return o;
}

/// The largest traction over modulus for which (A1) is of use: it is off by a sixth of its cube.
constexpr double largest_printed_load = 0.01;

ColumnComparison read_column(TableReader& r, const MaterialSpec& material) {
  ColumnComparison c{};
  c.length = r.number("length", Range::positive(), {}, "m, L0 of Eq. (30)");
  Range range = Range::any();
  range.min = -largest_column_tension(material);
  c.traction = r.number("traction", range, {}, "Pa, positive in compression; not 0");
  if (c.traction == 0)
    r.fail(*r.source().get("traction"), "traction", "must not be 0, the errors being relative to it");
  c.printed_solution = material.law != MaterialLaw::hencky &&
                       std::abs(c.traction) <= largest_printed_load * constrained_modulus(material);
  return c;
}

YieldingCylinderComparison read_yielding_cylinder(TableReader& r, const MaterialSpec& material) {
  if (material.law != MaterialLaw::mohr_coulomb && material.law != MaterialLaw::tresca)
    r.fail(*r.source().get("solution"), "solution",
           "is for a body with law = \"mohr_coulomb\" or \"tresca\"");
  YieldingCylinderComparison c{};
  c.inner_radius = r.number("inner_radius", Range::positive(), {}, "m");
  c.outer_radius = r.number("outer_radius", {c.inner_radius, Range::any().max, true, false}, {}, "m");
  c.pressure = r.number("pressure", {0, collapse_pressure(c, material), true, true}, {},
                        "Pa, positive in compression, less than the collapse load");
  return c;
}

Comparison read_comparison(TableReader& document, const MaterialSpec& material, BasisKind basis,
                           MoreNorms& more) {
  if (!document.has("compare")) return {};
  TableReader r = document.table("compare");
  std::vector<std::string> keys = {"solution", "length", "traction",  "inner_radius", "outer_radius",
                                   "center",   "moved",  "recovered", "cell_means"};
  keys.insert(keys.end(), ellipse_keys.begin(), ellipse_keys.end());
  r.allow_only(keys);
  const std::string solution = r.choice("solution", {"column", "cylinder", "yielding_cylinder", "ellipse"});
  Comparison comparison;
  if (solution == "column") {
    comparison = read_column(r, material);
  } else if (solution == "cylinder") {
    CylinderComparison c{};
    c.inner_radius = r.number("inner_radius", Range::positive(), {}, "m");
    c.outer_radius = r.number("outer_radius", {c.inner_radius, Range::any().max, true, false}, {}, "m");
    c.pressure = r.number("pressure", Range::positive(), {}, "Pa, positive in compression");
    for (const auto& [key, point] : {std::pair{"center", &c.center}, std::pair{"moved", &c.moved}}) {
      const char* unit =
          key == std::string("center") ? "m, before it moves" : "m, carried as a whole at the end";
      const auto place = r.numbers(key, 2, Range::any(), std::vector<double>{0, 0}, unit);
      std::copy(place.begin(), place.end(), point->begin());
    }
    comparison = c;
  } else if (solution == "yielding_cylinder") {
    comparison = read_yielding_cylinder(r, material);
  } else {
    comparison = read_ellipse(r);
  }
  more.recovered = r.boolean("recovered", false);
  if (more.recovered && basis != BasisKind::linear)
    r.fail(*r.source().get("recovered"), "recovered", recovery_is_linear);
  more.cell_means = r.boolean("cell_means", false);
  r.finish();
  return comparison;
}

}  // namespace

std::vector<std::string> error_names(const Scene& scene) {
  std::vector<std::string> names, stresses;
  if (std::holds_alternative<ColumnComparison>(scene.compare)) {
    names = {"e_u_exact", "e_sigma"};
    if (std::get<ColumnComparison>(scene.compare).printed_solution) names.insert(names.begin(), "e_u");
    stresses = {"e_sigma"};
  } else if (std::holds_alternative<CylinderComparison>(scene.compare)) {
    names = {"e_rr", "e_tt", "e_u"};
    stresses = {"e_rr", "e_tt"};
  } else if (std::holds_alternative<YieldingCylinderComparison>(scene.compare)) {
    names = stresses = {"e_rr", "e_tt"};
  } else if (std::holds_alternative<EllipseComparison>(scene.compare)) {
    names = stresses = {"e_xx", "e_yy", "e_xy"};
  }
  if (scene.more_norms.recovered)
    for (const auto& name : stresses) names.push_back(name + "_recovered");
  if (scene.more_norms.cell_means)
    for (const auto& name : stresses) names.push_back(name + "_cell_mean");
  return names;
}

namespace {

/// What a source may say may be more than a run of the scene does: e_u at a large strain.
Published read_published(TableReader r, const Scene& scene) {
  Published p;
  auto names = error_names(scene);
  if (std::holds_alternative<ColumnComparison>(scene.compare) && names.front() != "e_u")
    names.emplace_back("e_u");
  auto keys = names;
  keys.emplace_back("source");
  r.allow_only(keys);
  p.source = r.text("source");
  for (const auto& name : names)
    if (r.has(name)) p.errors[name] = r.number(name, Range::at_least(0));
  r.finish();
  return p;
}

/// Whether anything strains or moves the bodies.
bool is_loaded(const Scene& scene) {
  const auto box = bounding_box(scene.grid, scene.dimension);
  const auto acts = [&](const TractionSpec& t) { return largest_stress(t.field, box.lower, box.upper) > 0; };
  const auto begins_loaded = [](const BodySpec& b) { return !is_zero(b.stress) || !is_zero(b.velocity); };
  return scene.gravity != Point{} || std::any_of(scene.tractions.begin(), scene.tractions.end(), acts) ||
         std::any_of(scene.bodies.begin(), scene.bodies.end(), begins_loaded);
}

/// Whether elastic bodies end without any force: the loads that they had are 0 from some time on.
bool ends_unloaded(const Scene& scene) {
  const auto elastic = [](const BodySpec& b) { return !is_plastic(b.material.law) && is_zero(b.stress); };
  const auto ends = [](const TractionSpec& t) { return t.time(t.time.settled_at()) == 0; };
  return scene.gravity == Point{} && !scene.tractions.empty() &&
         std::all_of(scene.bodies.begin(), scene.bodies.end(), elastic) &&
         std::all_of(scene.tractions.begin(), scene.tractions.end(), ends);
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
  const std::string name = r.text("name", name_of_file(path));
  if (name.empty() || name.size() > 200 || name[0] == '.' ||
      !std::all_of(name.begin(), name.end(),
                   [](char c) { return may_be_in_name(static_cast<unsigned char>(c)); }))
    r.fail(*r.source().get("name"), "name",
           "must be usable as a file name: 1 to 200 printable characters, no space or slash, no leading dot");
  return name;
}

/// Particles that go out of the grid take with them what else counts on them.
void refuse_outflow_beside(const TableReader& r, const Scene& scene) {
  if (!scene.faces.any_outflow()) return;
  const auto refuse = [&](const std::string& with) {
    r.fail(*r.source().get("faces"), "faces", "\"outflow\" is not for scenes with " + with);
  };
  if (scene.removal) refuse("removal, whose stages count all particles that are gone as failed");
  for (const auto& traction : scene.tractions)
    if (traction.imposition == Imposition::boundary_particles ||
        traction.imposition == Imposition::material_points)
      refuse(fmt::format("surface points, which would leave the grid as well (imposition of traction '{}')",
                         traction.name));
}

}  // namespace

Scene read_scene(const std::string& path, const std::vector<std::string>& overrides) {
  const toml::table document = parse_scene_file(path, overrides);
  ResolvedTable resolved;
  TableReader r(document, "", resolved);
  r.allow_only({"name", "title", "setting", "dimension", "precision", "gravity", "grid", "faces", "body",
                "traction", "method", "time", "static", "removal", "output", "compare", "published"});
  Scene scene;
  scene.name = read_name(r, path);
  scene.title = r.text("title", "");
  if (r.choice("setting", {"paper", "accurate"}, "paper") == "accurate") scene.setting = Setting::accurate;
  scene.dimension = static_cast<int>(r.integer("dimension", 1, 3));
  scene.single_precision = r.choice("precision", {"double", "float"}, "double") == "float";
  const auto gravity = r.numbers("gravity", static_cast<size_t>(scene.dimension), Range::any(),
                                 std::vector<double>(static_cast<size_t>(scene.dimension), 0.0), "m/s^2");
  std::copy(gravity.begin(), gravity.end(), scene.gravity.begin());
  if (!r.has("grid")) r.missing("grid", "a table with lower, upper and spacing");
  scene.grid = read_grid(r.table("grid"), scene.dimension);
  if (scene.grid.mapped() && scene.single_precision)
    r.fail(*document.get("precision"), "precision", "rectilinear and polar grids are for double precision");
  scene.faces = read_faces(r.table("faces"), scene.dimension, scene.grid);
  for (auto& table : r.tables("body")) scene.bodies.push_back(read_body(table, scene, scene.bodies.size()));
  if (scene.bodies.empty()) r.missing("body", "at least one table [[body]]");
  std::vector<TimeShape> time_shapes;
  for (auto& table : r.tables("traction")) {
    if (scene.tractions.size() == max_tractions)
      r.fail(*document.get("traction"), "traction", fmt::format("at most {} tractions", max_tractions));
    time_shapes.emplace_back();
    scene.tractions.push_back(read_traction(table, scene, scene.tractions.size(), time_shapes.back()));
  }
  read_method(r.table("method"), scene);
  const auto keeps_gradient = [](const BodySpec& b) { return b.material.law == MaterialLaw::hencky; };
  if (scene.method.volume_update != "determinant" &&
      std::any_of(scene.bodies.begin(), scene.bodies.end(), keeps_gradient))
    r.fail(*document["method"]["volume_update"].node(), "method.volume_update",
           "must be \"determinant\" with law = \"hencky\", whose stress is that of J = det F");
  if (!r.has("time")) r.missing("time", "a table with dt or kappa, and steps or until_static");
  scene.time = read_time(r.table("time"), scene);
  check_magnitudes(scene, r);
  for (size_t k = 0; k < time_shapes.size(); ++k) {
    scene.tractions[k].time = time_shapes[k].at(scene.time.dt);
    if (scene.time.until_static && !std::isfinite(scene.tractions[k].time.settled_at()))
      r.fail(*document["time"]["until_static"].node(), "time.until_static",
             fmt::format("traction '{}' is a sine, which never settles; give time.steps instead",
                         scene.tractions[k].name));
  }
  if (scene.time.until_static && !is_loaded(scene))
    r.fail(
        *document["time"]["until_static"].node(), "time.until_static",
        "nothing loads the bodies (no traction, gravity, initial stress or velocity), so there is no static "
        "state to run to");
  if (scene.time.until_static && ends_unloaded(scene))
    r.fail(*document["time"]["until_static"].node(), "time.until_static",
           "every traction ends at 0, where elastic bodies have no force left by which rest could be judged; "
           "give time.steps instead");
  scene.static_solution = read_static(r.table("static"));
  scene.removal = read_removal(r, scene);
  refuse_outflow_beside(r, scene);
  scene.output = read_output(r.table("output"), scene);
  scene.compare = read_comparison(r, scene.bodies.front().material, scene.method.basis, scene.more_norms);
  check_comparison(scene, r);
  for (auto& table : r.tables("published")) scene.published.push_back(read_published(table, scene));
  r.finish();
  scene.resolved = resolved.toml();
  return scene;
}

}  // namespace vsb::app
