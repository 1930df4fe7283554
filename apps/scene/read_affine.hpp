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

/// The rows of a table with value and gradient, one row per direction.
template <size_t N>
Affine<std::array<double, N>> read_affine_table(TableReader t, size_t count, int dimension,
                                                const std::string& unit) {
  Affine<std::array<double, N>> field;
  t.refuse_empty("a table with value, and dx, dy, dz for what changes in space");
  const auto read = [&](const std::string& key, const std::string& what, std::array<double, N>& to) {
    const auto row = t.numbers(key, count, Range::any(), std::vector<double>(count, 0.0), what);
    std::copy(row.begin(), row.end(), to.begin());
  };
  read("value", unit, field.value);
  for (size_t k = 0; k < static_cast<size_t>(dimension); ++k)
    read(std::string("d") + "xyz"[k], unit + " per m", field.gradient[k]);
  t.finish();
  return field;
}

/// A field that is constant (an array) or affine (a table).
template <size_t N>
Affine<std::array<double, N>> read_affine(TableReader& r, const std::string& key, size_t count, int dimension,
                                          const std::string& unit) {
  const toml::node* written = r.source().get(key);
  if (written && written->is_table()) return read_affine_table<N>(r.table(key), count, dimension, unit);
  Affine<std::array<double, N>> field;
  const auto row = r.numbers(key, count, Range::any(), std::vector<double>(count, 0.0), unit);
  std::copy(row.begin(), row.end(), field.value.begin());
  return field;
}

}  // namespace vsb::app
