// SPDX-License-Identifier: BSD-3-Clause
#include "scene/toml_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

namespace vsb::app {

namespace {

std::string number_text(double x) {
  if (std::isnan(x)) return "nan";
  if (std::isinf(x)) return x > 0 ? "inf" : "-inf";
  const std::string s = fmt::format("{}", x);
  return s.find_first_of(".e") == std::string::npos ? s + ".0" : s;
}

bool is_bare(const std::string& key) {
  return !key.empty() && std::all_of(key.begin(), key.end(),
                                     [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; });
}

std::string key_text(const std::string& key) {
  return is_bare(key) ? key : quoted(key);
}

std::string type_name(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "a string";
    case toml::node_type::integer:
      return "an integer";
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "a boolean";
    default:
      return "a date or time";
  }
}

std::string described(const toml::node& node) {
  std::string value = inline_toml(node);
  if (value.size() > 60) value = value.substr(0, 57) + "...";
  return fmt::format("{} ({})", value, type_name(node));
}

size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t(0));
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t above = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row.back();
}

}  // namespace

std::string quoted(const std::string& text) {
  std::ostringstream out;
  out << toml::toml_formatter{toml::value<std::string>(text)};
  return out.str();
}

std::string did_you_mean(const std::string& key, const std::vector<std::string>& known) {
  const auto nearest = std::min_element(known.begin(), known.end(), [&](const auto& a, const auto& b) {
    return edit_distance(key, a) < edit_distance(key, b);
  });
  if (nearest == known.end() || edit_distance(key, *nearest) > std::max<size_t>(2, key.size() / 3)) return "";
  return fmt::format("; did you mean '{}'?", *nearest);
}

std::string Range::text() const {
  std::vector<std::string> parts;
  if (std::isfinite(min)) parts.push_back(fmt::format("{} {}", min_open ? ">" : ">=", min));
  if (std::isfinite(max)) parts.push_back(fmt::format("{} {}", max_open ? "<" : "<=", max));
  return fmt::format("{}", fmt::join(parts, " and "));
}

std::string Range::of(const std::string& noun) const {
  const std::string limits = text();
  return limits.empty() ? "finite " + noun : noun + " " + limits;
}

std::string location(const toml::node& node) {
  const auto& source = node.source();
  const std::string path = source.path ? *source.path : "scene";
  if (path.rfind("--set", 0) == 0) return path;
  return fmt::format("{}:{}:{}", path, source.begin.line, source.begin.column);
}

std::string inline_toml(const toml::node& node) {
  std::vector<std::string> parts;
  if (const auto* table = node.as_table()) {
    for (const auto& [key, value] : *table)
      parts.push_back(fmt::format("{} = {}", key_text(std::string(key.str())), inline_toml(value)));
    return parts.empty() ? "{}" : fmt::format("{{ {} }}", fmt::join(parts, ", "));
  }
  if (const auto* array = node.as_array()) {
    for (const auto& value : *array) parts.push_back(inline_toml(value));
    return fmt::format("[{}]", fmt::join(parts, ", "));
  }
  if (const auto* number = node.as_floating_point()) return number_text(number->get());
  if (const auto* integer = node.as_integer()) return fmt::format("{}", integer->get());
  std::ostringstream out;
  out << toml::node_view<const toml::node>(node);
  return out.str();
}

std::string ResolvedTable::toml(const std::string& prefix) const {
  std::string out;
  size_t width = 0;
  for (const auto& v : values) width = std::max(width, v.comment.empty() ? 0 : v.key.size() + v.text.size());
  for (const auto& v : values) {
    out += fmt::format("{} = {}", v.key, v.text);
    if (!v.comment.empty())
      out += fmt::format("{:{}}  # {}", "", width - v.key.size() - v.text.size(), v.comment);
    out += "\n";
  }
  for (const auto& child : children) {
    const std::string path = prefix.empty() ? child.key : prefix + "." + child.key;
    out += fmt::format("\n{}{}{}\n", child.in_array ? "[[" : "[", path, child.in_array ? "]]" : "]");
    out += child.table->toml(path);
  }
  return out;
}

