// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The keys of a scene or a study. Each is declared once, as a member of the table in which it stands:
///
///     struct BodyKeys : KeyTable {
///       NumberKey density{*this, "density", Range::positive(), required, "kg/m^3", "of the undeformed
///       body"};
///     };
///
/// Reading and the check for unknown keys (toml_reader.hpp), the remarks of `vsb check`, and the reference
/// that `vsb keys` prints (key_reference.hpp) follow from the declaration.
#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vsb::app {

/// Allowed values of a number.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_open = false, max_open = false;  ///< whether the limit itself is excluded
  std::string words{};  ///< of a range that depends on other values: the reading call must give it

  static Range any() { return {}; }
  static Range positive() { return above(0); }
  static Range above(double value) { return {value, std::numeric_limits<double>::infinity(), true, false}; }
  static Range at_least(double value) {
    return {value, std::numeric_limits<double>::infinity(), false, false};
  }
  static Range between(double low, double high) { return {low, high, false, false}; }
  static Range inside(double low, double high) { return {low, high, true, true}; }
  static Range in_words(std::string words) {
    Range range;
    range.words = std::move(words);
    return range;
  }

  bool contains(double x) const { return (min_open ? x > min : x >= min) && (max_open ? x < max : x <= max); }
  std::string text() const;  ///< "> 0", ">= 0 and <= 1"; empty for any
  /// "number > 0", "finite numbers".
  std::string of(const std::string& noun) const;
};

/// A value as TOML.
std::string number_text(double value);

/// A default that depends on other values: the reading call gives it, or does without.
struct InWords {
  std::string text;
};
inline InWords in_words(std::string text) {
  return {std::move(text)};
}

struct Required {
  operator InWords() const { return {"required"}; }
};
constexpr Required required;

/// What a key is where it is not written.
template <class Value>
struct Preset {
  std::optional<Value> value;  ///< none: it must be written, or the reading call says
  std::string text;            ///< for the reference

  Preset(Required words) : Preset(InWords(words)) {}
  Preset(InWords words) : text(std::move(words.text)) {}
  Preset(Value v) : value(v), text(code(v)) {}

 private:
  static std::string code(double v) { return "`" + number_text(v) + "`"; }
  static std::string code(long long v) { return "`" + std::to_string(v) + "`"; }
  static std::string code(bool v) { return v ? "`true`" : "`false`"; }
  static std::string code(const std::string& v) { return v.empty() ? "none" : "`\"" + v + "\"`"; }
};

class KeyTable;

/// What is said of a key of any type. A copy stands for the same key.
struct Key {
  const KeyTable* table;  ///< in which it stands
  std::string name;
  std::string type;                  ///< "number > 0"
  std::string preset;                ///< its default
  std::string unit;                  ///< may be empty
  std::string sentence;              ///< what it means
  const KeyTable* inside = nullptr;  ///< the table that is its value, or that its value may be

  /// Enters the key in its table, the declaration's position being that of the reference.
  Key(KeyTable& in, std::string key_name, std::string key_type, std::string key_preset, std::string key_unit,
      std::string key_sentence, const KeyTable* key_inside = nullptr);

  /// "m, corner of the grid": behind the value in the resolved document.
  std::string remark() const;
};

using KeyList = std::vector<const Key*>;

/// The names of keys, each once.
std::vector<std::string> names_of(const KeyList& keys);

/// The key with what the resolved document tells besides.
template <class AnyKey>
AnyKey remarked(AnyKey key, const std::string& more) {
  key.sentence += "; " + more;
  return key;
}

/// The key under another name, in an open table.
template <class AnyKey>
AnyKey called(AnyKey key, std::string name) {
  key.name = std::move(name);
  return key;
}

/// The keys that a table may have.
class KeyTable {
 public:
  /// `name` is the path of the table without indices, such as "body.material", and empty for the document;
  /// `sentence` says what it is for.
  KeyTable(std::string name, std::string sentence) : name_(std::move(name)), sentence_(std::move(sentence)) {}
  KeyTable(const KeyTable&) = delete;
  KeyTable& operator=(const KeyTable&) = delete;

  const std::string& name() const { return name_; }
  std::string path_of(const std::string& key) const;  ///< "body.material.law"
  const std::string& sentence() const { return sentence_; }
  /// In the order of declaration. Two of the same name are told apart by another key of the table.
  const KeyList& keys() const { return keys_; }
  /// Whether keys may have any name.
  bool is_open() const { return open_; }

 protected:
  /// Lets keys have any name; those declared stand for them.
  void leave_open() { open_ = true; }
  /// Adds to what the reference says of the table.
  void tell(const std::string& more) { sentence_ += " " + more; }

 private:
  friend struct Key;

  std::string name_, sentence_;
  KeyList keys_;
  bool open_ = false;
};

struct NumberKey : Key {
  Range range;
  std::optional<double> fallback;

  NumberKey(KeyTable& in, std::string key_name, const Range& allowed, const Preset<double>& key_preset,
            std::string key_unit, std::string key_sentence);
  /// The key with a range that follows from other values.
  NumberKey within(const Range& allowed) const;
};

