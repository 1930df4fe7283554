// SPDX-License-Identifier: BSD-3-Clause
#include "scene/resumable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "scene/toml_reader.hpp"

namespace vsb::app {

namespace {

constexpr std::array<const char*, 9> keys = {
    "title",  "output",     "compare",           "published",         "growth",
    "static", "time.steps", "time.until_static", "removal.max_stages"};

bool may_change(const std::string& key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

std::string text_of(const toml::node* node) {
  if (!node) return "missing";
  const std::string value = inline_toml(*node);
  return value.size() > 60 ? value.substr(0, 57) + "..." : value;
}

std::string difference(const std::string& key, const toml::node* before, const toml::node* now) {
  if (may_change(key)) return {};
  if (before && now && before->is_table() && now->is_table()) {
    std::set<std::string> names;
    for (const auto* table : {before->as_table(), now->as_table()})
      for (const auto& [name, value] : *table) names.emplace(name.str());
    for (const auto& name : names) {
      const auto found = difference(key.empty() ? name : key + "." + name, before->as_table()->get(name),
                                    now->as_table()->get(name));
      if (!found.empty()) return found;
    }
    return {};
  }
  if (before && now && before->is_array() && now->is_array()) {
    const auto &a = *before->as_array(), &b = *now->as_array();
    const size_t size = std::max(a.size(), b.size());
    for (size_t n = 0; n < size; ++n) {
      const auto found = difference(fmt::format("{}[{}]", key, n), n < a.size() ? a.get(n) : nullptr,
                                    n < b.size() ? b.get(n) : nullptr);
      if (!found.empty()) return found;
    }
    return {};
  }
  if (before && now && inline_toml(*before) == inline_toml(*now)) return {};
  return fmt::format("{} is {} there, and {} here", key, text_of(before), text_of(now));
}

}  // namespace

std::string resumable_keys() {
  return fmt::format("{} and {}", fmt::join(keys.begin(), keys.end() - 1, ", "), keys.back());
}

std::string obstacle_to_resume(const std::string& checkpoint, const std::string& run) {
  try {
    const toml::table before = toml::parse(checkpoint), now = toml::parse(run);
    return difference("", &before, &now);
  } catch (const toml::parse_error& error) {
    return fmt::format("its scene cannot be read ({})", std::string(error.description()));
  }
}

}  // namespace vsb::app
