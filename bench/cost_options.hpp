// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The command line of vsb_cost.
#pragma once

#include "cost_cases.hpp"

#include <cstdlib>
#include <string>
#include <vector>

namespace vsb::bench {

struct CostOptions {
  std::vector<std::string> cases{"paper", "80k", "640k", "block"};
  int threads = 1, repeats = 0, axis = 0;
  bool naive = false, help = false;
  std::string json;   ///< file
  std::string error;  ///< what is wrong with the command line
};

constexpr const char* cost_usage =
    "vsb_cost [--case NAME] [--threads N] [--json FILE] [--naive] [--repeats N] [--axis x|y|z]\n"
    "  --case NAME   paper (Table 3: 640 to 640,000 particles, 64 per cell), 80k, 640k (8 per cell; 80k with "
    "a\n"
    "                translating block and a sparse grid), block (64^3 cells); default: all of these; large\n"
    "                (3,375,000, 125 per cell: re-map by the mass matrix)\n"
    "  --threads N   of the measurements; above 1 wall time counts, and the speed-up is printed; default 1\n"
    "  --json FILE   write all numbers there\n"
    "  --naive       time the particle kernels, too, and the traction by MP, BP, ORIG and MOD with them\n"
    "  --repeats N   rounds of every measurement; default: by size\n"
    "  --axis x      the direction of the column; lanes lie along x\n";

inline int positive_number(const std::string& text) {
  char* end = nullptr;
  const long n = std::strtol(text.c_str(), &end, 10);
  return end == text.c_str() || *end != '\0' || n < 1 || n > 1000000 ? -1 : static_cast<int>(n);
}

inline CostOptions read_cost_options(int argc, char** argv) {
  CostOptions o;
  for (int i = 1; i < argc && o.error.empty(); ++i) {
    const std::string key = argv[i];
    if (key == "--naive") {
      o.naive = true;
      continue;
    }
    if (key == "--help" || key == "-h") {
      o.help = true;
      return o;
    }
    if (key != "--case" && key != "--threads" && key != "--json" && key != "--repeats" && key != "--axis") {
      o.error = "unknown option " + key;
      break;
    }
    if (i + 1 == argc) {
      o.error = key + " wants a value";
      break;
    }
    const std::string value = argv[++i];
    if (key == "--case") {
      o.cases = {value};
      if (cost_cases(value).empty())
        o.error = "--case is '" + value + "'; it must be paper, 80k, 640k, block or large";
    } else if (key == "--json") {
      o.json = value;
    } else if (key == "--axis") {
      o.axis = value == "x" ? 0 : value == "y" ? 1 : value == "z" ? 2 : -1;
      if (o.axis < 0) o.error = "--axis is '" + value + "'; it must be x, y or z";
    } else {
      const int n = positive_number(value);
      if (n < 0) o.error = key + " is '" + value + "'; it must be a number from 1 on";
      (key == "--threads" ? o.threads : o.repeats) = n;
    }
  }
#if !defined(VSB_BACKEND_OPENMP)
  if (o.error.empty() && o.threads > 1) o.error = "--threads wants the OpenMP backend";
#endif
  return o;
}

}  // namespace vsb::bench
