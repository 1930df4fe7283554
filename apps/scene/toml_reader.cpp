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

bool is_similar(const std::string& word, const std::string& known) {
  return edit_distance(word, known) <= std::max<size_t>(2, word.size() / 3);
}

std::string did_you_mean(const std::string& key, const std::vector<std::string>& known) {
  const auto nearest = std::min_element(known.begin(), known.end(), [&](const auto& a, const auto& b) {
    return edit_distance(key, a) < edit_distance(key, b);
  });
  if (nearest == known.end() || !is_similar(key, *nearest)) return "";
  return fmt::format("; did you mean '{}'?", *nearest);
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

/// Comments of longer values stand behind these, and not in line with the others.
constexpr size_t widest_aligned = 60;

std::string ResolvedTable::toml(const std::string& prefix) const {
  std::string out;
  const auto length = [](const Value& v) { return v.key.size() + v.text.size(); };
  size_t width = 0;
  for (const auto& v : values)
    if (!v.comment.empty() && length(v) <= widest_aligned) width = std::max(width, length(v));
  for (const auto& v : values) {
    out += fmt::format("{} = {}", v.key, v.text);
    if (!v.comment.empty())
      out += fmt::format("{:{}}  # {}", "", width > length(v) ? width - length(v) : 0, v.comment);
    out += "\n";
  }
  for (const auto& child : children) {
    const std::string path = prefix.empty() ? child.key : prefix + "." + child.key;
    out += fmt::format("\n{}{}{}\n", child.in_array ? "[[" : "[", path, child.in_array ? "]]" : "]");
    out += child.table->toml(path);
  }
  return out;
}

TableReader::TableReader(const toml::table& table, std::string path, ResolvedTable& resolved,
                         const KeyTable& keys, const KeyList& left_out)
    : table_(&table), location_(&table), path_(std::move(path)), resolved_(&resolved), keys_(&keys) {
  if (keys.is_open()) return;
  KeyList allowed;
  std::copy_if(keys.keys().begin(), keys.keys().end(), std::back_inserter(allowed), [&](const Key* key) {
    return std::find(left_out.begin(), left_out.end(), key) == left_out.end();
  });
  const auto names = names_of(allowed);
  for (const auto& [key, value] : *table_)
    if (std::find(names.begin(), names.end(), std::string(key.str())) == names.end())
      unknown(key, value, names);
}

std::string TableReader::name(const std::string& key) const {
  return path_.empty() ? key : path_ + "." + key;
}

const toml::node* TableReader::written(const Key& key) const {
  if (key.table != keys_)
    throw std::logic_error(fmt::format("the key {} is asked of the table {}", key.name, path_));
  return table_->get(key.name);
}

const toml::node* TableReader::find(const Key& key) {
  const auto* found = written(key);
  known_.push_back(key.name);
  return found;
}

void TableReader::fail(const toml::node& at, const std::string& key, const std::string& what) const {
  throw SceneError(fmt::format("{}: {} = {}: {}", location(at), name(key), described(at), what));
}

void TableReader::fail(const Key& key, const std::string& what) const {
  const auto* node = written(key);
  if (!node) missing(key, what);
  fail(*node, key.name, what);
}

void TableReader::missing(const Key& key, const std::string& what) const {
  const auto& source = location_->source();
  const bool in_file = static_cast<bool>(source.begin) || !source.path;
  throw SceneError(fmt::format("{}: {} is missing: {}", in_file ? location(*location_) : *source.path,
                               name(key.name), what));
}

void TableReader::record(const Key& key, const std::string& text, const std::string& remark) {
  resolved_->values.push_back({key_text(key.name), text, remark});
}

double checked_number(const TableReader& reader, const toml::node& node, const std::string& key,
                      const Range& range) {
  if (!range.words.empty()) throw std::logic_error(fmt::format("the range of {} is not known", key));
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

namespace {

/// The default of the reading call, else that of the declaration.
template <class Value>
std::optional<Value> first_of(const std::optional<Value>& here, const std::optional<Value>& declared) {
  return here ? here : declared;
}

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

double TableReader::read(const NumberKey& key, std::optional<double> fallback) {
  const auto* node = find(key);
  fallback = first_of(fallback, key.fallback);
  if (!node && !fallback) missing(key, "a " + key.range.of("number"));
  const double value = node ? checked_number(*this, *node, key.name, key.range) : *fallback;
  record(key, number_text(value));
  return value;
}

long long TableReader::read(const IntegerKey& key, std::optional<long long> fallback) {
  const auto* node = find(key);
  fallback = first_of(fallback, key.fallback);
  if (!node && !fallback) missing(key, fmt::format("an integer >= {}", key.min));
  const long long value = node ? checked_integer(*this, *node, key.name, key.min, key.max) : *fallback;
  record(key, fmt::format("{}", value));
  return value;
}

bool TableReader::read(const BooleanKey& key, std::optional<bool> fallback) {
  const auto* node = find(key);
  fallback = first_of(fallback, key.fallback);
  if (!node && !fallback) missing(key, "true or false");
  if (node && !node->is_boolean()) fail(key, "must be true or false");
  const bool value = node ? node->as_boolean()->get() : *fallback;
  record(key, value ? "true" : "false");
  return value;
}

std::string TableReader::read(const TextKey& key, std::optional<std::string> fallback) {
  const auto* node = find(key);
  fallback = first_of(fallback, key.fallback);
  if (!node && !fallback) missing(key, "a string");
  if (node && !node->is_string()) fail(key, "must be a string");
  const std::string value = node ? node->as_string()->get() : *fallback;
  record(key, quoted(value));
  return value;
}

std::string TableReader::read(const ChoiceKey& key, std::optional<std::string> fallback) {
  const auto* node = find(key);
  const std::string one_of = fmt::format("one of '{}'", fmt::join(key.words, "', '"));
  fallback = first_of(fallback, key.fallback);
  if (!node && !fallback) missing(key, one_of);
  if (node && !node->is_string()) fail(key, "must be " + one_of);
  const std::string value = node ? node->as_string()->get() : *fallback;
  if (std::find(key.words.begin(), key.words.end(), value) == key.words.end())
    fail(key, "must be " + one_of + did_you_mean(value, key.words));
  const std::string choices =
      key.words.size() > 1 ? fmt::format("one of {}; ", fmt::join(key.words, ", ")) : "";
  record(key, quoted(value), choices + key.remark());
  return value;
}

std::vector<double> TableReader::numbers(const Key& key, size_t count, const Range& range,
                                         const std::optional<std::vector<double>>& fallback) {
  const auto* node = find(key);
  const std::string what =
      fmt::format("an array of {} {}", count, range.of(count == 1 ? "number" : "numbers"));
  if (!node && !fallback) missing(key, what);
  std::vector<double> values;
  if (node) {
    const auto* array = node->as_array();
    if (!array || array->size() != count) fail(key, "must be " + what);
    for (size_t i = 0; i < count; ++i)
      values.push_back(checked_number(*this, *array->get(i), fmt::format("{}[{}]", key.name, i), range));
  } else {
    values = *fallback;
  }
  std::vector<std::string> parts;
  for (const double x : values) parts.push_back(number_text(x));
  record(key, fmt::format("[{}]", fmt::join(parts, ", ")));
  return values;
}

std::vector<double> TableReader::read(const NumbersKey& key, std::optional<std::vector<double>> fallback) {
  if (!fallback && key.fallback) fallback = std::vector<double>(key.count, *key.fallback);
  return numbers(key, key.count, key.range, fallback);
}

std::vector<double> TableReader::read(const IncreasingKey& key) {
  const char* what = "an array of at least two numbers, each greater than the one before";
  const auto* node = written(key);
  if (!node) missing(key, what);
  const auto* array = node->as_array();
  if (!array || array->size() < 2) fail(key, std::string("must be ") + what);
  auto values = numbers(key, array->size(), Range::any(), {});
  for (size_t i = 1; i < values.size(); ++i)
    if (!(values[i] > values[i - 1]))
      fail(*array->get(i), fmt::format("{}[{}]", key.name, i),
           fmt::format("must be > {}", number_text(values[i - 1])));
  return values;
}

std::vector<double> TableReader::read(const NumberOrNumbersKey& key, size_t count,
                                      std::optional<double> fallback) {
  const auto* node = written(key);
  if (node && node->is_array()) return numbers(key, count, key.range, {});
  return std::vector<double>(count, read(static_cast<const NumberKey&>(key), fallback));
}

std::vector<int> TableReader::read(const IntegerOrIntegersKey& key, size_t count,
                                   std::optional<int> fallback) {
  const auto* node = written(key);
  if (!node || !node->is_array())
    return std::vector<int>(
        count, static_cast<int>(read(static_cast<const IntegerKey&>(key),
                                     fallback ? std::optional<long long>(*fallback) : std::nullopt)));
  find(key);
  const auto& array = *node->as_array();
  if (array.size() != count)
    fail(key,
         fmt::format("must be an integer or an array of {} integers from {} to {}", count, key.min, key.max));
  std::vector<int> values;
  for (size_t i = 0; i < count; ++i)
    values.push_back(static_cast<int>(
        checked_integer(*this, *array.get(i), fmt::format("{}[{}]", key.name, i), key.min, key.max)));
  record(key, fmt::format("[{}]", fmt::join(values, ", ")));
  return values;
}

std::vector<std::string> TableReader::words(const Key& key, const std::vector<std::string>& allowed,
                                            std::optional<std::vector<std::string>> fallback) {
  const auto* node = find(key);
  const std::string what = fmt::format("an array of '{}'", fmt::join(allowed, "', '"));
  if (!node && !fallback) missing(key, what);
  std::vector<std::string> values;
  if (node) {
    const auto* array = node->as_array();
    if (!array) fail(key, "must be " + what);
    for (const auto& item : *array) {
      if (!item.is_string()) fail(item, key.name, "must be " + what);
      const std::string value = item.as_string()->get();
      if (std::find(allowed.begin(), allowed.end(), value) == allowed.end())
        fail(item, key.name,
             "must be one of '" + fmt::format("{}", fmt::join(allowed, "', '")) + "'" +
                 did_you_mean(value, allowed));
      if (std::find(values.begin(), values.end(), value) != values.end())
        fail(item, key.name, "must not name anything twice");
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

const toml::node* TableReader::node(const Key& key) {
  const auto* found = find(key);
  if (found) record(key, inline_toml(*found), "");
  return found;
}

TableReader TableReader::table(const Key& key, const KeyList& left_out) {
  static const toml::table empty;
  const auto* node = find(key);
  if (node && !node->is_table()) fail(key, "must be a table");
  resolved_->children.push_back({key_text(key.name), false, std::make_unique<ResolvedTable>()});
  TableReader reader(node ? *node->as_table() : empty, name(key.name), *resolved_->children.back().table,
                     *key.inside, left_out);
  if (!node) reader.location_ = location_;
  return reader;
}

std::vector<TableReader> TableReader::tables(const SubtablesKey& key, const KeyList& left_out) {
  std::vector<TableReader> readers;
  const auto* node = find(key);
  if (!node) return readers;
  const auto* array = node->as_array();
  const std::string what = fmt::format("must be tables, each headed [[{}]]", name(key.name));
  if (!array) fail(key, what);
  for (size_t i = 0; i < array->size(); ++i) {
    const auto* table = array->get(i)->as_table();
    if (!table) fail(*array->get(i), key.name, what);
    resolved_->children.push_back({key_text(key.name), true, std::make_unique<ResolvedTable>()});
    readers.emplace_back(*table, fmt::format("{}[{}]", name(key.name), i), *resolved_->children.back().table,
                         *key.inside, left_out);
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
  if (location_ != table_ || !table_->empty()) return;  // an absent table is not written
  throw SceneError(fmt::format("{}: {} = {{}}: must be {}", location(*table_), path_, what));
}

void TableReader::finish() const {
  for (const auto& [key, value] : *table_)
    if (std::find(known_.begin(), known_.end(), std::string(key.str())) == known_.end())
      unknown(key, value, known_);
}

}  // namespace vsb::app
