// SPDX-License-Identifier: BSD-3-Clause
#include "scene/read_comparison.hpp"

#include <algorithm>
#include <cmath>

#include "scene/limits.hpp"
#include "scene/read_basis.hpp"
#include "scene/read_output.hpp"

namespace vsb::app {

namespace {

/// The errors of a solution, and those of them that are errors of the stress.
struct ErrorNames {
  std::vector<std::string> all, stresses;
};

/// In the order of Comparison.
std::vector<ErrorNames> errors_of_solutions() {
  static_assert(std::variant_size_v<Comparison> == 6);
  return {{{}, {}},
          {{"e_u", "e_u_exact", "e_sigma"}, {"e_sigma"}},
          {{"e_rr", "e_tt", "e_u"}, {"e_rr", "e_tt"}},
          {{"e_rr", "e_tt"}, {"e_rr", "e_tt"}},
          {{"e_xx", "e_yy", "e_xy"}, {"e_xx", "e_yy", "e_xy"}},
          {{"e_rr", "e_tt", "e_u"}, {"e_rr", "e_tt"}}};
}

constexpr const char* of_recovered = "_recovered";
constexpr const char* of_cell_means = "_cell_mean";

/// The largest traction over modulus for which (A1) is of use: it is off by a sixth of its cube.
constexpr double largest_printed_load = 0.01;

ColumnComparison read_column(TableReader& r, const MaterialSpec& material) {
  const auto& keys = compare_keys;
  ColumnComparison c{};
  c.length = r.read(keys.length);
  Range range = Range::any();
  range.min = -largest_column_tension(material);
  c.traction = r.read(keys.traction.within(range));
  if (c.traction == 0) r.fail(keys.traction, "must not be 0, the errors being relative to it");
  c.printed_solution = material.law != MaterialLaw::hencky &&
                       std::abs(c.traction) <= largest_printed_load * constrained_modulus(material);
  return c;
}

/// The radii of any cylinder.
template <class Cylinder>
Cylinder read_radii(TableReader& r) {
  Cylinder c{};
  c.inner_radius = r.read(compare_keys.inner_radius);
  c.outer_radius = r.read(compare_keys.outer_radius.within(Range::above(c.inner_radius)));
  return c;
}

CylinderComparison read_cylinder(TableReader& r) {
  const auto& keys = compare_keys;
  auto c = read_radii<CylinderComparison>(r);
  c.pressure = r.read(keys.pressure);
  const auto center = r.read(keys.center), moved = r.read(keys.moved);
  std::copy(center.begin(), center.end(), c.center.begin());
  std::copy(moved.begin(), moved.end(), c.moved.begin());
  return c;
}

YieldingCylinderComparison read_yielding_cylinder(TableReader& r, const MaterialSpec& material) {
  const auto& keys = compare_keys;
  if (material.law != MaterialLaw::mohr_coulomb && material.law != MaterialLaw::tresca)
    r.fail(keys.solution, "is for a body with law = \"mohr_coulomb\" or \"tresca\"");
  auto c = read_radii<YieldingCylinderComparison>(r);
  const auto pressure = keys.pressure.within({0, collapse_pressure(c, material), true, true});
  c.pressure = r.read(remarked(pressure, "less than the collapse load"));
  return c;
}

HenckyWallComparison read_hencky_wall(TableReader& r, const Scene& scene) {
  const auto& keys = compare_keys;
  const auto& material = scene.bodies.front().material;
  if (scene.dimension == 1 || material.law != MaterialLaw::hencky)
    r.fail(keys.solution, "is for a body with law = \"hencky\" in 2D or 3D");
  auto c = read_radii<HenckyWallComparison>(r);
  c.dimension = scene.dimension;
  c.pressure = r.read(keys.pressure);
  if (!bears_pressure(c, material))
    r.fail(keys.pressure,
           "is more than the wall can bear: no hole up to three times as wide is in equilibrium");
  const auto center = r.read(keys.center.of(static_cast<size_t>(scene.dimension)));
  std::copy(center.begin(), center.end(), c.center.begin());
  return c;
}

}  // namespace

PublishedKeys::PublishedKeys()
    : KeyTable("published",
               "Figures of a source, to print beside ours. Which there are depends on the solution.") {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const auto& solution : errors_of_solutions())
    for (const auto& name : solution.all) add(name);
  for (const auto& solution : errors_of_solutions())
    for (const auto& name : solution.stresses)
      for (const char* more : {of_recovered, of_cell_means}) add(name + more);
  for (const auto& name : names)
    errors.emplace_back(*this, name, Range::at_least(0), in_words("none"), "",
                        "the error as it is published");
}

const NumberKey& PublishedKeys::error(const std::string& name) const {
  return *std::find_if(errors.begin(), errors.end(), [&](const NumberKey& key) { return key.name == name; });
}

Comparison read_comparison(TableReader& document, const SubtableKey& key, const Scene& scene,
                           MoreNorms& more) {
  const auto& keys = compare_keys;
  if (!document.has(key)) return {};
  const auto& material = scene.bodies.front().material;
  TableReader r = document.table(key);
  const std::string solution = r.read(keys.solution);
  Comparison comparison;
  if (solution == "column")
    comparison = read_column(r, material);
  else if (solution == "cylinder")
    comparison = read_cylinder(r);
  else if (solution == "yielding_cylinder")
    comparison = read_yielding_cylinder(r, material);
  else if (solution == "hencky_wall")
    comparison = read_hencky_wall(r, scene);
  else
    comparison = read_ellipse(r, keys.ellipse);
  more.recovered = r.read(keys.recovered);
  if (more.recovered && scene.method.basis != BasisKind::linear)
    r.fail(keys.recovered, recovery_is_linear + linear_beside_setting(scene));
  more.cell_means = r.read(keys.cell_means);
  r.finish();
  return comparison;
}

std::vector<std::string> error_names(const Scene& scene) {
  auto [names, stresses] = errors_of_solutions()[scene.compare.index()];
  if (const auto* column = std::get_if<ColumnComparison>(&scene.compare); column && !column->printed_solution)
    names.erase(names.begin());  // e_u
  if (scene.more_norms.recovered)
    for (const auto& name : stresses) names.push_back(name + of_recovered);
  if (scene.more_norms.cell_means)
    for (const auto& name : stresses) names.push_back(name + of_cell_means);
  return names;
}

std::vector<Published> read_published(TableReader& document, const SubtablesKey& key, const Scene& scene) {
  const auto& keys = published_keys;
  auto names = error_names(scene);
  // What a source may say may be more than a run of the scene does: e_u at a large strain.
  if (std::holds_alternative<ColumnComparison>(scene.compare) && names.front() != "e_u")
    names.emplace_back("e_u");
  KeyList others;
  for (const auto& error : keys.errors)
    if (std::find(names.begin(), names.end(), error.name) == names.end()) others.push_back(&error);
  std::vector<Published> all;
  for (auto& r : document.tables(key, others)) {
    Published p;
    p.source = r.read(keys.source);
    for (const auto& name : names)
      if (const auto& error = keys.error(name); r.has(error)) p.errors[name] = r.read(error);
    r.finish();
    all.push_back(std::move(p));
  }
  return all;
}

}  // namespace vsb::app
