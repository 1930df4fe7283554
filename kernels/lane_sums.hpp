// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What the particles of a group of cell lanes give to its nodes (Eqs. 10, 11, 27, 28), as moments on the
/// cells (physics/cell_polynomial.hpp):
///   mass        sum_p m_p q_k,
///   momentum    sum_p m_p v_p q_k,
///   force       sum_p -V_p sigma_p . grad q_k,
/// and at loaded nodes the virtual stress, sum_p V_p (sbar . grad N_a + fbar N_a). A uniform sbar needs only
/// the volume moments sum_p V_p q_k; where all nodes of a cell are loaded, not even these.
///
/// Gravity is left to the nodes: sum_p N_a m_p g = m_a g.
#pragma once

#include <vsb/kernels/lane_scatter.hpp>
#include <vsb/physics/uniform_grid.hpp>
#include <vsb/physics/virtual_stress.hpp>

namespace vsb {

/// sigma scaled by -V / h_i in column i: the weights of the gradient moments of the force along a.
template <int a, int Dim, class P, class Real>
KOKKOS_FORCEINLINE_FUNCTION Vector<Dim, P> traction_weights(const SymmetricTensor<Dim, P>& stress,
                                                            const Vector<Dim, Real>& inverse_spacing) {
  Vector<Dim, P> w;
  static_for<Dim>([&](auto i) { w[i] = stress[symmetric_index(a, i)] * P(inverse_spacing[i]); });
  return w;
}

template <int Dim, class Real, class Device, bool Cubic>
struct LaneSums {
  using P = typename Lanes<Real>::Pack;
  using Polynomial = CellPolynomial<Dim, P>;
  static constexpr int columns = LaneNodes<Dim, Real, Device>::sum_columns;
  static constexpr bool cubic = Cubic;
  using Sums = LayerSums<0, columns, Dim, Real, Device>;

  CellLanes<Dim, Real, Device> lanes;
  UniformGrid<Dim, Real> grid;

  KOKKOS_FORCEINLINE_FUNCTION static Polynomial zero() {
    Polynomial m;
    static_for<Polynomial::size>([&](auto k) { m[k] = P(Real(0)); });
    return m;
  }

  /// Adds mass; and to `volume` the volume moments, where they are wanted.
  template <bool WithVolume>
  KOKKOS_FORCEINLINE_FUNCTION void mass(const LaneGroup<Dim>& group, Sums& sums, Polynomial& volume) const {
    Polynomial m = zero();
    for (size_t entry = lanes.begin(group); entry < lanes.end(group); entry += P::width) {
      const auto xi = lanes.load_xi(entry);
      vsb::add_moments<Dim>(m, lanes.load(lanes.mass_column, entry), xi);
      if constexpr (WithVolume) vsb::add_moments<Dim>(volume, lanes.load(lanes.volume_column, entry), xi);
    }
    sums.add_moments(0, group, m);
  }

  template <class AnySums>
  KOKKOS_FORCEINLINE_FUNCTION void momentum(const LaneGroup<Dim>& group, AnySums& sums) const {
    Polynomial p[Dim];
    static_for<Dim>([&](auto i) { p[i] = zero(); });
    for (size_t entry = lanes.begin(group); entry < lanes.end(group); entry += P::width) {
      const auto xi = lanes.load_xi(entry);
      const auto q = monomials<Dim>(xi);
      const P m = lanes.load(lanes.mass_column, entry);
      static_for<Dim>([&](auto i) {
        add_moments_of<Dim>(p[i], P(m * lanes.load(lanes.velocity_column + i, entry)), q);
      });
    }
    static_for<Dim>([&](auto i) { sums.add_moments(1 + i, group, p[i]); });
  }

