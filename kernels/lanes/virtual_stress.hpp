// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The sums of a group of cell lanes with loaded nodes: those of kernels/lanes/sums.hpp, and at the loaded
/// nodes I the virtual stress, Eq. (27), Eq. (28):
///   f_I <- f_I + sum_p V_p (sbar(x_p) . grad N_I(x_p) + fbar(x_p) N_I(x_p)).
///
/// Four ways to compute this sum:
/// - all nodes of each cell are loaded or none is, and sbar is uniform, or affine along one direction without
///   shear as the pressure of water: sigma_p - sbar(x_p) replaces sigma_p in the sums of sums.hpp, and fbar
///   adds sum_p V_p fbar N_I(x_p);
/// - otherwise, uniform sbar: the sum follows from the volume moments sum_p V_p q_k(xi_p);
/// - otherwise, affine sbar: from these and from the moments with one direction squared, sum_p V_p xi_j^2
///   q_k(xi_p);
/// - any other field is evaluated particle by particle.
#pragma once

#include <vsb/kernels/lanes/masks.hpp>
#include <vsb/kernels/lanes/sums.hpp>
#include <vsb/physics/stress_fields.hpp>
#include <vsb/physics/uniform_grid.hpp>

namespace vsb {

/// What the sums of a loaded group need beside its particles.
template <int Dim, class Real, class Device>
struct LoadedLanes {
  CellLanes<Dim, Real, Device> lanes;                   ///< the packed particles
  UniformGrid<Dim, Real> grid;                          ///< of the cells in the lanes
  Kokkos::View<const TractionMask*, Device> tractions;  ///< [node of the lanes]: those that act there
};

namespace lane_sums {

/// Calls work(mask, bits) for every set of tractions that some node of the group has; bits[r] >> l & 1 tells
/// whether the node l of corner row r has it.
template <int Dim, class Real, class Device, class Work>
KOKKOS_FORCEINLINE_FUNCTION void for_each_mask(const LoadedLanes<Dim, Real, Device>& on,
                                               const LaneGroup<Dim>& group, const Work& work) {
  vsb::for_each_mask(group, group.node, group.loaded, on.tractions, work);
}

/// Adds t_a to f_a at the nodes whose bit is set; both are at the nodes.
template <int Dim, class P>
KOKKOS_FORCEINLINE_FUNCTION void add_where(const std::uint64_t* bits, const CellPolynomial<Dim, P>& t,
                                           CellPolynomial<Dim, P>& f) {
  static_for<f.size>([&](auto a) VSB_UNROLLED { f[a] += keep_lanes(bits[a >> 1] >> (a & 1), t[a]); });
}

/// sum_p V_p sbar . grad N_a from the volume moments, component by component, at the nodes whose bit is set.
template <int Dim, class P, class Real>
KOKKOS_FORCEINLINE_FUNCTION void add_uniform(const SymmetricTensor<Dim, Real>& bar,
                                             const Vector<Dim, Real>& inverse_spacing,
                                             const CellPolynomial<Dim, P>& volume, const std::uint64_t* bits,
                                             CellPolynomial<Dim, P> (&f)[Dim]) {
  bool diagonal = true;  // as a pressure is
  for (int c = 3; c < bar.size; ++c) diagonal = diagonal && bar[c] == Real(0);
  static_for<Dim>([&](auto a) VSB_UNROLLED {
    if (diagonal) {
      auto t = gradient_moments_along<a, Dim>(P(bar[a] * inverse_spacing[a]), volume);
      nodes_from_moments<Dim>(t);
      add_where<Dim>(bits, t, f[a]);
    } else {
      Vector<Dim, P> c;
      static_for<Dim>([&](auto i)
                          VSB_UNROLLED { c[i] = P(bar[symmetric_index(a, i)] * inverse_spacing[i]); });
      auto t = gradient_moments<Dim>(c, volume);
      nodes_from_moments<Dim>(t);
      add_where<Dim>(bits, t, f[a]);
    }
  });
}

/// The lower corner of the cell in lane 0 of a group, m.
template <int Dim, class Real, class Device>
KOKKOS_FORCEINLINE_FUNCTION Vector<Dim, Real> lower_corner(const LoadedLanes<Dim, Real, Device>& on,
                                                           const LaneGroup<Dim>& group) {
  return on.grid.map(on.lanes.cell(group, 0), Vector<Dim, Real>::zero()).x;
}

/// sum_p V_p (sbar(x_p) . grad N_a + fbar N_a) of an affine field from the second moments of the volume, at
/// the nodes whose bit is set.
template <int Dim, class P, class Real, class Device>
KOKKOS_FORCEINLINE_FUNCTION void add_affine(const LoadedLanes<Dim, Real, Device>& on,
                                            const LaneGroup<Dim>& group, const AffineStress<Dim, Real>& bar,
                                            const SecondMoments<Dim, P>& volume, const std::uint64_t* bits,
                                            CellPolynomial<Dim, P> (&f)[Dim]) {
  const auto& grid = on.grid;
  // sbar at the lower corner of every lane's cell.
  const auto first = bar.at(lower_corner(on, group)).stress;
  const P along_x = lane_numbers<P>() * P(grid.spacing[0]);
  static_for<Dim>([&](auto a) VSB_UNROLLED {
    Vector<Dim, P> b;
    Matrix<Dim, P> d;
    static_for<Dim>([&](auto i) VSB_UNROLLED {
      constexpr int c = symmetric_index(a, i);
      b[i] = (P(first[c]) + P(bar.gradient[0][c]) * along_x) * P(grid.inverse_spacing[i]);
      static_for<Dim>([&](auto j) VSB_UNROLLED {
        d(i, j) = P(bar.gradient[j][c] * grid.spacing[j] * grid.inverse_spacing[i]);
      });
    });
    auto t = gradient_moments<Dim>(b, d, volume);
    Real divergence = 0;
    for (int j = 0; j < Dim; ++j) divergence += bar.gradient[j](a, j);
    static_for<t.size>([&](auto k) VSB_UNROLLED { t[k] += P(divergence) * volume.m[k]; });
    nodes_from_moments<Dim>(t);
    add_where<Dim>(bits, t, f[a]);
  });
}

/// For fields that vary along direction j alone and have no shear: normal stress a is b + d xi_j in each cell
/// of a group. Returns its gradient along j in Pa/m.
template <int j, class Field, int Dim, class P, class Real, class Device>
KOKKOS_FORCEINLINE_FUNCTION Real along_cells(const LoadedLanes<Dim, Real, Device>& on,
                                             const LaneGroup<Dim>& group, const Field& field,
                                             TractionMask tractions, int a, P& b, P& d) {
  Real value, slope;
  field.sum_along(tractions, j, a, value, slope);
  b = P(value + slope * lower_corner(on, group)[j]);
  d = P(slope * on.grid.spacing[j]);
  if constexpr (j == 0) b += d * lane_numbers<P>();
  return slope;
}

/// add_affine for fields that vary along direction j alone and have no shear.
template <int j, class Field, int Dim, class P, class Real, class Device>
KOKKOS_FORCEINLINE_FUNCTION void add_affine_along(const LoadedLanes<Dim, Real, Device>& on,
                                                  const LaneGroup<Dim>& group, const Field& field,
                                                  TractionMask tractions, const SecondMoments<Dim, P>& volume,
                                                  const std::uint64_t* bits,
                                                  CellPolynomial<Dim, P> (&f)[Dim]) {
  static_for<Dim>([&](auto a) VSB_UNROLLED {
    P b, d;
    const Real slope = along_cells<j>(on, group, field, tractions, a, b, d);
    const P inverse_spacing(on.grid.inverse_spacing[a]);
    auto t = gradient_moments_along<a, j, Dim>(P(b * inverse_spacing), P(d * inverse_spacing), volume);
    if constexpr (a == j) static_for<t.size>([&](auto k) VSB_UNROLLED { t[k] += P(slope) * volume.m[k]; });
    nodes_from_moments<Dim>(t);
    add_where<Dim>(bits, t, f[a]);
  });
}

/// Moments of the volumes of a group; add(moments, V, xi) adds the particles of a slot.
template <int Dim, class Real, class Device, class Add>
KOKKOS_FORCEINLINE_FUNCTION SecondMoments<Dim, typename Lanes<Real>::Pack> second_moments(
    const CellLanes<Dim, Real, Device>& lanes, const LaneGroup<Dim>& group, const Add& add) {
  using P = typename Lanes<Real>::Pack;
  SecondMoments<Dim, P> volume;
  volume.set_zero();
  for (size_t entry = lanes.begin(group); entry < lanes.end(group); entry += P::width)
    add(volume, lanes.load(lanes.volume_column, entry), lanes.load_xi(entry));
  return volume;
}

/// Adds the affine fields at all loaded nodes of a group.
template <class Field, int Dim, class P, class Real, class Device>
KOKKOS_FORCEINLINE_FUNCTION void add_affine_fields(const LoadedLanes<Dim, Real, Device>& on,
                                                   const LaneGroup<Dim>& group, const Field& field,
                                                   CellPolynomial<Dim, P> (&f)[Dim]) {
  static_for<Dim>([&](auto j) VSB_UNROLLED {
    constexpr int along = j;
    if (field.axis != along) return;
    const auto volume = second_moments(on.lanes, group, [](auto& m, const P& V, const auto& xi) VSB_UNROLLED {
      m.template add_along<along>(V, xi);
    });
    for_each_mask(on, group, [&](TractionMask tractions, const std::uint64_t* bits) {
      add_affine_along<along>(on, group, field, tractions, volume, bits, f);
    });
  });
  if (field.axis >= 0) return;
  const auto volume =
      second_moments(on.lanes, group, [](auto& m, const P& V, const auto& xi) VSB_UNROLLED { m.add(V, xi); });
  for_each_mask(on, group, [&](TractionMask tractions, const std::uint64_t* bits) {
    add_affine(on, group, field.sum(tractions), volume, bits, f);
  });
}

/// sum_p V_p (sbar(x_p) . grad N_a + fbar(x_p) N_a) at the nodes, particle by particle.
template <class Field, int Dim, class Real, class Device, class P>
KOKKOS_FORCEINLINE_FUNCTION void function_traction(const LoadedLanes<Dim, Real, Device>& on,
                                                   const LaneGroup<Dim>& group, const Field& field,
                                                   TractionMask tractions, CellPolynomial<Dim, P> (&t)[Dim]) {
  const auto& lanes = on.lanes;
  static_for<Dim>([&](auto i) VSB_UNROLLED { set_zero<Dim>(t[i]); });
  for (size_t entry = lanes.begin(group); entry < lanes.end(group); entry += P::width) {
    const auto xi = lanes.load_xi(entry);
    const auto q = monomials<Dim>(xi);
    const P V = lanes.load(lanes.volume_column, entry);
    VirtualStressValue<Dim, P> bar;
    const LaneMask with_particle = lanes.with_particle(entry / P::width);
    for (int l = 0; l < P::width; ++l) {
      auto at = VirtualStressValue<Dim, Real>::zero();
      if (with_particle >> l & 1) {  // a field need not be finite at the position of a ghost
        Vector<Dim, Real> xi_l;
        for (int i = 0; i < Dim; ++i) xi_l[i] = xi[i][l];
        at = field.at(on.grid.map(lanes.cell(group, l), xi_l).x, tractions);
      }
      for (int c = 0; c < bar.stress.size; ++c) bar.stress[c].set(l, at.stress[c]);
      for (int i = 0; i < Dim; ++i) bar.divergence[i].set(l, at.divergence[i]);
    }
    static_for<Dim>([&](auto a) VSB_UNROLLED {
      Vector<Dim, P> w;
      static_for<Dim>([&](auto i) VSB_UNROLLED {
        w[i] = bar.stress[symmetric_index(a, i)] * V * P(on.grid.inverse_spacing[i]);
      });
      add_gradient_moments<Dim>(t[a], w, q);
      add_moments_of<Dim>(t[a], P(bar.divergence[a] * V), q);
    });
  }
  static_for<Dim>([&](auto a) VSB_UNROLLED { nodes_from_moments<Dim>(t[a]); });
}

}  // namespace lane_sums

/// Bit l: the cell in lane l is loaded, for groups in which all nodes of a cell are loaded or none is.
template <int Dim>
KOKKOS_FORCEINLINE_FUNCTION std::uint64_t loaded_cells(const LaneGroup<Dim>& group) {
  return group.loaded[0] & group.loaded[0] >> 1;
}

/// All sums of a group in which all nodes of a cell are loaded or none is, by a uniform field.
template <bool EqualSpacing, class Field, int Dim, class Real, class Device>
[[gnu::noinline, gnu::flatten]] KOKKOS_FUNCTION void sum_whole_group(const LoadedLanes<Dim, Real, Device>& on,
                                                                     const LaneGroup<Dim>& group,
                                                                     const Field& field,
                                                                     StepSums<Dim, Real, Device>& sums) {
  using namespace lane_sums;
  using P = typename Lanes<Real>::Pack;
  const auto& lanes = on.lanes;
  add_mass_and_momentum(lanes, group, sums);
  const auto bar = field.at(Vector<Dim, Real>::zero(), group.tractions).stress;
  SymmetricTensor<Dim, P> in_lane;
  const std::uint64_t cells = loaded_cells(group);
  static_for<in_lane.size>([&](auto c) VSB_UNROLLED { in_lane[c] = keep_lanes(cells, P(bar[c])); });
  CellPolynomial<Dim, P> f[Dim];
  force<EqualSpacing>(
      lanes, group, on.grid.inverse_spacing, [&](size_t entry) { return lanes.load_stress(entry) - in_lane; },
      f);
  static_for<Dim>([&](auto i) VSB_UNROLLED { sums.add_moments(1 + Dim + i, group, f[i]); });
}

/// All sums of such a group, by fields that vary along direction j alone and have no shear. sigma - sbar
/// replaces sigma, and fbar_j adds sum_p V_p fbar_j N_a.
template <int j, bool EqualSpacing, class Field, int Dim, class Real, class Device>
[[gnu::noinline, gnu::flatten]] KOKKOS_FUNCTION void sum_whole_group_along(
    const LoadedLanes<Dim, Real, Device>& on, const LaneGroup<Dim>& group, const Field& field,
    StepSums<Dim, Real, Device>& sums) {
  using namespace lane_sums;
  using P = typename Lanes<Real>::Pack;
  const auto& lanes = on.lanes;
  add_mass_and_momentum(lanes, group, sums);
  const std::uint64_t cells = loaded_cells(group);
  P b[Dim], d[Dim], divergence;
  static_for<Dim>([&](auto a) VSB_UNROLLED {
    const Real slope = along_cells<j>(on, group, field, group.tractions, a, b[a], d[a]);
    b[a] = keep_lanes(cells, b[a]);
    d[a] = keep_lanes(cells, d[a]);
    if constexpr (a == j) divergence = keep_lanes(cells, P(slope));
  });
  CellPolynomial<Dim, P> f[Dim], volume;
  force<EqualSpacing>(
      lanes, group, on.grid.inverse_spacing,
      [&](size_t entry) VSB_UNROLLED {
        auto sigma = lanes.load_stress(entry);
        const P xi = lanes.load(lanes.xi_column + j, entry);
        static_for<Dim>([&](auto a) VSB_UNROLLED { sigma[a] = sigma[a] - b[a] - d[a] * xi; });
        return sigma;
      },
      f);
  volume_moments(lanes, group, volume);
  static_for<volume.size>([&](auto k) VSB_UNROLLED { f[j][k] += divergence * volume[k]; });
  static_for<Dim>([&](auto i) VSB_UNROLLED { sums.add_moments(1 + Dim + i, group, f[i]); });
}

/// All sums of a group with nodes loaded in any way, by any field.
template <bool EqualSpacing, class Field, int Dim, class Real, class Device>
[[gnu::noinline, gnu::flatten]] KOKKOS_FUNCTION void sum_partly_loaded_group(
    const LoadedLanes<Dim, Real, Device>& on, const LaneGroup<Dim>& group, const Field& field,
    StepSums<Dim, Real, Device>& sums) {
  using namespace lane_sums;
  using P = typename Lanes<Real>::Pack;
  const auto& lanes = on.lanes;
  add_mass_and_momentum(lanes, group, sums);
  CellPolynomial<Dim, P> f[Dim];
  force<EqualSpacing>(
      lanes, group, on.grid.inverse_spacing, [&](size_t entry) { return lanes.load_stress(entry); }, f);
  static_for<Dim>([&](auto i) VSB_UNROLLED { nodes_from_moments<Dim>(f[i]); });
  if constexpr (Field::uniform) {
    CellPolynomial<Dim, P> volume;
    volume_moments(lanes, group, volume);
    for_each_mask(on, group, [&](TractionMask tractions, const std::uint64_t* bits) {
      add_uniform(field.at(Vector<Dim, Real>::zero(), tractions).stress, on.grid.inverse_spacing, volume,
                  bits, f);
    });
  } else if constexpr (Field::affine) {
    add_affine_fields(on, group, field, f);
  } else {
    for_each_mask(on, group, [&](TractionMask tractions, const std::uint64_t* bits) {
      CellPolynomial<Dim, P> t[Dim];
      function_traction(on, group, field, tractions, t);
      static_for<Dim>([&](auto a) VSB_UNROLLED { add_where<Dim>(bits, t[a], f[a]); });
    });
  }
  static_for<Dim>([&](auto i) VSB_UNROLLED { sums.add(1 + Dim + i, group, f[i]); });
}

/// All sums of a group: mass, momentum, and force with the virtual stress.
template <bool EqualSpacing, class Field, int Dim, class Real, class Device>
KOKKOS_FORCEINLINE_FUNCTION void sum_group_with(const LoadedLanes<Dim, Real, Device>& on,
                                                const LaneGroup<Dim>& group, const Field& field,
                                                StepSums<Dim, Real, Device>& sums) {
  if constexpr (Field::loaded) {
    if (Field::uniform && group.load == GroupLoad::whole) {
      sum_whole_group<EqualSpacing>(on, group, field, sums);
      return;
    }
    if constexpr (Field::affine) {
      if (field.axis >= 0 && group.load == GroupLoad::whole) {
        static_for<Dim>([&](auto j) {
          if (field.axis == j) sum_whole_group_along<j, EqualSpacing>(on, group, field, sums);
        });
        return;
      }
    }
    if (group.load != GroupLoad::none) {
      sum_partly_loaded_group<EqualSpacing>(on, group, field, sums);
      return;
    }
  }
  sum_group<EqualSpacing>(on.lanes, group, on.grid.inverse_spacing, sums);
}

}  // namespace vsb
