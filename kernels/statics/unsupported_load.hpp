// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Loads that no support takes up. Prescribed components suppress some of the rigid motions R_k of a body
/// (translations, and rotations about the body's middle, scaled to its size). The load on a motion is
///   F_k = sum_I R_k(x_I) . f_I   over the free components.
/// The unsupported load is the part of F outside the span of the rows R(x_I)_i of the prescribed components
/// (I, i). A static state exists only where it is zero. Particles that share nodes belong to one body.
///
/// Reads the forces and masses of all nodes. A host loop: it runs once per solution.
#pragma once

#include <vector>
#include <vsb/views/nodes.hpp>
#include <vsb/views/particle_bins.hpp>

namespace vsb {

/// The load of a body that no support takes up.
template <int Dim>
struct UnsupportedLoad {
  bool found = false;            ///< whether a body has one; else all members below are zero
  double share = 0;              ///< of the sum of the nodal forces on the body
  Vector<Dim, double> middle{};  ///< of the body's nodes, m
  Vector<Dim, double> force{};   ///< N
  Vector<3, double> torque{};    ///< about the middle, N m; in 1D zero, in 2D along z
};

namespace kernel {

template <class Grid, class Fields>
struct StoreNodePosition {
  Grid grid;
  Fields positions;
  KOKKOS_FUNCTION void operator()(int I) const {
    const auto x = grid.node_position(I);
    for (int i = 0; i < Grid::dimension; ++i) positions(I, i) = x[i];
  }
};

/// A set of disjoint sets of numbers.
class DisjointSets {
 public:
  explicit DisjointSets(int count) : parent_(static_cast<size_t>(count)) {
    for (int i = 0; i < count; ++i) parent_[static_cast<size_t>(i)] = i;
  }
  /// The lowest number of the set that i is in.
  int root(int i) {
    while (at(i) != i) i = at(i) = at(at(i));
    return i;
  }
  void join(int i, int j) {
    i = root(i);
    j = root(j);
    at(math::max(i, j)) = math::min(i, j);
  }

 private:
  int& at(int i) { return parent_[static_cast<size_t>(i)]; }
  std::vector<int> parent_;
};

/// Rigid motions of a body, as vectors of coefficients: translations first.
template <int Dim>
struct RigidMotions {
  static constexpr int count = Dim == 1 ? 1 : Dim == 2 ? 3 : 6;
  using Coefficients = Vector<count, double>;
  Vector<Dim, double> middle;
  double size;  ///< m

  /// Component i of every motion at x.
  Coefficients row(const Vector<Dim, double>& x, int i) const {
    auto r = Coefficients::zero();
    r[i] = 1;
    for (int k = Dim; k < count; ++k) {  // turning from axis j to axis l, about axis 3 - j - l
      const int j = turn_from(k), l = turn_to(k);
      if (i == j) r[k] = -(x[l] - middle[l]) / size;
      if (i == l) r[k] = (x[j] - middle[j]) / size;
    }
    return r;
  }
  static int turn_from(int k) { return Dim == 2 ? 0 : (k - Dim + 1) % 3; }
  static int turn_to(int k) { return Dim == 2 ? 1 : (k - Dim + 2) % 3; }
};

/// An orthonormal basis of what has been added to it.
template <int N>
class OrthonormalSpan {
 public:
  /// v without its part in the span.
  Vector<N, double> outside(Vector<N, double> v) const {
    for (int pass = 0; pass < 2; ++pass)  // twice, since one pass leaves round-off of the removed part
      for (const auto& q : basis_) v -= dot(q, v) * q;
    return v;
  }
  void add(const Vector<N, double>& v) {
    if (basis_.size() == N) return;
    const auto rest = outside(v);
    const double length = math::sqrt(dot(rest, rest));
    if (length > 1e-8 * math::sqrt(dot(v, v))) basis_.push_back((1 / length) * rest);
  }

 private:
  std::vector<Vector<N, double>> basis_;
};

}  // namespace kernel

/// The first body with a load of more than `tolerance` times the sum of its nodal forces that no support
/// takes up. `nodes.sums` and `bins` must be of the same particles. Waits for the device.
template <class Exec, class Basis, int Dim, class Real, class Device>
UnsupportedLoad<Dim> find_unsupported_load(const Exec& exec, const Nodes<Dim, Real, Device>& nodes,
                                           const ParticleBins<Device>& bins, const Basis& basis,
                                           double tolerance) {
  using Fields = typename Nodes<Dim, Real, Device>::Fields;
  using Motions = kernel::RigidMotions<Dim>;
  const int count = nodes.count();
  const Fields positions_on_device("vsb::node_positions", static_cast<size_t>(count), Dim);
  Kokkos::parallel_for(
      "vsb::store_node_position", Kokkos::RangePolicy<Exec>(exec, 0, count),
      kernel::StoreNodePosition<decltype(basis.grid), Fields>{basis.grid, positions_on_device});
  exec.fence();
  const auto on_host = [](const auto& view) {
    return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), view, "vsb::nodes on host");
  };
  const auto positions = on_host(positions_on_device), sums = on_host(nodes.sums);
  const auto fixed = on_host(nodes.fixed_components);
  const auto occupied = on_host(bins.occupied);
  const auto x = [&](int I) {
    Vector<Dim, double> position;
    for (int i = 0; i < Dim; ++i) position[i] = positions(I, i);
    return position;
  };

  kernel::DisjointSets sets(count);
  for (int s = 0; s < bins.occupied_count(); ++s) {
    int first = -1;
    for (int a = 0; a < Basis::support; ++a) {
      const int I = basis.node_of_bin(occupied(s), a);
      if (!(sums(I, 0) > 0)) continue;
      if (first < 0) first = I;
      sets.join(first, I);
    }
  }
  std::vector<std::vector<int>> bodies(static_cast<size_t>(count));
  for (int I = 0; I < count; ++I)
    if (sums(I, 0) > 0) bodies[static_cast<size_t>(sets.root(I))].push_back(I);

  for (const auto& body : bodies) {
    if (body.empty()) continue;
    Motions motions{Vector<Dim, double>::zero(), 0};
    for (const int I : body) motions.middle += (1.0 / static_cast<double>(body.size())) * x(I);
    for (const int I : body) {
      const auto d = x(I) - motions.middle;
      motions.size = math::max(motions.size, math::sqrt(dot(d, d)));
    }
    kernel::OrthonormalSpan<Motions::count> supported;
    auto load = Motions::Coefficients::zero();
    double sum = 0;
    for (const int I : body)
      for (int i = 0; i < Dim; ++i) {
        const auto row = motions.row(x(I), i);
        if (fixed(I) >> i & 1) {
          supported.add(row);
        } else {
          load += static_cast<double>(sums(I, 1 + Dim + i)) * row;
          sum += math::abs(static_cast<double>(sums(I, 1 + Dim + i)));
        }
      }
    const auto rest = supported.outside(load);
    const double size = math::sqrt(dot(rest, rest));
    if (!(size > tolerance * sum)) continue;
    UnsupportedLoad<Dim> found;
    found.found = true;
    found.share = size / sum;
    found.middle = motions.middle;
    for (int i = 0; i < Dim; ++i) found.force[i] = rest[i];
    found.torque = Vector<3, double>::zero();
    for (int k = Dim; k < Motions::count; ++k)
      found.torque[3 - Motions::turn_from(k) - Motions::turn_to(k)] = motions.size * rest[k];
    return found;
  }
  return {};
}

}  // namespace vsb
