// SPDX-License-Identifier: BSD-3-Clause
#include "run/force_decay.hpp"

#include <algorithm>
#include <cmath>

namespace vsb::app {

namespace {

/// As many as show a trend, and as tell that there is none from the vibrations that a trend is made of.
constexpr size_t fewest = 6, fewest_to_stand = 30;
/// Beyond as many, every other one goes.
constexpr size_t most = 3000;
/// From a third of the steps to the next one.
constexpr double least_fall = 0.1;
/// Whose median is compared with the level, to find since when it is there.
constexpr size_t block = 5;

}  // namespace

void ForceDecay::observe(long long step, double force_ratio) {
  if (count_++ % stride_ != 0) return;
  seen_.emplace_back(step, force_ratio);
  if (seen_.size() < most) return;
  size_t n = 0;
  for (size_t i = 0; i < seen_.size(); i += 2) seen_[n++] = seen_[i];
  seen_.resize(n);
  stride_ *= 2;
}

double ForceDecay::median(size_t begin, size_t end) const {
  std::vector<double> ratios;
  for (size_t i = begin; i < end; ++i) ratios.push_back(seen_[i].second);
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return *middle;
}

std::optional<std::pair<double, double>> ForceDecay::medians() const {
  if (seen_.size() < fewest) return {};
  const size_t third = seen_.size() / 3, end = seen_.size();
  return std::pair{median(end - 2 * third, end - third), median(end - third, end)};
}

std::optional<long long> ForceDecay::reaches(double ratio) const {
  const auto both = medians();
  if (!both || stands() || !(both->second < both->first)) return {};
  const auto [before, last] = *both;
  const size_t third = seen_.size() / 3;
  const auto center = [&](size_t end) { return static_cast<double>(seen_[end - third + third / 2].first); };
  const double at = center(seen_.size()),
               decay = std::log(before / last) / (at - center(seen_.size() - third));
  const double end = at + std::log(last / ratio) / decay;
  if (!(end < 1e18)) return {};
  return std::max(seen_.back().first, std::llround(end));
}

std::optional<ForceDecay::Level> ForceDecay::stands() const {
  const auto both = medians();
  if (seen_.size() < fewest_to_stand || both->second < (1 - least_fall) * both->first) return {};
  const double level = both->second, most_of_it = level / (1 - least_fall);
  size_t since = seen_.size() - seen_.size() / 3;
  while (since >= block && median(since - block, since) <= most_of_it) since -= block;
  return Level{level, seen_[since].first};
}

}  // namespace vsb::app