TableReader::TableReader(const toml::table& table, std::string path, ResolvedTable& resolved)
    : table_(&table), place_(&table), path_(std::move(path)), resolved_(&resolved) {}

std::string TableReader::name(const std::string& key) const {
  return path_.empty() ? key : path_ + "." + key;
}

bool TableReader::has(const std::string& key) const {
  return table_->contains(key);
}

void TableReader::allow_only(std::vector<std::string> keys) {
  for (const auto& [key, value] : *table_)
    if (std::find(keys.begin(), keys.end(), std::string(key.str())) == keys.end()) unknown(key, value, keys);
  allowed_ = std::move(keys);
}

const toml::node* TableReader::find(const std::string& key) {
  if (!allowed_.empty() && std::find(allowed_.begin(), allowed_.end(), key) == allowed_.end())
    throw std::logic_error(fmt::format("the key {} is read but not in allow_only", name(key)));
  known_.push_back(key);
  return table_->get(key);
}

void TableReader::fail(const toml::node& at, const std::string& key, const std::string& what) const {
  throw SceneError(fmt::format("{}: {} = {}: {}", location(at), name(key), described(at), what));
}

void TableReader::missing(const std::string& key, const std::string& what) const {
  const auto& source = place_->source();
  const bool written = static_cast<bool>(source.begin) || !source.path;
  throw SceneError(
      fmt::format("{}: {} is missing: {}", written ? location(*place_) : *source.path, name(key), what));
}

void TableReader::record(const std::string& key, const std::string& text, const std::string& comment) {
  resolved_->values.push_back({key_text(key), text, comment});
}

double checked_number(const TableReader& reader, const toml::node& node, const std::string& key,
                      const Range& range) {
  const auto value = node.value<double>();
  if (!(node.is_integer() || node.is_floating_point()) || !value)
    reader.fail(node, key, "must be a " + range.of("number"));
  const std::string limits = range.text();
  if (!std::isfinite(*value))
    reader.fail(node, key, "must be finite" + (limits.empty() ? "" : " and " + limits));
  if (!range.contains(*value)) reader.fail(node, key, "must be " + limits);
  if (std::fpclassify(*value) == FP_SUBNORMAL)
    reader.fail(node, key,
                fmt::format("is too small to compute with: must be 0 or at least {:.2g} in size",
                            std::numeric_limits<double>::min()));
  return *value;
}

double TableReader::number(const std::string& key, const Range& range, std::optional<double> fallback,
                           const std::string& unit) {
  const auto* node = find(key);
  if (!node && !fallback) missing(key, "a " + range.of("number"));
  const double value = node ? checked_number(*this, *node, key, range) : *fallback;
  record(key, number_text(value), unit);
  return value;
}

namespace {
long long checked_integer(const TableReader& reader, const toml::node& node, const std::string& key,
                          long long min, long long max) {
  const std::string allowed = max == std::numeric_limits<long long>::max()
                                  ? fmt::format(">= {}", min)
                                  : fmt::format("from {} to {}", min, max);
  const auto* value = node.as_integer();
  if (!value) reader.fail(node, key, "must be an integer " + allowed);
  if (value->get() < min || value->get() > max) reader.fail(node, key, "must be " + allowed);
  return value->get();
}
}  // namespace

long long TableReader::integer(const std::string& key, long long min, long long max,
                               std::optional<long long> fallback, const std::string& unit) {
  const auto* node = find(key);
  if (!node && !fallback) missing(key, fmt::format("an integer >= {}", min));
  const long long value = node ? checked_integer(*this, *node, key, min, max) : *fallback;
  record(key, fmt::format("{}", value), unit);
  return value;
}

