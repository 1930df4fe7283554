// SPDX-License-Identifier: BSD-3-Clause
#include "scene/key.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace vsb::app {

std::string number_text(double x) {
  if (std::isnan(x)) return "nan";
  if (std::isinf(x)) return x > 0 ? "inf" : "-inf";
  const std::string s = fmt::format("{}", x);
  return s.find_first_of(".e") == std::string::npos ? s + ".0" : s;
}

std::string Range::text() const {
  if (!words.empty()) return words;
  std::vector<std::string> parts;
  if (std::isfinite(min)) parts.push_back(fmt::format("{} {}", min_open ? ">" : ">=", min));
  if (std::isfinite(max)) parts.push_back(fmt::format("{} {}", max_open ? "<" : "<=", max));
  return fmt::format("{}", fmt::join(parts, " and "));
}

std::string Range::of(const std::string& noun) const {
  const std::string limits = text();
  return limits.empty() ? "finite " + noun : noun + " " + limits;
}

std::vector<std::string> names_of(const KeyList& keys) {
  std::vector<std::string> names;
  for (const auto* key : keys)
    if (std::find(names.begin(), names.end(), key->name) == names.end()) names.push_back(key->name);
  return names;
}

std::string KeyTable::path_of(const std::string& key) const {
  return name_.empty() ? key : name_ + "." + key;
}

Key::Key(KeyTable& in, std::string key_name, std::string key_type, std::string key_preset,
         std::string key_unit, std::string key_sentence, const KeyTable* key_inside)
    : table(&in),
      name(std::move(key_name)),
      type(std::move(key_type)),
      preset(std::move(key_preset)),
      unit(std::move(key_unit)),
      sentence(std::move(key_sentence)),
      inside(key_inside) {
  in.keys_.push_back(this);
}

std::string Key::remark() const {
  return unit + (unit.empty() || sentence.empty() ? "" : ", ") + sentence;
}

