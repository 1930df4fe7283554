// SPDX-License-Identifier: BSD-3-Clause
#include "scene/open_setting.hpp"

#include <algorithm>

#include "scene/scene_error.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

namespace {

bool says_something(const toml::table& document) {
  if (document.contains("setting") || document["method"]["basis"]) return true;
  const auto& bodies = *document["body"].as_array();
  return std::any_of(bodies.begin(), bodies.end(),
                     [](const toml::node& body) { return body.as_table()->contains("boundary"); });
}

}  // namespace

std::string open_setting_advice(const Scene& scene, const std::string& path,
                                std::vector<std::string> overrides) {
  if (says_something(parse_scene_file(path, overrides)) ||
      std::any_of(scene.bodies.begin(), scene.bodies.end(), is_irregular))
    return "";
  overrides.emplace_back("setting=accurate");
  try {
    read_scene(path, overrides);
  } catch (const SceneError&) {
    return "";
  }
  return "the scene does not say which setting: it takes \"paper\" (linear functions, whole particles); with "
         "setting = \"accurate\" stresses are often ten times as accurate, from fewer particles";
}

}  // namespace vsb::app
