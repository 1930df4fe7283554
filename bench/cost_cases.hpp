// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The sizes of the cost table, and the paper's figures for them.
#pragma once

#include "scene.hpp"

namespace vsb::bench {

/// A row of the paper's Table 3: microseconds per particle and step, and what the traction adds in percent,
/// imposed on material points, on boundary particles, by the original and by the modified method.
struct PaperRow {
  double base_us, MP, BP, ORIG, MOD;
};

struct CostCase {
  std::string name;
  Size size;
  bool has_row;
  PaperRow row;
};

/// The sizes of a case: paper, 80k, 640k, block, large; none for an unknown name.
inline std::vector<CostCase> cost_cases(const std::string& name) {
  // Table 3: the mesh is 12 m long; beside the column there is void here, so that its sides can be loaded
  // too.
  if (name == "paper")
    return {{"640_ppc64", {"640_ppc64", 1, 10, 4, 1, 2}, true, {1.40, 1.10, 3.67, 1.55, 0.45}},
            {"5120_ppc64", {"5120_ppc64", 2, 20, 4, 1, 4}, true, {2.51, 2.51, 4.00, 2.09, 0.56}},
            {"80k_ppc64", {"80k_ppc64", 5, 50, 4, 1, 10}, true, {3.67, 3.99, 4.14, 2.79, 1.78}},
            {"640k_ppc64", {"640k_ppc64", 10, 100, 4, 1, 20}, true, {3.66, 4.77, 4.89, 2.41, 1.81}}};
  if (name == "80k") return {{"80k_ppc8", {"80k_ppc8", 10, 100, 2}, false, {}}};
  if (name == "640k") return {{"640k_ppc8", {"640k_ppc8", 20, 200, 2}, false, {}}};
  if (name == "block") return {{"block_ppc8", {"block_ppc8", 64, 64, 2}, false, {}}};
  if (name == "large") return {{"3.4m_ppc125", {"3.4m_ppc125", 15, 120, 5}, false, {}}};
  return {};
}

/// Rounds of a measurement: fewer, the longer a step takes.
inline int rounds_for(const Size& size, int asked) {
  if (asked > 0) return asked;
  return std::max(8, std::min(400, 4000000 / particle_count<3>(size)));
}

}  // namespace vsb::bench
