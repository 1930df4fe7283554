// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Reads fields that are constant or affine in x.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "scene/stress_field.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

constexpr const char* stress_order = "tension positive: xx yy zz xy yz xz";

/// A row of numbers that varies in space: what it is at the origin, and what it gains along each axis.
struct AffineKeys : KeyTable {
  AffineKeys(std::string path, std::string purpose, size_t size, std::string row_unit, std::string row_order)
      : KeyTable(std::move(path), std::move(purpose)),
        count(size),
        unit(std::move(row_unit)),
        order(std::move(row_order)) {}

  size_t count;
  std::string unit, order;
  NumbersKey value{
      *this, "value", count, Range::any(), 0.0, unit, "at the origin of the coordinates" + order};
  NumbersKey dx{*this, "dx", count, Range::any(), 0.0, unit + " per m", "gained along x" + order};
  NumbersKey dy{*this, "dy", count, Range::any(), 0.0, unit + " per m", "gained along y" + order};
  NumbersKey dz{*this, "dz", count, Range::any(), 0.0, unit + " per m", "gained along z" + order};

  std::vector<const NumbersKey*> gradient() const { return {&dx, &dy, &dz}; }
  KeyList beyond(int dimension) const {
    KeyList keys{&dx, &dy, &dz};
    keys.erase(keys.begin(), keys.begin() + dimension);
    return keys;
  }
};

inline const AffineKeys affine_stress_keys{"traction.affine", "A stress that is affine in x.", 6, "Pa",
                                           std::string("; ") + stress_order};
inline const AffineKeys initial_stress_keys{"body.stress", "An initial stress that is affine in x.", 6, "Pa",
                                            std::string("; ") + stress_order};
inline const AffineKeys initial_velocity_keys{"body.velocity", "An initial velocity that is affine in x.",
                                              per_direction, "m/s", ""};

/// An array, or a table of AffineKeys.
struct AffineKey : NumbersKey {
  const AffineKeys& keys;

  AffineKey(KeyTable& in, std::string key_name, const AffineKeys& its_table, std::string key_sentence)
      : NumbersKey(in, std::move(key_name), its_table.count, Range::any(), 0.0, its_table.unit,
                   std::move(key_sentence)),
        keys(its_table) {
    type += ", or a table";
    inside = &its_table;
  }
};

/// The rows of a table, each of `count` numbers.
template <size_t N>
Affine<std::array<double, N>> read_affine_table(TableReader t, const AffineKeys& keys, size_t count,
                                                int dimension) {
  Affine<std::array<double, N>> field;
  t.refuse_empty("a table with value, and dx, dy, dz for what changes in space");
  const auto read = [&](const NumbersKey& key, std::array<double, N>& to) {
    const auto row = t.read(key.of(count));
    std::copy(row.begin(), row.end(), to.begin());
  };
  read(keys.value, field.value);
  for (size_t k = 0; k < static_cast<size_t>(dimension); ++k) read(*keys.gradient()[k], field.gradient[k]);
  t.finish();
  return field;
}

/// A field that is constant (an array) or affine (a table).
template <size_t N>
Affine<std::array<double, N>> read_affine(TableReader& r, const AffineKey& key, size_t count, int dimension) {
  const toml::node* written = r.written(key);
  if (written && written->is_table())
    return read_affine_table<N>(r.table(key, key.keys.beyond(dimension)), key.keys, count, dimension);
  Affine<std::array<double, N>> field;
  const auto row = r.read(key.of(count));
  std::copy(row.begin(), row.end(), field.value.begin());
  return field;
}

}  // namespace vsb::app
