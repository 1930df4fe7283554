// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Strict reading of a TOML document: every key is read exactly once with its type and range, every key that
/// nobody read is an error, and everything read is recorded, defaults included, as the resolved document.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#define TOML_HEADER_ONLY 1
#include <toml++/toml.h>

#include "scene/scene_error.hpp"

namespace vsb::app {

/// Allowed values of a number.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_open = false, max_open = false;  ///< whether the limit itself is excluded

  static Range any() { return {}; }
  static Range positive() { return {0, std::numeric_limits<double>::infinity(), true, false}; }
  static Range at_least(double value) {
    return {value, std::numeric_limits<double>::infinity(), false, false};
  }
  static Range between(double low, double high) { return {low, high, false, false}; }
  static Range inside(double low, double high) { return {low, high, true, true}; }

  bool contains(double x) const { return (min_open ? x > min : x >= min) && (max_open ? x < max : x <= max); }
  std::string text() const;  ///< "> 0", ">= 0 and <= 1"; empty for any
  /// "number > 0", "finite numbers".
  std::string of(const std::string& noun) const;
};

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
  /// `path` is how messages call the table, such as "body[0]"; empty for the document.
  TableReader(const toml::table& table, std::string path, ResolvedTable& resolved);

  bool has(const std::string& key) const;

  /// Throws for any key but these. Called first, so that a misspelling is answered with all keys of the
  /// table.
  void allow_only(std::vector<std::string> keys);

  // Each reads one key; without a default the key must be there. `unit` becomes a comment of the resolved
  // document.
  double number(const std::string& key, const Range& range, std::optional<double> fallback = {},
                const std::string& unit = "");
  long long integer(const std::string& key, long long min, long long max,
                    std::optional<long long> fallback = {}, const std::string& unit = "");
  bool boolean(const std::string& key, std::optional<bool> fallback = {});
  std::string text(const std::string& key, std::optional<std::string> fallback = {});
  std::string choice(const std::string& key, const std::vector<std::string>& allowed,
                     std::optional<std::string> fallback = {});
  std::vector<double> numbers(const std::string& key, size_t count, const Range& range,
                              std::optional<std::vector<double>> fallback = {}, const std::string& unit = "");
  /// At least two numbers, each greater than the one before.
  std::vector<double> increasing_numbers(const std::string& key, const std::string& unit = "");
  /// One number for all `count` entries, or an array of `count` numbers.
  std::vector<double> number_or_numbers(const std::string& key, size_t count, const Range& range,
                                        std::optional<double> fallback = {}, const std::string& unit = "");
  std::vector<int> integer_or_integers(const std::string& key, size_t count, int min, int max,
                                       std::optional<int> fallback = {}, const std::string& unit = "");
  std::vector<std::string> texts(const std::string& key, const std::vector<std::string>& allowed,
                                 std::optional<std::vector<std::string>> fallback = {});

  /// The node of a key that the caller reads itself, recorded as written; nullptr where it is absent.
  const toml::node* node(const std::string& key);
  /// Records a value that was not read from the document.
  void record(const std::string& key, const std::string& text, const std::string& comment = "");

  /// A table inside this one; an absent one reads as empty.
  TableReader table(const std::string& key);
  /// The tables of an array of tables, possibly none.
  std::vector<TableReader> tables(const std::string& key);

  /// Throws where the table is written without a key; `what` is what it may have. For tables of which every
  /// key has a default, but which mean nothing without one.
  void refuse_empty(const std::string& what) const;

  /// Throws for any key that nobody read, suggesting the nearest known one.
  void finish() const;

  [[noreturn]] void fail(const toml::node& at, const std::string& key, const std::string& what) const;
  [[noreturn]] void missing(const std::string& key, const std::string& what) const;
  /// Throws for a key that is none of the known ones.
  [[noreturn]] void unknown(const toml::key& key, const toml::node& value,
                            std::vector<std::string> known) const;
  /// The key with its table's path in front: "body[0].density".
  std::string name(const std::string& key) const;
  const toml::table& source() const { return *table_; }

 private:
  const toml::node* find(const std::string& key);

  const toml::table* table_;
  const toml::table* place_;  ///< where its keys would be: itself, or the nearest table that is written
  std::string path_;
  ResolvedTable* resolved_;
  std::vector<std::string> allowed_;  ///< of allow_only; empty: not called
  std::vector<std::string> known_;    ///< asked for so far
};

/// The keys of an enumeration-like table or value that `key` resembles most, as ", did you mean 'x'?", or
/// nothing.
std::string did_you_mean(const std::string& key, const std::vector<std::string>& known);

/// A number that a scene gave as integer or float; throws through `reader` unless it is finite and in range.
double checked_number(const TableReader& reader, const toml::node& node, const std::string& key,
                      const Range& range);

/// Parses the file and applies the overrides of the command line.
toml::table parse_scene_file(const std::string& path, const std::vector<std::string>& overrides);

}  // namespace vsb::app