bool TableReader::boolean(const std::string& key, std::optional<bool> fallback) {
  const auto* node = find(key);
  if (!node && !fallback) missing(key, "true or false");
  if (node && !node->is_boolean()) fail(*node, key, "must be true or false");
  const bool value = node ? node->as_boolean()->get() : *fallback;
  record(key, value ? "true" : "false");
  return value;
}

std::string TableReader::text(const std::string& key, std::optional<std::string> fallback) {
  const auto* node = find(key);
  if (!node && !fallback) missing(key, "a string");
  if (node && !node->is_string()) fail(*node, key, "must be a string");
  const std::string value = node ? node->as_string()->get() : *fallback;
  record(key, quoted(value));
  return value;
}

std::string TableReader::choice(const std::string& key, const std::vector<std::string>& allowed,
                                std::optional<std::string> fallback) {
  const auto* node = find(key);
  const std::string one_of = fmt::format("one of '{}'", fmt::join(allowed, "', '"));
  if (!node && !fallback) missing(key, one_of);
  if (node && !node->is_string()) fail(*node, key, "must be " + one_of);
  const std::string value = node ? node->as_string()->get() : *fallback;
  if (std::find(allowed.begin(), allowed.end(), value) == allowed.end())
    fail(*node, key, "must be " + one_of + did_you_mean(value, allowed));
  record(key, quoted(value), allowed.size() > 1 ? fmt::format("one of {}", fmt::join(allowed, ", ")) : "");
  return value;
}

std::vector<double> TableReader::numbers(const std::string& key, size_t count, const Range& range,
                                         std::optional<std::vector<double>> fallback,
                                         const std::string& unit) {
  const auto* node = find(key);
  const std::string what =
      fmt::format("an array of {} {}", count, range.of(count == 1 ? "number" : "numbers"));
  if (!node && !fallback) missing(key, what);
  std::vector<double> values;
  if (node) {
    const auto* array = node->as_array();
    if (!array || array->size() != count) fail(*node, key, "must be " + what);
    for (size_t i = 0; i < count; ++i)
      values.push_back(checked_number(*this, *array->get(i), fmt::format("{}[{}]", key, i), range));
  } else {
    values = *fallback;
  }
  std::vector<std::string> parts;
  for (const double x : values) parts.push_back(number_text(x));
  record(key, fmt::format("[{}]", fmt::join(parts, ", ")), unit);
  return values;
}

std::vector<double> TableReader::increasing_numbers(const std::string& key, const std::string& unit) {
  const char* what = "an array of at least two numbers, each greater than the one before";
  const auto* node = table_->get(key);
  if (!node) missing(key, what);
  const auto* array = node->as_array();
  if (!array || array->size() < 2) fail(*node, key, std::string("must be ") + what);
  auto values = numbers(key, array->size(), Range::any(), {}, unit);
  for (size_t i = 1; i < values.size(); ++i)
    if (!(values[i] > values[i - 1]))
      fail(*array->get(i), fmt::format("{}[{}]", key, i),
           fmt::format("must be > {}", number_text(values[i - 1])));
  return values;
}

std::vector<double> TableReader::number_or_numbers(const std::string& key, size_t count, const Range& range,
                                                   std::optional<double> fallback, const std::string& unit) {
  const auto* node = table_->get(key);
  if (node && node->is_array()) return numbers(key, count, range, {}, unit);
  return std::vector<double>(count, number(key, range, fallback, unit));
}

std::vector<int> TableReader::integer_or_integers(const std::string& key, size_t count, int min, int max,
                                                  std::optional<int> fallback, const std::string& unit) {
  const auto* node = table_->get(key);
  if (!node || !node->is_array())
    return std::vector<int>(count, static_cast<int>(integer(key, min, max, fallback, unit)));
  known_.push_back(key);
  const auto& array = *node->as_array();
  if (array.size() != count)
    fail(*node, key,
         fmt::format("must be an integer or an array of {} integers from {} to {}", count, min, max));
  std::vector<int> values;
  for (size_t i = 0; i < count; ++i)
    values.push_back(
        static_cast<int>(checked_integer(*this, *array.get(i), fmt::format("{}[{}]", key, i), min, max)));
  record(key, fmt::format("[{}]", fmt::join(values, ", ")), unit);
  return values;
}

