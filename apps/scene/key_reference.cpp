// SPDX-License-Identifier: BSD-3-Clause
#include "scene/key_reference.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "scene/scene_error.hpp"
#include "scene/scene_keys.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

namespace {

using Tables = std::vector<const KeyTable*>;

/// The table and those inside it, each once, as they are declared.
void collect(const KeyTable& table, Tables& tables) {
  if (std::find(tables.begin(), tables.end(), &table) != tables.end()) return;
  tables.push_back(&table);
  for (const auto* key : table.keys())
    if (key->inside) collect(*key->inside, tables);
}

Tables tables_of(const KeyTable& document) {
  Tables tables;
  collect(document, tables);
  return tables;
}

std::string title(const KeyTable& table) {
  return table.name().empty() ? "Top of the file" : table.name();
}

/// "table ([grid.polar](#gridpolar))": anchors are headings without dots.
std::string type_of(const Key& key) {
  if (!key.inside) return key.type;
  std::string anchor = key.inside->name();
  anchor.erase(std::remove(anchor.begin(), anchor.end(), '.'), anchor.end());
  return fmt::format("{} ([{}](#{}))", key.type, key.inside->name(), anchor);
}

std::string cells_of(const Key& key) {
  return fmt::format("{} | {} | {} | {} |", type_of(key), key.unit, key.preset, key.sentence);
}

/// A table's heading, its purpose and some of its keys; neighbours that differ by name alone share a line.
std::string section(const KeyTable& table, const KeyList& keys) {
  std::string out = fmt::format(
      "## {}\n\n{}\n\n| key | type and range | unit | default | what it is |\n|---|---|---|---|---|\n",
      title(table), table.sentence());
  for (auto key = keys.begin(); key != keys.end();) {
    const std::string cells = cells_of(**key);
    KeyList alike;
    for (; key != keys.end() && cells_of(**key) == cells; ++key) alike.push_back(*key);
    out += fmt::format("| `{}` | {}\n", fmt::join(names_of(alike), "`, `"), cells);
  }
  return out;
}

/// Whether `name` is the path or ends it.
bool is_called(const std::string& path, const std::string& name) {
  return path == name || (path.size() > name.size() && path[path.size() - name.size() - 1] == '.' &&
                          path.compare(path.size() - name.size(), name.size(), name) == 0);
}

[[noreturn]] void refuse(const Tables& tables, const std::string& name) {
  std::vector<std::string> known, similar;
  for (const auto* table : tables)
    for (const auto& key : names_of(table->keys())) known.push_back(key);
  const std::string last = name.substr(name.rfind('.') + 1);
  for (const auto& key : known)
    if ((is_similar(last, key) || (last.size() > 2 && key.find(last) != std::string::npos)) &&
        std::find(similar.begin(), similar.end(), key) == similar.end())
      similar.push_back(key);
  throw SceneError(fmt::format("there is no key or table '{}'{}", name,
                               similar.empty()
                                   ? "; 'vsb keys' prints them all"
                                   : fmt::format("; similar ones are {}", fmt::join(similar, ", "))));
}

}  // namespace

std::string key_reference(const KeyTable& document, const std::string& introduction) {
  std::string out = introduction;
  for (const auto* table : tables_of(document)) out += "\n" + section(*table, table->keys());
  return out;
}

std::string key_reference_of(const KeyTable& document, const std::string& name) {
  const auto tables = tables_of(document);
  const auto is_asked = [&](const KeyTable& table) { return is_called(table.name(), name); };
  std::string out;
  for (const auto* table : tables) {
    KeyList keys;
    for (const auto* key : table->keys())
      if (is_called(table->path_of(key->name), name) && !(key->inside && is_asked(*key->inside)))
        keys.push_back(key);
    if (is_asked(*table)) keys = table->keys();
    if (!keys.empty()) out += (out.empty() ? "" : "\n") + section(*table, keys);
  }
  if (out.empty()) refuse(tables, name);
  return out;
}

std::string scene_key_reference() {
  return key_reference(scene_keys(),
                       "# Keys of a scene\n\n"
                       "Every table and every key that a scene may have. `vsb keys` prints this page from "
                       "the declarations by which scenes\n"
                       "are read; `vsb keys body.material` or `vsb keys friction_angle` prints a part of it. "
                       "Units are SI, stresses\n"
                       "tension-positive, pressures positive in compression. \"Per direction\" means as many "
                       "numbers as the scene has\n"
                       "dimensions. `vsb check SCENE` prints a scene with all its defaults. The guide is "
                       "`apps/scenes/README.md`.\n");
}

}  // namespace vsb::app
