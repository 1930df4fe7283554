// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Timing variants of a step in turns on one and the same state: two states differ by several percent from
/// their addresses in memory alone, and the same state from minute to minute by more.
#pragma once

#include "clock.hpp"

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace vsb::bench {

/// The value below which a share of all values lies.
inline double quantile(std::vector<double> x, double share) {
  const auto k = static_cast<std::ptrdiff_t>(share * static_cast<double>(x.size() - 1));
  std::nth_element(x.begin(), x.begin() + k, x.end());
  return x[static_cast<size_t>(k)];
}
inline double median(const std::vector<double>& x) {
  return quantile(x, 0.5);
}

struct Variant {
  std::string name;
  std::function<void()> step;
};

/// A variant against the base.
struct Extra {
  std::string name;
  double percent;  ///< median of variant / base - 1 over the rounds
  double seconds;  ///< median of variant - base
};

struct Rounds {
  std::vector<double> base;   ///< seconds of every step of the base
  std::vector<Extra> extras;  ///< of the variants; first "null", the base against itself
};

/// Seconds that work takes.
template <class Work>
double seconds_of(const Work& work) {
  const double start = now();
  work();
  Kokkos::fence();
  return now() - start;
}

/// Seconds of a step that follows two of its own kind: what came before a step decides what the caches hold.
inline double seconds_in_a_row(const Variant& variant) {
  variant.step();
  variant.step();
  return seconds_of(variant.step);
}

/// Every variant between two measurements of the base, with which it is compared, in every round; each round
/// begins with another one.
inline Rounds measure_in_turns(const Variant& base, std::vector<Variant> variants, int rounds) {
  variants.insert(variants.begin(), {"null", base.step});
  std::vector<std::vector<double>> ratio(variants.size()), difference(variants.size());
  Rounds found;
  seconds_in_a_row(base);
  double before = seconds_in_a_row(base);
  for (int round = 0; round < rounds; ++round)
    for (size_t k = 0; k < variants.size(); ++k) {
      const size_t v = (k + static_cast<size_t>(round) * 7) % variants.size();
      const double here = seconds_in_a_row(variants[v]), after = seconds_in_a_row(base),
                   around = 0.5 * (before + after);
      ratio[v].push_back(here / around);
      difference[v].push_back(here - around);
      found.base.push_back(after);
      before = after;
    }
  for (size_t v = 0; v < variants.size(); ++v)
    found.extras.push_back({variants[v].name, 100 * (median(ratio[v]) - 1), median(difference[v])});
  return found;
}

}  // namespace vsb::bench
