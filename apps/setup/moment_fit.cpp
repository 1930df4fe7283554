// SPDX-License-Identifier: BSD-3-Clause
#include "setup/moment_fit.hpp"

// Sums in one order, on every machine.
#define EIGEN_DONT_PARALLELIZE
#define EIGEN_DONT_VECTORIZE
#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <map>

#include "setup/box_share.hpp"

namespace vsb::app {

namespace {

constexpr double least_share = 0.1;   ///< of the volume that the fit of the volume alone gives a particle
constexpr double round_off = 1e-13;   ///< of the moments, in shares of the body's volume in the cell
constexpr double least_pivot = 1e-8;  ///< below, particles are too few or in line

using Index = std::array<int, 3>;
using Vector = Eigen::VectorXd;

int coordinates_in(size_t product) {
  int count = 0;
  for (; product > 0; product >>= 1) count += static_cast<int>(product & 1);
  return count;
}

/// The particles of one cell; positions in shares of the cell, from its lower corner.
struct CellOfParticles {
  std::vector<Point> local;
  std::vector<double> volume;
};

/// The volumes that have the moments of the products of at most `degree` coordinates; empty if there are
/// none.
std::vector<double> fitted(const CellOfParticles& cell, const BoxMoments& moments, int dimension,
                           int degree) {
  std::vector<size_t> products;
  for (size_t k = 0; k < size_t(1) << dimension; ++k)
    if (coordinates_in(k) <= degree) products.push_back(k);
  const auto rows = static_cast<Eigen::Index>(products.size());
  const auto particles = static_cast<Eigen::Index>(cell.volume.size());
  if (particles < rows) return {};
  Eigen::MatrixXd m(rows, particles);
  Vector wanted(rows);
  for (Eigen::Index k = 0; k < rows; ++k) {
    const size_t product = products[static_cast<size_t>(k)];
    wanted[k] = moments[product];
    for (Eigen::Index p = 0; p < particles; ++p)
      m(k, p) = value_of_product(product, cell.local[static_cast<size_t>(p)]);
  }
  const Vector before = Eigen::Map<const Vector>(cell.volume.data(), particles);
  const Eigen::LDLT<Eigen::MatrixXd> gram(m * before.asDiagonal() * m.transpose());
  const Vector pivots = gram.vectorD();
  if (!(pivots.minCoeff() > least_pivot * pivots.maxCoeff())) return {};
  Vector V = before;
  // The second and third pass bring back the digits that forming the matrix loses.
  for (int pass = 0; pass < 3; ++pass) V += before.cwiseProduct(m.transpose() * gram.solve(wanted - m * V));
  const double ratio = moments[0] / before.sum();
  const bool exact = (wanted - m * V).cwiseAbs().maxCoeff() <= round_off * moments[0];
  if (!exact || (degree > 0 && (V - least_share * ratio * before).minCoeff() < 0)) return {};
  return {V.data(), V.data() + particles};
}

AxisBox box_of(const GridSpec& grid, const Index& cell) {
  AxisBox box{};
  for (size_t i = 0; i < 3; ++i) {
    box.lower[i] = grid.lower[i] + cell[i] * grid.spacing[i];
    box.upper[i] = grid.lower[i] + (cell[i] + 1) * grid.spacing[i];
  }
  return box;
}

void fit_body(const Scene& scene, const Region& region, const PlacedBody& body, PlacedParticles& placed,
              MomentFit& fit) {
  const auto& grid = scene.grid;
  const auto d = static_cast<size_t>(scene.dimension);
  std::map<Index, std::vector<size_t>> particles_of;
  for (auto p = static_cast<size_t>(body.first); p < static_cast<size_t>(body.last); ++p) {
    Index cell{};
    for (size_t i = 0; i < d; ++i)
      cell[i] =
          std::clamp(static_cast<int>(std::floor((placed.position[p][i] - grid.lower[i]) / grid.spacing[i])),
                     0, grid.cells[i] - 1);
    particles_of[cell].push_back(p);
  }
  for (const auto& [index, particles] : particles_of) {
    const AxisBox box = box_of(grid, index);
    const double cell_volume = volume_of(box, scene.dimension);
    const auto moments = moments_of(region, box, scene.dimension);
    if (moments[0] <= 0) {
      ++fit.cells[0];
      continue;
    }
    CellOfParticles cell;
    for (const size_t p : particles) {
      Point local{};
      for (size_t i = 0; i < d; ++i)
        local[i] = (placed.position[p][i] - box.lower[i]) / (box.upper[i] - box.lower[i]);
      cell.local.push_back(local);
      cell.volume.push_back(placed.volume[p] / cell_volume);
    }
    int degree = scene.dimension;
    auto volumes = fitted(cell, moments, scene.dimension, degree);
    while (volumes.empty()) volumes = fitted(cell, moments, scene.dimension, --degree);
    ++fit.cells[static_cast<size_t>(degree) + 1];
    for (size_t k = 0; k < particles.size(); ++k) placed.volume[particles[k]] = volumes[k] * cell_volume;
  }
}

}  // namespace

MomentFit fit_moments(const Scene& scene, PlacedParticles& placed) {
  MomentFit fit;
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    if (!is_irregular(scene.bodies[b])) continue;
    const auto& range = placed.bodies[b];
    const auto volume = [&] {
      double sum = 0;
      for (int p = range.first; p < range.last; ++p) sum += placed.volume[static_cast<size_t>(p)];
      return sum;
    };
    fit.volume_before += volume();
    fit_body(scene, scene.bodies[b].region, range, placed, fit);
    fit.volume_after += volume();
  }
  return fit;
}

}  // namespace vsb::app
