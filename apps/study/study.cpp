// SPDX-License-Identifier: BSD-3-Clause
#include "study/study.hpp"

#include <algorithm>

#include "report/summary.hpp"

namespace vsb::app {

std::vector<std::string> Study::figures() const {
  if (chart) return chart->figures;
  std::vector<std::string> errors, others;
  for (const auto& s : series)
    for (const auto& c : s.cases) {
      if (!c.scene || !c.expected_failure.empty()) continue;
      auto& found = error_names(*c.scene).empty() ? others : errors;
      for (const auto& figure : default_figures(*c.scene, c.solution))
        if (std::find(found.begin(), found.end(), figure) == found.end()) found.push_back(figure);
    }
  return errors.empty() ? others : errors;
}

}  // namespace vsb::app
