// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What this machine can do, measured: bytes per second through memory, and fused multiply-adds.
#pragma once

#include "cost_record.hpp"

namespace vsb::bench {

/// Adds "stream GB/s" (triad a = b + s c over arrays far larger than the caches, three words counted per
/// element) and "fma GF/s" (packs in registers, two operations each) to the record.
template <class Real>
void measure_rates(Record& record);

}  // namespace vsb::bench