std::vector<std::string> TableReader::texts(const std::string& key, const std::vector<std::string>& allowed,
                                            std::optional<std::vector<std::string>> fallback) {
  const auto* node = find(key);
  const std::string what = fmt::format("an array of '{}'", fmt::join(allowed, "', '"));
  if (!node && !fallback) missing(key, what);
  std::vector<std::string> values;
  if (node) {
    const auto* array = node->as_array();
    if (!array) fail(*node, key, "must be " + what);
    for (const auto& item : *array) {
      if (!item.is_string()) fail(item, key, "must be " + what);
      const std::string value = item.as_string()->get();
      if (std::find(allowed.begin(), allowed.end(), value) == allowed.end())
        fail(item, key,
             "must be one of '" + fmt::format("{}", fmt::join(allowed, "', '")) + "'" +
                 did_you_mean(value, allowed));
      if (std::find(values.begin(), values.end(), value) != values.end())
        fail(item, key, "must not name anything twice");
      values.push_back(value);
    }
  } else {
    values = *fallback;
  }
  std::vector<std::string> parts;
  for (const auto& s : values) parts.push_back(quoted(s));
  record(key, fmt::format("[{}]", fmt::join(parts, ", ")));
  return values;
}

const toml::node* TableReader::node(const std::string& key) {
  const auto* found = find(key);
  if (found) record(key, inline_toml(*found));
  return found;
}

TableReader TableReader::table(const std::string& key) {
  static const toml::table empty;
  const auto* node = find(key);
  if (node && !node->is_table()) fail(*node, key, "must be a table");
  resolved_->children.push_back({key_text(key), false, std::make_unique<ResolvedTable>()});
  TableReader reader(node ? *node->as_table() : empty, name(key), *resolved_->children.back().table);
  if (!node) reader.place_ = place_;
  return reader;
}

std::vector<TableReader> TableReader::tables(const std::string& key) {
  std::vector<TableReader> readers;
  const auto* node = find(key);
  if (!node) return readers;
  const auto* array = node->as_array();
  if (!array) fail(*node, key, fmt::format("must be tables, each headed [[{}]]", name(key)));
  for (size_t i = 0; i < array->size(); ++i) {
    const auto* table = array->get(i)->as_table();
    if (!table) fail(*array->get(i), key, fmt::format("must be tables, each headed [[{}]]", name(key)));
    resolved_->children.push_back({key_text(key), true, std::make_unique<ResolvedTable>()});
    readers.emplace_back(*table, fmt::format("{}[{}]", name(key), i), *resolved_->children.back().table);
  }
  return readers;
}

void TableReader::unknown(const toml::key& key, const toml::node& value,
                          std::vector<std::string> known) const {
  const auto& source = value.source();
  const bool from_command_line = source.path && source.path->rfind("--set", 0) == 0;
  const std::string text(key.str());
  const std::string suggestion = did_you_mean(text, known);
  std::sort(known.begin(), known.end());
  throw SceneError(
      fmt::format("{}: unknown key '{}'{}{} (allowed here: {})",
                  from_command_line ? location(value)
                                    : fmt::format("{}:{}:{}", source.path ? *source.path : "scene",
                                                  key.source().begin.line, key.source().begin.column),
                  text, path_.empty() ? "" : " in " + path_, suggestion, fmt::join(known, ", ")));
}

void TableReader::refuse_empty(const std::string& what) const {
  if (place_ != table_ || !table_->empty()) return;  // an absent table is not written
  throw SceneError(fmt::format("{}: {} = {{}}: must be {}", location(*table_), path_, what));
}

void TableReader::finish() const {
  for (const auto& [key, value] : *table_)
    if (std::find(known_.begin(), known_.end(), std::string(key.str())) == known_.end())
      unknown(key, value, known_);
}

}  // namespace vsb::app
