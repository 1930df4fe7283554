// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Strict reading of a TOML document: every key is read exactly once with its type and range, every key that
/// nobody read is an error, and everything read is recorded, defaults included, as the resolved document.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#define TOML_HEADER_ONLY 1
#include <toml++/toml.h>

#include "scene/key.hpp"
#include "scene/scene_error.hpp"

namespace vsb::app {

/// Where a value was written: "file:line:column", or the command line's --set.
std::string location(const toml::node& node);

/// A value as TOML on one line.
std::string inline_toml(const toml::node& node);
/// A string as TOML, with quotes and escapes.
std::string quoted(const std::string& text);

/// The resolved document under construction; tables and arrays of tables in the order of reading.
struct ResolvedTable {
  struct Value {
    std::string key, text, comment;
  };
  struct Child {
    std::string key;
    bool in_array;
    std::unique_ptr<ResolvedTable> table;
  };
  std::vector<Value> values;
  std::vector<Child> children;

  std::string toml(const std::string& prefix = "") const;
};

/// One table of the document. Call finish() when everything known has been read.
class TableReader {
 public:
  /// `path` is how messages call the table, such as "body[0]"; empty for the document. Throws for any key
  /// that is none of `keys` but those left out, which a scene like this one cannot have, before anything is
  /// read, so that a misspelling is answered with all keys of the table.
  TableReader(const toml::table& table, std::string path, ResolvedTable& resolved, const KeyTable& keys,
              const KeyList& left_out = {});

  bool has(const Key& key) const { return written(key) != nullptr; }
  /// What is written, for messages and for keys of more than one form; nullptr where the key is absent.
  const toml::node* written(const Key& key) const;

  // Each reads one key, `fallback` being a default that only the reading call knows. Without any default the
  // key must be there. What the key means becomes a comment of the resolved document.
  double read(const NumberKey& key, std::optional<double> fallback = {});
  long long read(const IntegerKey& key, std::optional<long long> fallback = {});
  bool read(const BooleanKey& key, std::optional<bool> fallback = {});
  std::string read(const TextKey& key, std::optional<std::string> fallback = {});
  std::string read(const ChoiceKey& key, std::optional<std::string> fallback = {});
  template <class Value>
  Value read(const ChoiceKeyOf<Value>& key, std::optional<Value> fallback = {}) {
    return key.value(read(static_cast<const ChoiceKey&>(key),
                          fallback ? std::optional<std::string>(key.word(*fallback)) : std::nullopt));
  }
  std::vector<double> read(const NumbersKey& key, std::optional<std::vector<double>> fallback = {});
  std::vector<double> read(const IncreasingKey& key);
  std::vector<double> read(const NumberOrNumbersKey& key, size_t count, std::optional<double> fallback = {});
  std::vector<int> read(const IntegerOrIntegersKey& key, size_t count, std::optional<int> fallback = {});
  /// Different words of those allowed.
  std::vector<std::string> words(const Key& key, const std::vector<std::string>& allowed,
                                 std::optional<std::vector<std::string>> fallback = {});

  /// The node of a key that the caller reads itself, recorded as written; nullptr where it is absent.
  const toml::node* node(const Key& key);

  /// The table under a key that declares one; an absent one reads as empty.
  TableReader table(const Key& key, const KeyList& left_out = {});
  /// The tables of an array of tables, possibly none.
  std::vector<TableReader> tables(const SubtablesKey& key, const KeyList& left_out = {});

  /// Throws where the table is written without a key; `what` is what it may have. For tables of which every
  /// key has a default, but which mean nothing without one.
  void refuse_empty(const std::string& what) const;

  /// Throws for any key that nobody read, suggesting the nearest one of those read: keys that mean nothing
  /// beside the others of the table.
  void finish() const;

  /// Throws: what is wrong with the value of a key, or that it is missing.
  [[noreturn]] void fail(const Key& key, const std::string& what) const;
  [[noreturn]] void missing(const Key& key, const std::string& what) const;
  /// The same of a part of a value, or of a key of a table inside.
  [[noreturn]] void fail(const toml::node& at, const std::string& key, const std::string& what) const;
  /// The key with its table's path in front: "body[0].density".
  std::string name(const std::string& key) const;
  const toml::table& source() const { return *table_; }

 private:
  const toml::node* find(const Key& key);
  void record(const Key& key, const std::string& text, const std::string& remark);
  void record(const Key& key, const std::string& text) { record(key, text, key.remark()); }
  std::vector<double> numbers(const Key& key, size_t count, const Range& range,
                              const std::optional<std::vector<double>>& fallback);
  [[noreturn]] void unknown(const toml::key& key, const toml::node& value,
                            std::vector<std::string> known) const;

  const toml::table* table_;
  const toml::table* location_;  ///< where its keys would be: itself, or the nearest table that is written
  std::string path_;
  ResolvedTable* resolved_;
  const KeyTable* keys_;
  std::vector<std::string> known_;  ///< asked for so far
};

/// Whether a known word may have been meant by another one.
bool is_similar(const std::string& word, const std::string& known);
/// The keys of an enumeration-like table or value that `key` resembles most, as ", did you mean 'x'?", or
/// nothing.
std::string did_you_mean(const std::string& key, const std::vector<std::string>& known);

/// A number that a scene gave as integer or float; throws through `reader` unless it is finite and in range.
double checked_number(const TableReader& reader, const toml::node& node, const std::string& key,
                      const Range& range);

/// Parses the file and applies the overrides of the command line.
toml::table parse_scene_file(const std::string& path, const std::vector<std::string>& overrides);

}  // namespace vsb::app
