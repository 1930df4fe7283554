// SPDX-License-Identifier: BSD-3-Clause
#include "run/cell_means.hpp"

#include <map>

#include "run/host_basis.hpp"

namespace vsb::app {

namespace {

template <class Basis>
CellMeans means_over_cells(const Basis& basis, const Snapshot& s) {
  struct Sums {
    double volume = 0;
    std::array<double, 3> position{};
    Stress6 stress{};
  };
  std::map<std::pair<int, size_t>, Sums> cells;  // of cell and body
  for (size_t b = 0; b < s.bodies.size(); ++b)
    for (int n = s.bodies[b].first; n < s.bodies[b].last; ++n) {
      const auto p = static_cast<size_t>(n);
      const auto x = place_of<Basis::dimension>(s.position, p);
      auto& sums = cells[{basis.grid.cell_index(basis.grid.cell_containing(x)), b}];
      const double V = s.volume[p];
      sums.volume += V;
      for (size_t i = 0; i < 3; ++i) sums.position[i] += V * s.position[3 * p + i];
      for (size_t c = 0; c < 6; ++c) sums.stress[c] += V * s.cauchy_stress[6 * p + c];
    }
  CellMeans means;
  for (const auto& [cell, sums] : cells) {
    means.volume.push_back(sums.volume);
    for (const double x : sums.position) means.position.push_back(x / sums.volume);
    for (const double stress : sums.stress) means.cauchy_stress.push_back(stress / sums.volume);
  }
  return means;
}

}  // namespace

CellMeans cell_means(const Scene& scene, const Snapshot& snapshot) {
  CellMeans means;
  with_host_basis(scene, [&](const auto& basis) { means = means_over_cells(basis, snapshot); });
  return means;
}

}  // namespace vsb::app