  /// Force moments; `stress(entry)` is sigma - sbar.
  template <class Stress>
  KOKKOS_FORCEINLINE_FUNCTION void force(const LaneGroup<Dim>& group, Polynomial (&f)[Dim],
                                         const Stress& stress) const {
    static_for<Dim>([&](auto i) { f[i] = zero(); });
    for (size_t entry = lanes.begin(group); entry < lanes.end(group); entry += P::width) {
      const auto xi = lanes.load_xi(entry);
      const auto q = monomials<Dim>(xi);
      const P V = lanes.load(lanes.volume_column, entry);
      auto s = stress(entry);
      if constexpr (Cubic) {
        const P w = V * P(-grid.inverse_spacing[0]);
        static_for<Dim>([&](auto i) {
          static_for<Dim>([&](auto j) {
            if constexpr (j >= i) s[symmetric_index(i, j)] = s[symmetric_index(i, j)] * w;
          });
        });
        static_for<Dim>([&](auto a) {
          Vector<Dim, P> w_a;
          static_for<Dim>([&](auto i) { w_a[i] = s[symmetric_index(a, i)]; });
          add_gradient_moments<Dim>(f[a], w_a, q);
        });
      } else {
        const P w = -V;
        static_for<s.size>([&](auto c) { s[c] = s[c] * w; });
        static_for<Dim>([&](auto a) {
          add_gradient_moments<Dim>(f[a], traction_weights<a>(s, grid.inverse_spacing), q);
        });
      }
    }
    static_for<Dim>([&](auto i) { nodes_from_moments<Dim>(f[i]); });
  }

  /// Everything of one group.
  template <class Field>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(const LaneGroup<Dim>& group, Sums& sums,
                                              const Field& field) const {
    if constexpr (Field::loaded) {
      if (group.load != GroupLoad::none) {
        loaded(group, sums, field);
        return;
      }
    }
    Polynomial unused, f[Dim];
    mass<false>(group, sums, unused);
    momentum(group, sums);
    force(group, f, [&](size_t entry) { return lanes.load_stress(entry); });
    static_for<Dim>([&](auto i) { sums.add(1 + Dim + i, group, f[i]); });
  }

  /// A group with loaded nodes.
  template <class Field>
  KOKKOS_FUNCTION void loaded(const LaneGroup<Dim>& group, Sums& sums, const Field& field) const {
    Polynomial volume, f[Dim];
    if constexpr (Field::uniform) {
      if (group.load == GroupLoad::whole) {
        mass<false>(group, sums, volume);
        momentum(group, sums);
        const auto bar = field.at(Vector<Dim, Real>::zero(), group.tractions).stress;
        const auto in_lane = PackMask<Real, P::width>::from_bits(group.loaded[0]);
        SymmetricTensor<Dim, P> masked;
        static_for<masked.size>([&](auto c) { masked[c] = math::select(in_lane, P(bar[c]), P(Real(0))); });
        force(group, f, [&](size_t entry) { return lanes.load_stress(entry) - masked; });
      } else {
        volume = zero();
        mass<true>(group, sums, volume);
        momentum(group, sums);
        force(group, f, [&](size_t entry) { return lanes.load_stress(entry); });
        Polynomial G[Dim];
        static_for<Dim>([&](auto i) {
          G[i] = gradient_moments<i, Dim>(volume);
          nodes_from_moments<Dim>(G[i]);
        });
        for_each_mask(group, [&](TractionMask tractions, const std::uint64_t* bits) {
          const auto bar = field.at(Vector<Dim, Real>::zero(), tractions).stress;
          static_for<Dim>([&](auto a) {
            static_for<Polynomial::size>([&](auto c) {
              P t = P(bar[symmetric_index(a, 0)] * grid.inverse_spacing[0]) * G[0][c];
              static_for<Dim>([&](auto i) {
                if constexpr (i > 0) t += P(bar[symmetric_index(a, i)] * grid.inverse_spacing[i]) * G[i][c];
              });
              const auto here = PackMask<Real, P::width>::from_bits(bits[c >> 1] >> (c & 1));
              f[a][c] += math::select(here, t, P(Real(0)));
            });
          });
        });
      }
    } else {
      mass<false>(group, sums, volume);
      momentum(group, sums);
      force(group, f, [&](size_t entry) { return lanes.load_stress(entry); });
      for_each_mask(group, [&](TractionMask tractions, const std::uint64_t* bits) {
        Polynomial t[Dim];
        traction(group, field, tractions, t);
        static_for<Dim>([&](auto a) {
          static_for<Polynomial::size>([&](auto c) {
            const auto here = PackMask<Real, P::width>::from_bits(bits[c >> 1] >> (c & 1));
            f[a][c] += math::select(here, t[a][c], P(Real(0)));
          });
        });
      });
    }
    static_for<Dim>([&](auto i) { sums.add(1 + Dim + i, group, f[i]); });
  }

