// SPDX-License-Identifier: BSD-3-Clause
#include "report/cell_means.hpp"

#include <algorithm>
#include <map>

#include "setup/host_basis.hpp"

namespace vsb::app {

namespace {

struct Sums {
  double volume = 0;
  std::array<double, 3> position{};
  Stress6 stress{};
};

using CellSums = std::map<std::pair<int, size_t>, Sums>;  ///< of cell and body

template <class Basis>
void add_to_cells(const Basis& basis, const Snapshot& s, CellSums& cells) {
  const int first = static_cast<int>(s.first), last = first + static_cast<int>(s.count());
  for (size_t b = 0; b < s.bodies.size(); ++b)
    for (int n = std::max(first, s.bodies[b].first); n < std::min(last, s.bodies[b].last); ++n) {
      const auto p = static_cast<size_t>(n - first);
      const auto x = position_of<Basis::dimension>(s.position, p);
      auto& sums = cells[{basis.grid.cell_index(basis.grid.cell_containing(x)), b}];
      const double V = s.volume[p];
      sums.volume += V;
      for (size_t i = 0; i < 3; ++i) sums.position[i] += V * s.position[3 * p + i];
      for (size_t c = 0; c < 6; ++c) sums.stress[c] += V * s.cauchy_stress[6 * p + c];
    }
}

}  // namespace

CellMeans cell_means(const Scene& scene, const ParticleReader& particles) {
  CellSums cells;
  with_host_basis(scene, [&](const auto& basis) {
    particles.for_each_range(field::position | field::cauchy_stress | field::volume,
                             [&](const Snapshot& s) { add_to_cells(basis, s, cells); });
  });
  CellMeans means;
  for (const auto& [cell, sums] : cells) {
    means.volume.push_back(sums.volume);
    for (const double x : sums.position) means.position.push_back(x / sums.volume);
    for (const double stress : sums.stress) means.cauchy_stress.push_back(stress / sums.volume);
  }
  return means;
}

}  // namespace vsb::app
