// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The sums over the particles p of a group of cell lanes at its nodes I, Eq. (10), Eq. (11):
///   mass        m_I = sum_p m_p N_I(x_p),
///   momentum    p_I = sum_p m_p v_p N_I(x_p),
///   force       f_I = -sum_p V_p sigma_p . grad N_I(x_p).
/// Mass and momentum are summed with the basis functions N_I themselves. The force is summed as moments with
/// the monomials q_k of a cell, -sum_p V_p sigma_p . grad q_k(xi_p); differences of these moments are f_I
/// (physics/cell_polynomial.hpp).
///
/// kernels/lanes/virtual_stress.hpp adds the virtual stress at loaded nodes, Eq. (27), Eq. (28).
/// kernels/lanes/update_nodes.hpp adds gravity: sum_p m_p g N_I(x_p) = m_I g.
///
/// Every function is a loop over the slots of a group. It has few sums, so that they stay in registers.
#pragma once

#include <vsb/kernels/lanes/scatter.hpp>
#include <vsb/physics/cell_mass_matrix.hpp>

namespace vsb {

namespace lane_sums {

template <int Dim, class P>
KOKKOS_FORCEINLINE_FUNCTION void set_zero(CellPolynomial<Dim, P>& m) {
  static_for<(1 << Dim)>([&](auto k) VSB_UNROLLED { m[k] = P(0); });
}

/// The moments of volume, sum_p V_p q_k(xi_p).
template <int Dim, class Real, class Device, class P>
KOKKOS_FORCEINLINE_FUNCTION void volume_moments(const CellLanes<Dim, Real, Device>& lanes,
                                                const LaneGroup<Dim>& group, CellPolynomial<Dim, P>& m) {
  set_zero<Dim>(m);
  for (size_t entry = lanes.begin(group); entry < lanes.end(group); entry += P::width)
    add_moments<Dim>(m, lanes.load(lanes.volume_column, entry), lanes.load_xi(entry));
}

/// The masses at the nodes, m_I = sum_p m_p N_I(x_p).
template <int Dim, class Real, class Device, class P>
KOKKOS_FORCEINLINE_FUNCTION void mass(const CellLanes<Dim, Real, Device>& lanes, const LaneGroup<Dim>& group,
                                      CellPolynomial<Dim, P>& m) {
  set_zero<Dim>(m);
  for (size_t entry = lanes.begin(group); entry < lanes.end(group); entry += P::width)
    CornerFunctions<Dim, P>(lanes.load_xi(entry)).add(m, lanes.load(lanes.mass_column, entry));
}

/// Stores the mass matrices of a group's cells, M_IJ = sum_p m_p N_I(x_p) N_J(x_p). m: the masses at their
/// nodes.
template <int Dim, class Real, class Device, class P>
[[gnu::noinline, gnu::flatten]] KOKKOS_FUNCTION void mass_matrices(const CellLanes<Dim, Real, Device>& lanes,
                                                                   const LaneGroup<Dim>& group,
                                                                   CellPolynomial<Dim, P>& m) {
  const int g = lanes.number_of(group);
  CellMassMatrix<Dim, P> M;
  static_for<M.size>([&](auto k) VSB_UNROLLED { M[k] = P(0); });
  for (size_t entry = lanes.begin(group); entry < lanes.end(group); entry += P::width)
    add_mass<Dim>(M, lanes.load(lanes.mass_column, entry), lanes.load_xi(entry));
  static_for<M.size>([&](auto k) VSB_UNROLLED { M[k].store(lanes.mass_matrix_at(g, k)); });
  CellPolynomial<Dim, P> one;
  static_for<one.size>([&](auto a) VSB_UNROLLED { one[a] = P(Real(1)); });
  m = times<Dim>(M, one);
}

/// The momenta at the nodes, p_I = sum_p m_p v_p N_I(x_p).
template <int Dim, class Real, class Device, class P>
KOKKOS_FORCEINLINE_FUNCTION void momentum(const CellLanes<Dim, Real, Device>& lanes,
                                          const LaneGroup<Dim>& group, CellPolynomial<Dim, P> (&p)[Dim]) {
  static_for<Dim>([&](auto i) VSB_UNROLLED { set_zero<Dim>(p[i]); });
  for (size_t entry = lanes.begin(group); entry < lanes.end(group); entry += P::width) {
    const CornerFunctions<Dim, P> N(lanes.load_xi(entry));
    const P m = lanes.load(lanes.mass_column, entry);
    static_for<Dim>([&](auto i)
                        VSB_UNROLLED { N.add(p[i], P(m * lanes.load(lanes.velocity_column + i, entry))); });
  }
}

/// The moments of force, -sum_p V_p sigma_p . grad q_k(xi_p). stress(entry): sigma_p, or sigma_p - sbar.
template <bool EqualSpacing, int Dim, class Real, class Device, class Stress, class P>
KOKKOS_FORCEINLINE_FUNCTION void force(const CellLanes<Dim, Real, Device>& lanes, const LaneGroup<Dim>& group,
                                       const Vector<Dim, Real>& inverse_spacing, const Stress& stress,
                                       CellPolynomial<Dim, P> (&f)[Dim]) {
  static_for<Dim>([&](auto i) VSB_UNROLLED { set_zero<Dim>(f[i]); });
  for (size_t entry = lanes.begin(group); entry < lanes.end(group); entry += P::width) {
    const auto q = monomials<Dim>(lanes.load_xi(entry));
    const P V = lanes.load(lanes.volume_column, entry);
    auto s = stress(entry);
    // With equal spacing all components have the same 1 / h.
    const P weight = EqualSpacing ? P(V * P(-inverse_spacing[0])) : -V;
    static_for<s.size>([&](auto c) VSB_UNROLLED {
      if constexpr (Dim > 1 ? (Dim == 3 || c != 2) : c == 0) s[c] = s[c] * weight;
    });
    static_for<Dim>([&](auto a) VSB_UNROLLED {
      Vector<Dim, P> w;
      static_for<Dim>([&](auto i) VSB_UNROLLED {
        w[i] = s[symmetric_index(a, i)];
        if constexpr (!EqualSpacing) w[i] *= P(inverse_spacing[i]);
      });
      add_gradient_moments<Dim>(f[a], w, q);
    });
  }
}

}  // namespace lane_sums

/// The sums of mass, momentum and force of a layer.
template <int Dim, class Real, class Device>
using StepSums = LayerSums<0, LaneNodes<Dim, Real, Device>::sum_columns, Dim, Real, Device>;

namespace lane_sums {

template <int Dim, class Real, class Device>
KOKKOS_FORCEINLINE_FUNCTION void add_mass_and_momentum(const CellLanes<Dim, Real, Device>& lanes,
                                                       const LaneGroup<Dim>& group,
                                                       StepSums<Dim, Real, Device>& sums) {
  CellPolynomial<Dim, typename Lanes<Real>::Pack> m, p[Dim];
  if (lanes.remaps_by_mass_matrix())
    mass_matrices(lanes, group, m);
  else
    mass(lanes, group, m);
  sums.add(0, group, m);
  momentum(lanes, group, p);
  static_for<Dim>([&](auto i) VSB_UNROLLED { sums.add(1 + i, group, p[i]); });
}

}  // namespace lane_sums

/// Adds mass, momentum and force of a group without virtual stress to its nodes.
template <bool EqualSpacing, int Dim, class Real, class Device>
[[gnu::noinline, gnu::flatten]] KOKKOS_FUNCTION void sum_group(const CellLanes<Dim, Real, Device>& lanes,
                                                               const LaneGroup<Dim>& group,
                                                               const Vector<Dim, Real>& inverse_spacing,
                                                               StepSums<Dim, Real, Device>& sums) {
  using namespace lane_sums;
  using P = typename Lanes<Real>::Pack;
  add_mass_and_momentum(lanes, group, sums);
  CellPolynomial<Dim, P> f[Dim];
  force<EqualSpacing>(
      lanes, group, inverse_spacing, [&](size_t entry) { return lanes.load_stress(entry); }, f);
  static_for<Dim>([&](auto i) VSB_UNROLLED { sums.add_moments(1 + Dim + i, group, f[i]); });
}

}  // namespace vsb