struct IntegerKey : Key {
  long long min, max;
  std::optional<long long> fallback;

  IntegerKey(KeyTable& in, std::string key_name, long long least, long long most,
             const Preset<long long>& key_preset, std::string key_unit, std::string key_sentence);
};

struct BooleanKey : Key {
  std::optional<bool> fallback;

  BooleanKey(KeyTable& in, std::string key_name, const Preset<bool>& key_preset, std::string key_sentence);
};

struct TextKey : Key {
  std::optional<std::string> fallback;

  TextKey(KeyTable& in, std::string key_name, const Preset<std::string>& key_preset,
          std::string key_sentence);
};

/// A word of a choice; its remark is for the reference alone and may be empty.
struct Word {
  std::string word, remark;

  Word(const char* text) : word(text) {}
  Word(std::string text, std::string key_remark) : word(std::move(text)), remark(std::move(key_remark)) {}
};

/// One of some words. `first_word` makes the first one the default.
struct FirstWord {};
constexpr FirstWord first_word;

struct ChoiceKey : Key {
  std::vector<std::string> words;
  std::optional<std::string> fallback;

  ChoiceKey(KeyTable& in, std::string key_name, const std::vector<Word>& allowed,
            const Preset<std::string>& key_preset, std::string key_sentence);
  ChoiceKey(KeyTable& in, std::string key_name, const std::vector<Word>& allowed, FirstWord,
            std::string key_sentence)
      : ChoiceKey(in, std::move(key_name), allowed, allowed.front().word, std::move(key_sentence)) {}
  /// The key with those of its words that are possible beside other values.
  ChoiceKey only(std::vector<std::string> possible) const;
};

/// A choice whose words stand for values: {{"linear", BasisKind::linear}, ...}.
template <class Value>
struct ChoiceKeyOf : ChoiceKey {
  struct Option {
    const char* word;
    Value value;
    const char* remark = "";
  };
  std::vector<Value> values;  ///< of the words, in their order

  template <class Default>
  ChoiceKeyOf(KeyTable& in, std::string key_name, const std::vector<Option>& options, Default key_preset,
              std::string key_sentence)
      : ChoiceKey(in, std::move(key_name), words_of(options), std::move(key_preset),
                  std::move(key_sentence)) {
    for (const auto& option : options) values.push_back(option.value);
  }

  const std::string& word(const Value& value) const { return words[index(values, value)]; }
  Value value(const std::string& text) const { return values[index(words, text)]; }

 private:
  template <class Item>
  static size_t index(const std::vector<Item>& items, const Item& item) {
    return static_cast<size_t>(std::find(items.begin(), items.end(), item) - items.begin());
  }
  static std::vector<Word> words_of(const std::vector<Option>& options) {
    std::vector<Word> words;
    for (const auto& option : options) words.emplace_back(option.word, option.remark);
    return words;
  }
};

/// How many numbers an array has: as many as the scene has dimensions, which the reading call says.
constexpr size_t per_direction = 0;

/// An array of numbers. The default holds for each of them.
struct NumbersKey : Key {
  size_t count;
  Range range;
  std::optional<double> fallback;

  NumbersKey(KeyTable& in, std::string key_name, size_t size, const Range& allowed,
             const Preset<double>& key_preset, std::string key_unit, std::string key_sentence);
  /// The key with the size of its array, where that depends on the dimension.
  NumbersKey of(size_t size) const;
};

/// A number for all directions, or an array with one for each.
struct NumberOrNumbersKey : NumberKey {
  NumberOrNumbersKey(KeyTable& in, std::string key_name, const Range& allowed,
                     const Preset<double>& key_preset, std::string key_unit, std::string key_sentence);
};
struct IntegerOrIntegersKey : IntegerKey {
  IntegerOrIntegersKey(KeyTable& in, std::string key_name, long long least, long long most,
                       const Preset<long long>& key_preset, std::string key_unit, std::string key_sentence);
};

/// At least two numbers, each greater than the one before.
struct IncreasingKey : Key {
  IncreasingKey(KeyTable& in, std::string key_name, const Preset<double>& key_preset, std::string key_unit,
                std::string key_sentence);
};

/// An array of different words.
struct WordsKey : Key {
  WordsKey(KeyTable& in, std::string key_name, std::string of_what, const InWords& key_preset,
           std::string key_sentence);
};

/// A table inside the table.
struct SubtableKey : Key {
  SubtableKey(KeyTable& in, std::string key_name, const KeyTable& its_table, const InWords& key_preset,
              std::string key_sentence);
};
/// Tables, each headed [[key]].
struct SubtablesKey : Key {
  SubtablesKey(KeyTable& in, std::string key_name, const KeyTable& its_table, const InWords& key_preset,
               std::string key_sentence);
};

/// A value of a form of its own, which its reader checks. `inside`: the table that it may be.
struct OwnKey : Key {
  OwnKey(KeyTable& in, std::string key_name, std::string form, const InWords& key_preset,
         std::string key_unit, std::string key_sentence, const KeyTable* key_inside = nullptr);
};

}  // namespace vsb::app
