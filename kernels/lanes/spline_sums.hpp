// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The sums over the particles p of a group of node-centred cell lanes at its nodes I with quadratic
/// B-splines, Eq. (10), Eq. (11):
///   mass        m_I = sum_p m_p N_I(x_p),
///   momentum    p_I = sum_p m_p v_p N_I(x_p),
///   force       f_I = -sum_p V_p sigma_p . grad N_I(x_p).
/// Mass and momentum are summed with the basis functions N_I themselves. The force is summed as moments of
/// the stress with the monomials q_k of a cell, -sum_p V_p sigma_p q_k(xi_p); the derivative of a monomial is
/// a monomial, so that sums of these moments are f_I (physics/quadratic_polynomial.hpp).
///
/// kernels/lanes/spline_virtual_stress.hpp adds the virtual stress at loaded nodes, Eq. (27), Eq. (28).
/// kernels/lanes/update_nodes.hpp adds gravity: sum_p m_p g N_I(x_p) = m_I g.
///
/// In 3D every sum is a loop of its own over the slots of a group, so that its 27 numbers stay in registers.
/// All loops need the same products of basis functions: these are computed once, for some slots at a time.
#pragma once

#include <vsb/kernels/lanes/spline_scatter.hpp>
#include <vsb/physics/uniform_grid.hpp>

