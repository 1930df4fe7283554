// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The scene file with the overrides of the command line put in, before anything is checked.
#include <fmt/format.h>

#include <filesystem>
#include <sstream>
#include <variant>

#include "scene/toml_reader.hpp"

namespace vsb::app {

namespace {

/// Splits "body[0].density" into "body", 0, "density".
std::vector<std::variant<std::string, size_t>> split_path(const std::string& path,
                                                          const std::string& argument) {
  std::vector<std::variant<std::string, size_t>> parts;
  std::istringstream stream(path);
  for (std::string piece; std::getline(stream, piece, '.');) {
    const auto bracket = piece.find('[');
    parts.emplace_back(piece.substr(0, bracket));
    for (auto at = bracket; at != std::string::npos; at = piece.find('[', at + 1)) {
      const auto close = piece.find(']', at);
      const std::string digits = piece.substr(at + 1, close == std::string::npos ? 0 : close - at - 1);
      if (digits.empty() || digits.size() > 6 || digits.find_first_not_of("0123456789") != std::string::npos)
        throw SceneError(fmt::format("--set {}: '{}' needs an index like body[0]", argument, piece));
      parts.emplace_back(static_cast<size_t>(std::stoul(digits)));
    }
  }
  return parts;
}

/// The value text as TOML; a bare word is a string.
toml::table parse_value(const std::string& text, const std::string& source) {
  try {
    return toml::parse("value = " + text, source);
  } catch (const toml::parse_error&) {
    try {
      return toml::parse("value = " + quoted(text), source);
    } catch (const toml::parse_error& error) {
      throw SceneError(fmt::format("{}: {}", source, std::string(error.description())));
    }
  }
}

/// What is there to be removed by an override; throws where nothing is.
void remove_key(toml::table& table, const std::string& key, const std::string& source) {
  if (table.erase(key) > 0) return;
  std::vector<std::string> known;
  for (const auto& [name, value] : table) known.emplace_back(name.str());
  throw SceneError(fmt::format("{}: there is no '{}' to remove{}", source, key, did_you_mean(key, known)));
}

/// Replaces a value, adds it, or, where nothing follows the equals sign, removes it.
void apply_override(toml::table& document, const std::string& argument) {
  const auto equals = argument.find('=');
  if (equals == std::string::npos || equals == 0)
    throw SceneError(fmt::format(
        "--set {}: must be key=value, such as time.kappa=0.1, or key= to remove the key", argument));
  const std::string source = "--set " + argument;
  const bool removes = argument.find_first_not_of(" \t", equals + 1) == std::string::npos;
  auto value = removes ? toml::table() : parse_value(argument.substr(equals + 1), source);
  const auto parts = split_path(argument.substr(0, equals), argument);
  toml::node* node = &document;
  std::string so_far;
  for (size_t i = 0; i < parts.size(); ++i) {
    const bool last = i + 1 == parts.size();
    if (const auto* key = std::get_if<std::string>(&parts[i])) {
      auto* table = node->as_table();
      if (const auto* array = node->as_array(); array && !array->empty() && array->get(0)->is_table()) {
        throw SceneError(fmt::format("{}: '{}' is an array of tables; say which one: {}[0]{}", source, so_far,
                                     so_far, argument.substr(so_far.size(), equals - so_far.size())));
      }
      if (!table) throw SceneError(fmt::format("{}: '{}' is not inside a table", source, *key));
      if (last && removes) return remove_key(*table, *key, source);
      if (last) {
        table->insert_or_assign(*key, std::move(*value.get("value")));
        return;
      }
      if (!table->contains(*key)) {
        if (removes) return remove_key(*table, *key, source);
        if (std::holds_alternative<size_t>(parts[i + 1]))
          throw SceneError(fmt::format("{}: there is no '{}' in the scene", source, *key));
        table->insert(*key, toml::parse("", source));
      }
      node = table->get(*key);
      so_far += (so_far.empty() ? "" : ".") + *key;
    } else {
      auto* array = node->as_array();
      const size_t index = std::get<size_t>(parts[i]);
      if (!array || index >= array->size())
        throw SceneError(fmt::format("{}: there is no element {} (the array has {})", source, index,
                                     array ? array->size() : 0));
      if (last && removes) {
        array->erase(array->cbegin() + static_cast<std::ptrdiff_t>(index));
        return;
      }
      if (last) {
        array->replace(array->cbegin() + static_cast<std::ptrdiff_t>(index), std::move(*value.get("value")));
        return;
      }
      node = array->get(index);
      so_far += fmt::format("[{}]", index);
    }
  }
}

}  // namespace

toml::table parse_scene_file(const std::string& path, const std::vector<std::string>& overrides) {
  toml::table document;
  if (std::error_code error; std::filesystem::is_directory(path, error))
    throw SceneError(fmt::format("{}: is a directory, not a TOML file", path));
  try {
    document = toml::parse_file(path);
  } catch (const toml::parse_error& error) {
    const auto& begin = error.source().begin;
    throw SceneError(
        begin ? fmt::format("{}:{}:{}: {}", path, begin.line, begin.column, std::string(error.description()))
              : fmt::format("{}: {}", path, std::string(error.description())));
  }
  for (const auto& argument : overrides) apply_override(document, argument);
  return document;
}

}  // namespace vsb::app
