// SPDX-License-Identifier: BSD-3-Clause
#include "report/recovered_stress.hpp"

// Sums in one order, on every machine.
#define EIGEN_DONT_PARALLELIZE
#define EIGEN_DONT_VECTORIZE
#define EIGEN_NO_CUDA  // on the host, also where nvcc compiles
#include <fmt/format.h>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>

#include "engine/simulation.hpp"
#include "setup/host_basis.hpp"

namespace vsb::app {

namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// The projection of one body. Unknowns are the nodes that the body's particles reach.
///
/// M is scaled to a unit diagonal, S M S with S = diag(M)^(-1/2), so that a node that only slivers reach is
/// found as well as any other. With few particles in a cell M may be singular: nodal values then are not
/// unique, but those at the particles are, and conjugate gradients give them.
template <class Basis>
class Projection {
 public:
  Projection(const Basis& basis, const Snapshot& s, const PlacedBody& body)
      : basis_(basis),
        s_(s),
        first_(static_cast<size_t>(body.first)),
        last_(static_cast<size_t>(body.last)),
        row_(static_cast<size_t>(basis.node_count()), -1) {
    number_nodes();
    assemble();
    solver_.setMaxIterations(2 * scale_.size() + 1000);
    solver_.compute(matrix_);
  }

  /// Component c of the stress at the particles, added to `to` (6 per particle).
  ///
  /// Solved once, then again for what is left at the particles, which brings back the digits that forming M
  /// loses where slivers lie among full particles.
  void project(size_t c, std::vector<double>& to) {
    const double all = add_solution(c, to, 0);
    if (all == 0) return;
    for (int pass = 0; pass < 3; ++pass)
      if (add_solution(c, to, all) <= round_off * all) break;
  }

 private:
  static constexpr int support = Basis::support;
  static constexpr double round_off = 1e-15;

  /// Adds the projection of what the particles' stress has beyond `to`; `all` is the norm of the right-hand
  /// side of the stress itself, 0 for the first call. Returns the norm of the right-hand side.
  double add_solution(size_t c, std::vector<double>& to, double all) {
    Vector right = Vector::Zero(scale_.size());
    for_each_value([&](size_t p, int row, double N) {
      right[row] += s_.volume[p] * N * (s_.cauchy_stress[6 * p + c] - to[6 * p + c]);
    });
    right = right.cwiseProduct(scale_);
    const double norm = right.norm();
    if (norm <= round_off * all) return norm;
    solver_.setTolerance(all == 0 ? 1e-12 : std::max(1e-4, 0.1 * round_off * all / norm));
    const Vector values = solver_.solve(right).cwiseProduct(scale_);
    if (all == 0 && !(solver_.error() < 1e-10))
      throw Diverged(
          fmt::format("in the recovery of the stress at time {:.6g} s: the projection was not found "
                      "(relative residual {:.2e} after {} iterations)",
                      s_.time, solver_.error(), solver_.iterations()));
    for_each_value([&](size_t p, int row, double N) { to[6 * p + c] += N * values[row]; });
    return norm;
  }

  /// Calls work(p, row, N) for every particle and node that it reaches.
  template <class Work>
  void for_each_value(const Work& work) const {
    for (size_t p = first_; p < last_; ++p) {
      const auto shape = basis_.shape(position_of<Basis::dimension>(s_.position, p));
      for (int a = 0; a < support; ++a)
        if (shape.N[a] > 0) work(p, row_[static_cast<size_t>(shape.node[a])], shape.N[a]);
    }
  }

  void number_nodes() {
    for (size_t p = first_; p < last_; ++p) {
      const auto shape = basis_.shape(position_of<Basis::dimension>(s_.position, p));
      for (int a = 0; a < support; ++a)
        if (shape.N[a] > 0) row_[static_cast<size_t>(shape.node[a])] = 0;
    }
    int rows = 0;
    for (int& row : row_)
      if (row == 0) row = rows++;
    scale_ = Vector::Zero(rows);
  }

  /// Neighbours of a node in a grid of cells are the 3^Dim nodes around it.
  void assemble() {
    constexpr int neighbours = Basis::dimension == 1 ? 3 : Basis::dimension == 2 ? 9 : 27;
    const auto rows = scale_.size();
    std::vector<double> value(static_cast<size_t>(rows) * neighbours, 0.0);
    std::vector<int> column(static_cast<size_t>(rows) * neighbours, -1);
    for (size_t p = first_; p < last_; ++p) {
      const auto shape = basis_.shape(position_of<Basis::dimension>(s_.position, p));
      for (int a = 0; a < support; ++a)
        for (int b = 0; b < support; ++b) {
          if (!(shape.N[a] > 0 && shape.N[b] > 0)) continue;
          const auto row = static_cast<size_t>(row_[static_cast<size_t>(shape.node[a])]);
          int neighbour = 0;
          for (int i = 0; i < Basis::dimension; ++i)
            neighbour = 3 * neighbour + 1 + (b >> i & 1) - (a >> i & 1);
          const size_t entry = row * neighbours + static_cast<size_t>(neighbour);
          value[entry] += s_.volume[p] * shape.N[a] * shape.N[b];
          column[entry] = row_[static_cast<size_t>(shape.node[b])];
        }
    }
    for (Eigen::Index I = 0; I < rows; ++I)
      scale_[I] = 1 / std::sqrt(value[static_cast<size_t>(I) * neighbours + neighbours / 2]);
    std::vector<Eigen::Triplet<double>> entries;
    for (Eigen::Index I = 0; I < rows; ++I)
      for (size_t k = static_cast<size_t>(I) * neighbours; k < (static_cast<size_t>(I) + 1) * neighbours; ++k)
        if (column[k] >= 0)
          entries.emplace_back(static_cast<int>(I), column[k], scale_[I] * value[k] * scale_[column[k]]);
    matrix_.resize(rows, rows);
    matrix_.setFromTriplets(entries.begin(), entries.end());
  }

  const Basis& basis_;
  const Snapshot& s_;
  size_t first_, last_;
  std::vector<int> row_;  ///< [node]: its unknown, or -1
  Vector scale_;
  Matrix matrix_;
  Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper, Eigen::IdentityPreconditioner> solver_;
};

}  // namespace

std::vector<double> recovered_stress(const Scene& scene, const Snapshot& particles) {
  std::vector<double> recovered(particles.cauchy_stress.size(), 0.0);
  with_host_basis(scene, [&](const auto& basis) {
    for (const auto& body : particles.bodies) {
      Projection projection(basis, particles, body);
      for (size_t c = 0; c < 6; ++c) projection.project(c, recovered);
    }
  });
  return recovered;
}

}  // namespace vsb::app