namespace vsb {

/// The sums of mass, momentum and force of a layer.
template <int Dim, class Real, class Device>
using SplineStepSums = SplineLayerSums<0, LaneNodes<Dim, Real, Device>::sum_columns, Dim, Real, Device>;

namespace spline_sums {

constexpr int block_slots = 16;

template <int Dim, class P>
KOKKOS_FORCEINLINE_FUNCTION void set_zero(QuadraticPolynomial<Dim, P>& m) {
  static_for<m.size>([&](auto k) VSB_UNROLLED { m[k] = P(0); });
}

/// Calls work(anew, entry, count, products) for the slots of a group, at most block_slots at a time, from an
/// entry on: products[s] = make(xi) of slot s; anew, a type, with the first of them.
template <int Dim, class Real, class Device, class Make, class Work>
KOKKOS_FORCEINLINE_FUNCTION void for_each_block(const CellLanes<Dim, Real, Device>& lanes,
                                                const LaneGroup<Dim>& group, const Make& make,
                                                const Work& work) {
  using P = typename Lanes<Real>::Pack;
  TensorProduct<Dim, P> products[block_slots];
  const auto block = [&](auto anew, int first) VSB_UNROLLED {
    const int count = group.slots - first < block_slots ? group.slots - first : block_slots;
    const size_t entry = lanes.begin(group) + static_cast<size_t>(first) * P::width;
    for (int s = 0; s < count; ++s)
      products[s] = make(lanes.load_xi(entry + static_cast<size_t>(s) * P::width));
    work(anew, entry, count, products);
  };
  block(std::true_type{}, 0);
  for (int first = block_slots; first < group.slots; first += block_slots) block(std::false_type{}, first);
}

/// sum[n] = (anew) or += sum over slots of weight(n, entry) times their products, by add(n, sum, weight,
/// product); n is a compile-time constant. One pass over the slots computes as many sums as stay in
/// registers.
template <int Count, int Dim, class P, class Anew, class Weight, class Add>
KOKKOS_FORCEINLINE_FUNCTION void accumulate(QuadraticPolynomial<Dim, P> (&sum)[Count], Anew, size_t entry,
                                            int count, const TensorProduct<Dim, P>* products,
                                            const Weight& weight, const Add& add) {
  constexpr int together = Dim == 3 ? 1 : Count;
  static_for<Count / together>([&](auto pass) VSB_UNROLLED {
    QuadraticPolynomial<Dim, P> in_registers[together];
    static_for<together>([&](auto n) VSB_UNROLLED { set_zero<Dim>(in_registers[n]); });
    for (int s = 0; s < count; ++s)
      static_for<together>([&](auto n) VSB_UNROLLED {
        const auto number = std::integral_constant<int, pass * together + n>{};
        add(number, in_registers[n], weight(number, entry + static_cast<size_t>(s) * P::width), products[s]);
      });
    static_for<together>([&](auto n) VSB_UNROLLED {
      auto& to = sum[pass * together + n];
      static_for<to.size>([&](auto k) VSB_UNROLLED {
        if constexpr (Anew::value)
          to[k] = in_registers[n][k];
        else
          to[k] += in_registers[n][k];
      });
    });
  });
}

/// Momentum, and mass if asked for, into columns of `sums`.
template <bool WithMass, int Dim, class Real, class Device, class Sums>
KOKKOS_FORCEINLINE_FUNCTION void mass_and_momentum(const CellLanes<Dim, Real, Device>& lanes,
                                                   const LaneGroup<Dim>& group, Sums& sums) {
  using P = typename Lanes<Real>::Pack;
  constexpr int first = WithMass ? 0 : 1, count = Dim + 1 - first;
  QuadraticPolynomial<Dim, P> sum[count];
  for_each_block(
      lanes, group, [&](const auto& xi) VSB_UNROLLED { return TensorProduct<Dim, P>::splines(xi); },
      [&](auto anew, size_t entry, int slots, const auto* products) VSB_UNROLLED {
        accumulate<count, Dim, P>(
            sum, anew, entry, slots, products,
            [&](auto n, size_t e) VSB_UNROLLED {
              const P m = lanes.load(lanes.mass_column, e);
              if constexpr (n + first == 0)
                return m;
              else
                return P(m * lanes.load(lanes.velocity_column + (n + first - 1), e));
            },
            [](auto, auto& s, P w, const auto& product) VSB_UNROLLED { add_product<Dim>(s, w, product); });
      });
  const auto& stencil = lanes.stencils(lanes.number_of(group));
  static_for<count>([&](auto n) VSB_UNROLLED { sums.add(first + n, stencil, sum[n]); });
}

/// Pairs i <= j of directions, one per independent component of a stress in the plane or in space.
constexpr int pair_count(int dim) {
  return dim * (dim + 1) / 2;
}
constexpr int pair_number(int i, int j, int dim) {
  return i > j ? pair_number(j, i, dim) : i * dim - i * (i - 1) / 2 + j - i;
}
constexpr int pair_first(int n, int dim) {
  int i = 0;
  while (n >= pair_number(i, dim - 1, dim) + 1) ++i;
  return i;
}
constexpr int pair_second(int n, int dim) {
  return n - pair_number(pair_first(n, dim), pair_first(n, dim), dim) + pair_first(n, dim);
}

/// The moments of stress component (i, j) that no gradient needs. A gradient lowers the degree in direction i
/// or j, so that moments of the highest degree in both drop out.
template <int i, int j>
struct NotNeeded {
  static constexpr bool of(int k) { return stencil_digit(k, i) == 2 && stencil_digit(k, j) == 2; }
};

/// The moments of a stress, sum_p w_p sigma_p q_k(xi_p), by components: value(c, entry) is component c times
/// w_p.
template <int Dim, class P>
using StressMoments = QuadraticPolynomial<Dim, P>[pair_count(Dim)];

template <int Dim, class P, class Anew, class Value>
KOKKOS_FORCEINLINE_FUNCTION void add_stress_moments(StressMoments<Dim, P>& moments, Anew anew, size_t entry,
                                                    int count, const TensorProduct<Dim, P>* products,
                                                    const Value& value) {
  accumulate<pair_count(Dim), Dim, P>(
      moments, anew, entry, count, products,
      [&](auto n, size_t e)
          VSB_UNROLLED { return value(symmetric_index(pair_first(n, Dim), pair_second(n, Dim)), e); },
      [](auto n, auto& s, P w, const auto& product) VSB_UNROLLED {
        add_monomials<NotNeeded<pair_first(n, Dim), pair_second(n, Dim)>, Dim>(s, w, product);
      });
}

/// f_i += sum_j sum_p w_p sigma_ij dq_k / dx_j, as moments k, from the moments of the stress.
template <int i, int Dim, class Real, class P>
KOKKOS_FORCEINLINE_FUNCTION void add_divergence(const StressMoments<Dim, P>& moments,
                                                const Vector<Dim, Real>& inverse_spacing,
                                                QuadraticPolynomial<Dim, P>& f) {
  static_for<Dim>([&](auto j) VSB_UNROLLED {
    add_slope_moments<j, Dim>(f, P(inverse_spacing[j]), moments[pair_number(i, j, Dim)]);
  });
}

/// The force at the nodes, -sum_p V_p (sigma_p - in_lane) . grad N_I(x_p).
template <int Dim, class Real, class Device, class P>
[[gnu::noinline, gnu::flatten]] KOKKOS_FUNCTION void force(const CellLanes<Dim, Real, Device>& lanes,
                                                           const LaneGroup<Dim>& group,
                                                           const Vector<Dim, Real>& inverse_spacing,
                                                           const SymmetricTensor<Dim, P>& in_lane,
                                                           QuadraticPolynomial<Dim, P> (&f)[Dim]) {
  StressMoments<Dim, P> moments;
  for_each_block(
      lanes, group,
      [&](const auto& xi) VSB_UNROLLED { return TensorProduct<Dim, P>::monomials(Powers<Dim, P>(xi)); },
      [&](auto anew, size_t entry, int slots, const auto* products) VSB_UNROLLED {
        add_stress_moments<Dim, P>(moments, anew, entry, slots, products, [&](int c, size_t e) VSB_UNROLLED {
          return P((in_lane[c] - lanes.load(lanes.stress_column + c, e)) *
                   lanes.load(lanes.volume_column, e));
        });
      });
  static_for<Dim>([&](auto i) VSB_UNROLLED {
    QuadraticPolynomial<Dim, P> here;
    set_zero<Dim>(here);
    add_divergence<i, Dim>(moments, inverse_spacing, here);
    nodes_from_quadratic<Dim>(here);
    static_for<here.size>([&](auto a) VSB_UNROLLED { f[i][a] = here[a]; });
  });
}

/// Mass and momentum of a group.
template <int Dim, class Real, class Device>
[[gnu::noinline, gnu::flatten]] KOKKOS_FUNCTION void add_mass_and_momentum(
    const CellLanes<Dim, Real, Device>& lanes, const LaneGroup<Dim>& group,
    SplineStepSums<Dim, Real, Device>& sums) {
  mass_and_momentum<true>(lanes, group, sums);
}

}  // namespace spline_sums

}  // namespace vsb