  /// sum_p V_p (sbar(x_p) . grad N_a + fbar(x_p) N_a), particle by particle.
  template <class Field>
  KOKKOS_FUNCTION void traction(const LaneGroup<Dim>& group, const Field& field, TractionMask tractions,
                                Polynomial (&t)[Dim]) const {
    static_for<Dim>([&](auto i) { t[i] = zero(); });
    for (size_t entry = lanes.begin(group); entry < lanes.end(group); entry += P::width) {
      const auto xi = lanes.load_xi(entry);
      const auto q = monomials<Dim>(xi);
      const P V = lanes.load(lanes.volume_column, entry);
      VirtualStressValue<Dim, P> bar;
      for (int l = 0; l < P::width; ++l) {
        Vector<Dim, Real> xi_l;
        for (int i = 0; i < Dim; ++i) xi_l[i] = xi[i][l];
        const auto at = field.at(grid.map(lanes.cell(group, l), xi_l).x, tractions);
        for (int c = 0; c < bar.stress.size; ++c) bar.stress[c].set(l, at.stress[c]);
        for (int i = 0; i < Dim; ++i) bar.divergence[i].set(l, at.divergence[i]);
      }
      static_for<bar.stress.size>([&](auto c) { bar.stress[c] = bar.stress[c] * V; });
      static_for<Dim>([&](auto a) {
        add_gradient_moments<Dim>(t[a], traction_weights<a>(bar.stress, grid.inverse_spacing), q);
        add_moments_of<Dim>(t[a], P(bar.divergence[a] * V), q);
      });
    }
    static_for<Dim>([&](auto i) { nodes_from_moments<Dim>(t[i]); });
  }

  /// The tractions of every node, see kernels/mark_lanes.hpp; read where a group's nodes differ.
  Kokkos::View<const TractionMask*, Device> boundary;  ///< [node]

  /// Calls work(mask, bits) for every mask that is not zero among the nodes of the group; bits as in
  /// LaneGroup::loaded.
  template <class Work>
  KOKKOS_FORCEINLINE_FUNCTION void for_each_mask(const LaneGroup<Dim>& group, const Work& work) const {
    if (group.load != GroupLoad::mixed) {
      work(group.tractions, group.loaded);
      return;
    }
    constexpr int rows = LaneGroup<Dim>::corner_rows;
    std::uint64_t left[rows];
    for (int r = 0; r < rows; ++r) left[r] = group.loaded[r];
    while (true) {
      TractionMask mask = 0;
      for (int r = 0; r < rows && mask == 0; ++r)
        for (int l = 0; l <= P::width && mask == 0; ++l)
          if (left[r] >> l & 1) mask = boundary(group.node[r] + l);
      if (mask == 0) return;
      std::uint64_t bits[rows] = {};
      for (int r = 0; r < rows; ++r) {
        for (int l = 0; l <= P::width; ++l)
          if ((left[r] >> l & 1) && boundary(group.node[r] + l) == mask) bits[r] |= std::uint64_t(1) << l;
        left[r] &= ~bits[r];
      }
      work(mask, bits);
    }
  }
};

}  // namespace vsb
