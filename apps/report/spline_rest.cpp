// SPDX-License-Identifier: BSD-3-Clause
#include "report/spline_rest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vsb::app {

std::vector<std::string> spline_rest_advice(const Scene& scene) {
  std::vector<std::string> advice;
  if (scene.method.basis != BasisKind::quadratic_bspline) return advice;
  for (const auto& body : scene.bodies) {
    const auto* lattice = std::get_if<CellLattice>(&body.lattice);
    if (!lattice) continue;
    double most = 0, settles = 0;
    int count = 0;
    for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i) {
      const int n = lattice->particles_per_cell[i];
      const double varies = std::abs(body.stress.gradient[i][i]) * scene.grid.spacing[i];
      const double share = n == 2 ? 0.125 : 0.64 / (n * n);
      if (n % 2 != 0 || share * varies <= settles) continue;
      most = varies;
      settles = share * varies;
      count = n;
    }
    if (count == 0) continue;
    advice.push_back(
        fmt::format("body '{}' begins under a stress that varies by {:.3g} Pa over a cell: with B-splines "
                    "and {} particles "
                    "per cell it is not quite at rest, and settles by up to {:.2g} Pa at a free surface, a "
                    "third of it at "
                    "a support; particles_per_cell = 3 is at rest, and so is method.basis = \"linear\"",
                    body.name, most, count, settles));
  }
  return advice;
}

}  // namespace vsb::app
