// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The measurements behind the cost table, by number type.
#pragma once

#include "cost_cases.hpp"
#include "cost_record.hpp"

namespace vsb::bench {

/// What to measure. Each measurement wants a process of its own.
template <class Real>
struct Measurements {
  static void engine(const CostCase& what, int axis, int repeats, Record& record);
  static void base(const CostCase& what, int axis, int repeats, Record& record);
  static void kernels(const CostCase& what, int axis, int repeats, Record& record);
  static void translation(int direction, Arrangement arrangement, int steps, Record& record);
  static void materials(Record& record);
  static void means(Record& record);
  static void sparse(Record& record);
  static void sparse_memory(bool is_sparse, Record& record);
};

}  // namespace vsb::bench
