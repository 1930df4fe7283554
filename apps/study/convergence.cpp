// SPDX-License-Identifier: BSD-3-Clause
#include "study/convergence.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vsb::app {

namespace {

constexpr double round_off = 1e-13;  ///< of the values: smaller differences say nothing
constexpr double largest_rate = 20;  ///< no method converges faster; larger ones are chance

/// (h1^p - h2^p) / (h2^p - h3^p), which grows with p.
double ratio_for(double p, const std::array<double, 3>& h) {
  return (std::pow(h[0] / h[1], p) - 1) / (1 - std::pow(h[2] / h[1], p));
}

}  // namespace

Convergence convergence_of(std::array<double, 3> h, std::array<double, 3> f) {
  for (const auto& [i, k] : {std::pair(0u, 1u), std::pair(1u, 2u), std::pair(0u, 1u)})
    if (h[i] < h[k]) {
      std::swap(h[i], h[k]);
      std::swap(f[i], f[k]);
    }
  const double before = f[0] - f[1], after = f[1] - f[2];
  const double size = std::max({std::abs(f[0]), std::abs(f[1]), std::abs(f[2])});
  if (std::max(std::abs(before), std::abs(after)) <= round_off * size)
    return {{}, f[2], "the same but for round-off"};
  const double ratio = before / after;
  if (!(ratio > 0)) return {{}, {}, "not monotone: no rate"};
  if (!(ratio > std::log(h[0] / h[1]) / std::log(h[1] / h[2])))
    return {{}, {}, "differences do not fall: no rate"};
  double low = 0, high = largest_rate;
  if (!(ratio < ratio_for(high, h))) return {{}, {}, "differences fall too fast for a rate"};
  while (high - low > 1e-12) {
    const double middle = 0.5 * (low + high);
    (ratio_for(middle, h) < ratio ? low : high) = middle;
  }
  return {low, f[2] - after / (std::pow(h[1] / h[2], low) - 1), ""};
}

}  // namespace vsb::app
