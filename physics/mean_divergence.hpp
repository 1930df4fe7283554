// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Against volumetric locking: the divergence theta_p = tr L_p that strains a particle gives way to a mean
/// thetabar_p over its neighbours,
///   L_p <- L_p + (beta / Dim) (thetabar_p - theta_p) I,
///   thetabar_p = sum_c M_c(x_p) theta_c,   theta_c = sum_p V_p M_c(x_p) theta_p / sum_p V_p M_c(x_p),
/// with functions M_c >= 0 whose sum is 1. The mean is symmetric in the product sum_p V_p a_p b_p and never
/// increases it, so the force stays as it is, a stiffness symmetric, and the stable time step at least as
/// long.
///
/// For functions with one cell as support M_c is 1 in cell c: a mean per cell. For functions around the
/// nearest node it is the multilinear function around the centre of cell c. Means over cells, dual cells or
/// blocks of cells are many times less accurate there, wherever the mean stress varies.
#pragma once

#include <vsb/physics/cell_basis.hpp>
#include <vsb/physics/nearest_node_basis.hpp>

namespace vsb {

/// The divergence that strains a particle.
enum class Volumetric {
  full,     ///< its own
  averaged  ///< the mean
};

/// beta. Elastic: lambda tr(eps) alone takes the mean, beta (lambda + 2 mu / Dim) = lambda; where lambda is
/// not positive nothing does. Plastic: all, since plastic flow is incompressible at any Poisson ratio.
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
  int function[Support];
  Real M[Support];
};

/// One function per cell, numbered as the bins are.
template <class Grid>
struct CellMeans {
  static constexpr int support = 1;
  using real = typename Grid::real;

  Grid grid;

  KOKKOS_FUNCTION int node_count() const { return grid.node_count(); }
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
/// Functions that find little volume, at slivers of a body, would mean over a particle or two: the largest of
/// their neighbours takes them in.
template <int Dim, class Real>
struct CentreMeans {
  static constexpr int support = 1 << Dim;
  /// Share of a cell's volume below which a function goes to a neighbour.
  static constexpr Real least_fill = Real(0.1);

  UniformGrid<Dim, Real> grid;  ///< with its ghost layer
  Walls<Dim> walls;

  KOKKOS_FUNCTION int node_count() const { return grid.node_count(); }
  /// The bin in which the function at corner a of the dual cell is `function`, or -1 where there is none.
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
  /// theta_c of the function that c went to, or of c with those that came to it.
  template <class Sums>
  KOKKOS_FUNCTION Real mean(int c, const Sums& sums) const {
    if (!(sums(c, 0) > Real(0))) return 0;
    const int home = home_of(c, sums);
    Real volume = sums(home, 0), divergence = sums(home, 1);
    for_each_neighbour(home, [&](int n) {
      if (!is_small(n, sums) || home_of(n, sums) != home) return;
      volume += sums(n, 0);
      divergence += sums(n, 1);
    });
    return divergence / volume;
  }

 private:
  template <class Sums>
  KOKKOS_FUNCTION bool is_small(int c, const Sums& sums) const {
    return sums(c, 0) > Real(0) && sums(c, 0) < least_fill * grid.cell_volume();
  }
  /// The largest neighbour of a small function, if that is not small, too.
  template <class Sums>
  KOKKOS_FUNCTION int home_of(int c, const Sums& sums) const {
    int home = c;
    Real largest = least_fill * grid.cell_volume();
    if (!is_small(c, sums)) return c;
    for_each_neighbour(c, [&](int n) {
      if (sums(n, 0) < largest || (home != c && !(sums(n, 0) > largest))) return;
      largest = sums(n, 0);
      home = n;
    });
    return home;
  }
  /// The functions of the cells around, in order.
  template <class Work>
  KOKKOS_FORCEINLINE_FUNCTION void for_each_neighbour(int c, const Work& work) const {
    const auto cell = grid.node_ijk(c);
    constexpr int around = Dim == 1 ? 3 : Dim == 2 ? 9 : 27;
    for (int k = 0; k < around; ++k) {
      auto neighbour = cell;
      bool exists = k != around / 2;
      for (int i = 0, digits = k; i < Dim; ++i, digits /= 3) {
        neighbour[i] += digits % 3 - 1;
        exists = exists && neighbour[i] >= 0 && neighbour[i] < grid.cells[i];
      }
      if (exists) work(grid.node_index(neighbour));
    }
  }
};

template <class Grid>
KOKKOS_FUNCTION CellMeans<Grid> means_of(const CellBasis<Grid>& basis) {
  return {basis.grid};
}
template <int Dim, class Real>
KOKKOS_FUNCTION CentreMeans<Dim, Real> means_of(const NearestNodeBasis<Dim, Real>& basis) {
  return {basis.grid, basis.walls};
}

}  // namespace vsb
