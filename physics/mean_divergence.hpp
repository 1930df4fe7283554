// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Against volumetric locking: a mean thetabar_p over neighbouring particles replaces the divergence
/// theta_p = tr L_p of a particle,
///   L_p <- L_p + (beta / Dim) (thetabar_p - theta_p) I,
///   thetabar_p = sum_c M_c(x_p) theta_c,   theta_c = sum_p V_p M_c(x_p) theta_p / sum_p V_p M_c(x_p),
/// with functions M_c >= 0 whose sum is 1. The mean is symmetric in the product sum_p V_p a_p b_p and does
/// not increase it. Hence the expression of the nodal force is not changed, a stiffness stays symmetric, and
/// the stable time step does not become shorter.
///
/// For bases with one cell as support M_c is 1 in cell c: a mean per cell. For bases around the nearest node
/// M_c is the multilinear function around the centre of cell c. With these bases means over cells,
/// node-centred cells or blocks of cells are many times less accurate where the mean stress varies.
#pragma once

#include <vsb/physics/cell_basis.hpp>
#include <vsb/physics/nearest_node_basis.hpp>

namespace vsb {

/// The divergence that strains a particle.
enum class Volumetric {
  full,     ///< its own
  averaged  ///< the mean
};

/// beta, the share of the divergence that the mean replaces. Elastic: the mean enters lambda tr(eps) alone,
/// so that beta (lambda + 2 mu / Dim) = lambda; 0 where lambda is not positive. Plastic: 1, since plastic
/// flow is incompressible at any Poisson ratio.
template <int Dim, class Material>
auto averaged_share(const Material& material) {
  const auto elastic = material.small_strain_law();
  using Real = decltype(elastic.lambda);
  if (Material::plastic) return Real(1);
  const Real share = elastic.lambda / (elastic.lambda + 2 * elastic.shear_modulus / static_cast<Real>(Dim));
  return share > Real(0) ? share : Real(0);
}

/// L with the share `beta` of its divergence replaced by that of `mean`.
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION Matrix<Dim, T> with_mean_divergence(Matrix<Dim, T> L, T mean, T beta) {
  const T share = beta / T(Dim), correction = share * T(mean - trace(L));
  for (int i = 0; i < Dim; ++i) L(i, i) += correction;
  return L;
}

/// The functions M_c at one point.
template <int Support, class Real>
struct MeanShape {
  int function[Support];  ///< numbers c
  Real M[Support];        ///< values M_c >= 0 at the point, whose sum is 1
};

/// One function per cell, numbered as the bins are.
template <class Grid>
struct CellMeans {
  static constexpr int support = 1;  ///< functions at a point
  using real = typename Grid::real;  ///< type of the numbers

  Grid grid;  ///< whose cells these are

  /// Number of functions. A few of them belong to no cell.
  KOKKOS_FUNCTION int node_count() const { return grid.node_count(); }
  /// The bin of a cell's particles: the number of its function.
  KOKKOS_FUNCTION int bin_of_node(int function, int) const { return function; }
  /// At x, in a bin.
  KOKKOS_FUNCTION MeanShape<1, real> at(const Vector<Grid::dimension, real>&, int bin) const {
    return {{bin}, {real(1)}};
  }
  /// theta_c; sums(c, 0) and (c, 1) are those of V M_c and V M_c theta.
  template <class Sums>
  KOKKOS_FUNCTION real mean(int c, const Sums& sums) const {
    return sums(c, 0) > real(0) ? sums(c, 1) / sums(c, 0) : real(0);
  }
};

/// One function per cell, multilinear around its centre, numbered as the cell's lowest node. Those of ghost
/// cells beyond a wall are mirror images of those inside, so between a wall and the first centre that one is
/// constant.
///
/// A function with little particle volume, at a sliver of a body, would give a mean over one or two
/// particles. It is merged into the largest of its neighbours.
template <int Dim, class Real>
struct CentreMeans {
  static constexpr int support = 1 << Dim;  ///< functions at a point, 2^Dim
  /// Share of a cell's volume below which a function is merged into a neighbour.
  static constexpr Real least_fill = Real(0.1);
  /// Share of the largest neighbour's volume from which on a neighbour counts as equally large.
  static constexpr Real about_as_large = Real(0.95);

  UniformGrid<Dim, Real> grid;  ///< with its ghost layer
  Walls<Dim> walls;             ///< at the faces between the ghost layer and the other cells

