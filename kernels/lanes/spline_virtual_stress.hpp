// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The sums of a group of node-centred cell lanes with loaded nodes: those of kernels/lanes/spline_sums.hpp,
/// and at the loaded nodes I the virtual stress, Eq. (27), Eq. (28):
///   f_I <- f_I + sum_p V_p (sbar(x_p) . grad N_I(x_p) + fbar(x_p) N_I(x_p)).
///
/// Three ways to compute this sum:
/// - all nodes of each cell are loaded or none is, uniform sbar: sigma_p - sbar replaces sigma_p;
/// - otherwise, uniform sbar: the sum follows from the volume moments sum_p V_p q_k(xi_p);
/// - any other field is evaluated particle by particle.
#pragma once

#include <vsb/kernels/lanes/masks.hpp>
#include <vsb/kernels/lanes/spline_sums.hpp>
#include <vsb/kernels/lanes/virtual_stress.hpp>

namespace vsb {

namespace spline_sums {

/// Adds t_a to f_a at the nodes whose bit is set; both are at the nodes.
template <int Dim, class P>
KOKKOS_FORCEINLINE_FUNCTION void add_where(const std::uint64_t (&bits)[LaneStencil<Dim>::rows],
                                           const QuadraticPolynomial<Dim, P>& t,
                                           QuadraticPolynomial<Dim, P>& f) {
  static_for<f.size>([&](auto a) VSB_UNROLLED { f[a] += keep_lanes(bits[a / 3] >> (a % 3), t[a]); });
}

/// All moments are needed.
struct AllNeeded {
  static constexpr bool of(int) { return false; }
};

/// sum_p V_p sbar . grad N_a of uniform fields.
template <class Field, int Dim, class Real, class Device, class P>
[[gnu::noinline, gnu::flatten]] KOKKOS_FUNCTION void add_uniform_traction(
    const LoadedLanes<Dim, Real, Device>& on, const LaneGroup<Dim>& group, const Field& field,
    QuadraticPolynomial<Dim, P> (&f)[Dim]) {
  const auto& lanes = on.lanes;
  const auto& stencil = lanes.stencils(lanes.number_of(group));
  QuadraticPolynomial<Dim, P> volume[1];
  for_each_block(
      lanes, group,
      [&](const auto& xi) VSB_UNROLLED { return TensorProduct<Dim, P>::monomials(Powers<Dim, P>(xi)); },
      [&](auto anew, size_t entry, int slots, const auto* products) VSB_UNROLLED {
        accumulate<1, Dim, P>(
            volume, anew, entry, slots, products,
            [&](auto, size_t e) VSB_UNROLLED { return lanes.load(lanes.volume_column, e); },
            [](auto, auto& s, P w, const auto& product)
                VSB_UNROLLED { add_monomials<AllNeeded, Dim>(s, w, product); });
      });
  for_each_mask(group, stencil.node, stencil.loaded, on.tractions,
                [&](TractionMask tractions, const auto& bits) {
                  const auto bar = field.at(Vector<Dim, Real>::zero(), tractions).stress;
                  static_for<Dim>([&](auto i) VSB_UNROLLED {
                    QuadraticPolynomial<Dim, P> t;
                    set_zero<Dim>(t);
                    static_for<Dim>([&](auto j) VSB_UNROLLED {
                      add_slope_moments<j, Dim>(t, P(bar[symmetric_index(i, j)] * on.grid.inverse_spacing[j]),
                                                volume[0]);
                    });
                    nodes_from_quadratic<Dim>(t);
                    add_where<Dim>(bits, t, f[i]);
                  });
                });
}

/// V (sbar, fbar) of the particles of a slot; ghosts have none.
template <class Field, int Dim, class Real, class Device, class P>
[[gnu::noinline]] KOKKOS_FUNCTION void evaluate(const LoadedLanes<Dim, Real, Device>& on,
                                                const LaneGroup<Dim>& group, const Field& field,
                                                TractionMask tractions, size_t entry,
                                                VirtualStressValue<Dim, P>& bar) {
  const auto xi = on.lanes.load_xi(entry);
  const P V = on.lanes.load(on.lanes.volume_column, entry);
  const LaneMask with_particle = on.lanes.with_particle(entry / P::width);
  for (int l = 0; l < P::width; ++l) {
    auto at = VirtualStressValue<Dim, Real>::zero();
    if (with_particle >> l & 1) {  // a field need not be finite at the position of a ghost
      Vector<Dim, Real> xi_l;
      for (int i = 0; i < Dim; ++i) xi_l[i] = xi[i][l];
      at = field.at(on.grid.map(on.lanes.cell(group, l), xi_l).x, tractions);
    }
    for (int c = 0; c < bar.stress.size; ++c) bar.stress[c].set(l, at.stress[c] * V[l]);
    for (int i = 0; i < Dim; ++i) bar.divergence[i].set(l, at.divergence[i] * V[l]);
  }
}

/// sum_p V_p (sbar(x_p) . grad N_a + fbar(x_p) N_a), particle by particle.
template <class Field, int Dim, class Real, class Device, class P>
[[gnu::noinline, gnu::flatten]] KOKKOS_FUNCTION void add_function_traction(
    const LoadedLanes<Dim, Real, Device>& on, const LaneGroup<Dim>& group, const Field& field,
    QuadraticPolynomial<Dim, P> (&f)[Dim]) {
  const auto& lanes = on.lanes;
  const auto& stencil = lanes.stencils(lanes.number_of(group));
  for_each_mask(
      group, stencil.node, stencil.loaded, on.tractions, [&](TractionMask tractions, const auto& bits) {
        StressMoments<Dim, P> moments;
        QuadraticPolynomial<Dim, P> t[Dim];
        for_each_block(
            lanes, group,
            [&](const auto& xi) VSB_UNROLLED { return TensorProduct<Dim, P>::monomials(Powers<Dim, P>(xi)); },
            [&](auto anew, size_t entry, int slots, auto* products) {
              VirtualStressValue<Dim, P> bar[block_slots];
              for (int s = 0; s < slots; ++s)
                evaluate(on, group, field, tractions, entry + static_cast<size_t>(s) * P::width, bar[s]);
              const auto slot_of = [&](size_t e) { return (e - entry) / P::width; };
              add_stress_moments<Dim, P>(moments, anew, entry, slots, products,
                                         [&](int c, size_t e)
                                             VSB_UNROLLED { return bar[slot_of(e)].stress[c]; });
              accumulate<Dim, Dim, P>(
                  t, anew, entry, slots, products,
                  [&](auto i, size_t e) VSB_UNROLLED { return bar[slot_of(e)].divergence[i]; },
                  [](auto, auto& s, P w, const auto& product)
                      VSB_UNROLLED { add_monomials<AllNeeded, Dim>(s, w, product); });
            });
        static_for<Dim>([&](auto i) VSB_UNROLLED {
          add_divergence<i, Dim>(moments, on.grid.inverse_spacing, t[i]);
          nodes_from_quadratic<Dim>(t[i]);
          add_where<Dim>(bits, t[i], f[i]);
        });
      });
}

}  // namespace spline_sums

/// All sums of a group: mass, momentum, and force with the virtual stress.
template <class Field, int Dim, class Real, class Device>
KOKKOS_FORCEINLINE_FUNCTION void sum_spline_group(const LoadedLanes<Dim, Real, Device>& on,
                                                  const LaneGroup<Dim>& group, const Field& field,
                                                  SplineStepSums<Dim, Real, Device>& sums) {
  using namespace spline_sums;
  using P = typename Lanes<Real>::Pack;
  const auto& stencil = on.lanes.stencils(on.lanes.number_of(group));
  add_mass_and_momentum(on.lanes, group, sums);
  auto in_lane = SymmetricTensor<Dim, P>::zero();
  if constexpr (Field::loaded) {
    if (Field::uniform && group.load == GroupLoad::whole) {
      const auto bar = field.at(Vector<Dim, Real>::zero(), group.tractions).stress;
      for (int c = 0; c < bar.size; ++c) in_lane[c] = keep_lanes(stencil.loaded[0], P(bar[c]));
    }
  }
  QuadraticPolynomial<Dim, P> f[Dim];
  force(on.lanes, group, on.grid.inverse_spacing, in_lane, f);
  if constexpr (Field::loaded) {
    if constexpr (Field::uniform) {
      if (group.load == GroupLoad::part || group.load == GroupLoad::mixed)
        add_uniform_traction(on, group, field, f);
    } else {
      if (group.load != GroupLoad::none) add_function_traction(on, group, field, f);
    }
  }
  static_for<Dim>([&](auto i) VSB_UNROLLED { sums.add(1 + Dim + i, stencil, f[i]); });
}

}  // namespace vsb