namespace {

/// From here on a limit only keeps squares and products finite: the reference leaves it out.
constexpr double no_limit = 1e100;

/// "number > 0", "number".
std::string limited(const std::string& noun, Range range) {
  if (range.min <= -no_limit) range.min = Range::any().min;
  if (range.max >= no_limit) range.max = Range::any().max;
  const std::string limits = range.text();
  return limits.empty() ? noun : noun + " " + limits;
}

std::string integer_type(long long min, long long max) {
  return max == std::numeric_limits<long long>::max() ? fmt::format("integer >= {}", min)
                                                      : fmt::format("integer from {} to {}", min, max);
}

std::string words_type(const std::vector<Word>& words) {
  std::vector<std::string> parts;
  for (const auto& word : words)
    parts.push_back(
        fmt::format("`\"{}\"`{}", word.word, word.remark.empty() ? "" : fmt::format(" ({})", word.remark)));
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace

NumberKey::NumberKey(KeyTable& in, std::string key_name, const Range& allowed,
                     const Preset<double>& key_preset, std::string key_unit, std::string key_sentence)
    : Key(in, std::move(key_name), limited("number", allowed), key_preset.text, std::move(key_unit),
          std::move(key_sentence)),
      range(allowed),
      fallback(key_preset.value) {}

NumberKey NumberKey::within(const Range& allowed) const {
  NumberKey key = *this;
  key.range = allowed;
  return key;
}

IntegerKey::IntegerKey(KeyTable& in, std::string key_name, long long least, long long most,
                       const Preset<long long>& key_preset, std::string key_unit, std::string key_sentence)
    : Key(in, std::move(key_name), integer_type(least, most), key_preset.text, std::move(key_unit),
          std::move(key_sentence)),
      min(least),
      max(most),
      fallback(key_preset.value) {}

BooleanKey::BooleanKey(KeyTable& in, std::string key_name, const Preset<bool>& key_preset,
                       std::string key_sentence)
    : Key(in, std::move(key_name), "`true` or `false`", key_preset.text, "", std::move(key_sentence)),
      fallback(key_preset.value) {}

TextKey::TextKey(KeyTable& in, std::string key_name, const Preset<std::string>& key_preset,
                 std::string key_sentence)
    : Key(in, std::move(key_name), "string", key_preset.text, "", std::move(key_sentence)),
      fallback(key_preset.value) {}

ChoiceKey::ChoiceKey(KeyTable& in, std::string key_name, const std::vector<Word>& allowed,
                     const Preset<std::string>& key_preset, std::string key_sentence)
    : Key(in, std::move(key_name), words_type(allowed), key_preset.text, "", std::move(key_sentence)),
      fallback(key_preset.value) {
  for (const auto& word : allowed) words.push_back(word.word);
}

ChoiceKey ChoiceKey::only(std::vector<std::string> possible) const {
  ChoiceKey key = *this;
  key.words = std::move(possible);
  return key;
}

NumbersKey::NumbersKey(KeyTable& in, std::string key_name, size_t size, const Range& allowed,
                       const Preset<double>& key_preset, std::string key_unit, std::string key_sentence)
    : Key(in, std::move(key_name),
          size == per_direction ? limited("array of numbers", allowed) + ", one per direction"
                                : limited(fmt::format("array of {} numbers", size), allowed),
          key_preset.value ? key_preset.text + " each" : key_preset.text, std::move(key_unit),
          std::move(key_sentence)),
      count(size),
      range(allowed),
      fallback(key_preset.value) {}

NumbersKey NumbersKey::of(size_t size) const {
  NumbersKey key = *this;
  key.count = size;
  return key;
}

NumberOrNumbersKey::NumberOrNumbersKey(KeyTable& in, std::string key_name, const Range& allowed,
                                       const Preset<double>& key_preset, std::string key_unit,
                                       std::string key_sentence)
    : NumberKey(in, std::move(key_name), allowed, key_preset, std::move(key_unit), std::move(key_sentence)) {
  type += ", or an array with one per direction";
}

IntegerOrIntegersKey::IntegerOrIntegersKey(KeyTable& in, std::string key_name, long long least,
                                           long long most, const Preset<long long>& key_preset,
                                           std::string key_unit, std::string key_sentence)
    : IntegerKey(in, std::move(key_name), least, most, key_preset, std::move(key_unit),
                 std::move(key_sentence)) {
  type += ", or an array with one per direction";
}

IncreasingKey::IncreasingKey(KeyTable& in, std::string key_name, const Preset<double>& key_preset,
                             std::string key_unit, std::string key_sentence)
    : Key(in, std::move(key_name), "array of at least two numbers, increasing", key_preset.text,
          std::move(key_unit), std::move(key_sentence)) {}

WordsKey::WordsKey(KeyTable& in, std::string key_name, std::string of_what, const InWords& key_preset,
                   std::string key_sentence)
    : Key(in, std::move(key_name), "array of " + std::move(of_what), key_preset.text, "",
          std::move(key_sentence)) {}

SubtableKey::SubtableKey(KeyTable& in, std::string key_name, const KeyTable& its_table,
                         const InWords& key_preset, std::string key_sentence)
    : Key(in, std::move(key_name), "table", key_preset.text, "", std::move(key_sentence), &its_table) {}

SubtablesKey::SubtablesKey(KeyTable& in, std::string key_name, const KeyTable& its_table,
                           const InWords& key_preset, std::string key_sentence)
    : Key(in, key_name, fmt::format("tables, each headed `[[{}]]`", in.path_of(key_name)), key_preset.text,
          "", std::move(key_sentence), &its_table) {}

OwnKey::OwnKey(KeyTable& in, std::string key_name, std::string form, const InWords& key_preset,
               std::string key_unit, std::string key_sentence, const KeyTable* key_inside)
    : Key(in, std::move(key_name), std::move(form), key_preset.text, std::move(key_unit),
          std::move(key_sentence), key_inside) {}

}  // namespace vsb::app