  /// Number of functions. A few of them belong to no cell.
  KOKKOS_FUNCTION int node_count() const { return grid.node_count(); }
  /// The bin in which the function at corner a of the node-centred cell is `function`, or -1 where there is
  /// none.
  KOKKOS_FUNCTION int bin_of_node(int function, int a) const {
    auto nearest = grid.node_ijk(function);
    for (int i = 0; i < Dim; ++i)
      if (!(a >> i & 1) && ++nearest[i] > grid.cells[i]) return -1;
    return grid.node_index(nearest);
  }
  /// At x, in the bin of its nearest node.
  KOKKOS_FUNCTION MeanShape<support, Real> at(const Vector<Dim, Real>& x, int bin) const {
    const auto q = grid.in_cells(x);
    const auto nearest = grid.node_ijk(bin);
    Real above[Dim];
    for (int i = 0; i < Dim; ++i) {
      above[i] = Real(0.5) + q[i] - static_cast<Real>(nearest[i]);
      if (nearest[i] == 1 && walls.mirrored(i, 0)) above[i] = 1;
      if (nearest[i] == grid.cells[i] - 1 && walls.mirrored(i, 1)) above[i] = 0;
    }
    MeanShape<support, Real> shape;
    for (int a = 0; a < support; ++a) {
      shape.function[a] = bin + grid.corner_offset(a) - grid.corner_offset(support - 1);
      shape.M[a] = 1;
      for (int i = 0; i < Dim; ++i) shape.M[a] *= a >> i & 1 ? above[i] : 1 - above[i];
    }
    return shape;
  }
  /// theta_c of the function that c is merged into, or of c and the functions merged into it.
  template <class Sums>
  KOKKOS_FUNCTION Real mean(int c, const Sums& sums) const {
    const auto volume = [&](const Vector<Dim, int>& cell) { return sums(grid.node_index(cell), 0); };
    if (!(sums(c, 0) > Real(0))) return 0;
    const auto merged_into = merged_function(grid.node_ijk(c), volume);
    const int number = grid.node_index(merged_into);
    Real all = sums(number, 0), divergence = sums(number, 1);
    for_each_neighbour(merged_into, [&](const auto& n) {
      if (!is_small(volume(n)) || grid.node_index(merged_function(n, volume)) != number) return;
      all += volume(n);
      divergence += sums(grid.node_index(n), 1);
    });
    return divergence / all;
  }
  /// m^Dim
  KOKKOS_FUNCTION Real least_volume() const { return least_fill * grid.cell_volume(); }
  /// Whether a function of this volume in m^Dim is to be merged. Without particles it is not.
  KOKKOS_FUNCTION bool is_small(Real volume) const { return volume > Real(0) && volume < least_volume(); }
  /// The function that the function of a cell is merged into: the nearest of the equally large largest
  /// neighbours. The function itself where it is not small, or where all its neighbours are. volume(cell):
  /// the volume of a function.
  ///
  /// Along a straight surface neighbours differ by round-off alone, which must not decide.
  template <class Volume>
  KOKKOS_FUNCTION Vector<Dim, int> merged_function(const Vector<Dim, int>& cell, const Volume& volume) const {
    if (!is_small(volume(cell))) return cell;
    Real largest = 0;
    for_each_neighbour(cell, [&](const auto& n) { largest = math::max(largest, volume(n)); });
    auto merged_into = cell;
    int nearest = Dim + 1;
    const Real enough = math::max(least_volume(), about_as_large * largest);
    for_each_neighbour(cell, [&](const auto& n) {
      int axes = 0;
      for (int i = 0; i < Dim; ++i) axes += n[i] != cell[i];
      if (axes >= nearest || volume(n) < enough) return;
      nearest = axes;
      merged_into = n;
    });
    return merged_into;
  }
  /// The cells around, in order.
  template <class Work>
  KOKKOS_FORCEINLINE_FUNCTION void for_each_neighbour(const Vector<Dim, int>& cell, const Work& work) const {
    Vector<3, int> first{{0, 0, 0}}, last{{0, 0, 0}};
    for (int i = 0; i < Dim; ++i) {
      first[i] = math::max(cell[i] - 1, 0);
      last[i] = math::min(cell[i] + 1, grid.cells[i] - 1);
    }
    Vector<3, int> n;
    for (n[2] = first[2]; n[2] <= last[2]; ++n[2])
      for (n[1] = first[1]; n[1] <= last[1]; ++n[1])
        for (n[0] = first[0]; n[0] <= last[0]; ++n[0]) {
          Vector<Dim, int> neighbour;
          bool same = true;
          for (int i = 0; i < Dim; ++i) {
            neighbour[i] = n[i];
            same = same && n[i] == cell[i];
          }
          if (!same) work(neighbour);
        }
  }
};

///@{
/// The functions M_c that belong to a basis.
template <class Grid>
KOKKOS_FUNCTION CellMeans<Grid> means_of(const CellBasis<Grid>& basis) {
  return {basis.grid};
}
template <int Dim, class Real>
KOKKOS_FUNCTION CentreMeans<Dim, Real> means_of(const NearestNodeBasis<Dim, Real>& basis) {
  return {basis.grid, basis.walls};
}
///@}

}  // namespace vsb
